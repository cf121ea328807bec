"""moving.glb: the Cornell box with three animations, for what remembers earlier frames.

`slide`  a cube goes from left to right before the tall block and back, and turns once about +y (4 s, linear)
`swing`  the spot leans to the left, to the right and back (4 s, cubic spline)
`dolly`  the camera goes 0.3 m into the box (2 s, linear)
"""

import numpy as np

import cornell
import gltf
import mesh

SIDE = 0.14  # m
LEFT, RIGHT = (0.42, SIDE / 2, 0.16), (0.14, SIDE / 2, 0.16)  # the cube's centre; x runs to the left
LEAN = np.radians(20.0)


def cube(side):
    """A closed cube about the origin, fronts outside."""
    h = side / 2
    top = [(-h, h, h), (h, h, h), (h, h, -h), (-h, h, -h)]
    bottom = [(x, -h, z) for x, _, z in top]
    sides = [mesh.quad(*np.array([bottom[i - 1], bottom[i], top[i], top[i - 1]])) for i in range(4)]
    return mesh.merged([mesh.quad(*np.array(top))] + sides + [mesh.quad(*np.array(bottom[::-1]))])


def leaning(angle):
    """The rotation of a light that looks down, leant by `angle` towards +x."""
    return gltf.look_rotation((np.sin(angle), -np.cos(angle), 0), up=(0, 0, 1))


def build():
    glb = cornell.build()
    glb.json["scenes"][0]["name"] = "moving"
    nodes = {node["name"]: index for index, node in enumerate(glb.json["nodes"])}
    short = nodes["short_block"]
    # The cube stands in for the short block, in its node.
    material = glb.json["meshes"][glb.json["nodes"][short]["mesh"]]["primitives"][0]["material"]
    glb.json["nodes"][short] = {
        "name": "cube",
        "mesh": glb.add_mesh("cube", [(cube(SIDE), material)]),
        "translation": gltf.plain(LEFT),
    }
    glb.add_animation(
        "slide",
        [
            (short, "translation", [0, 2, 4], [LEFT, RIGHT, LEFT]),
            (short, "rotation", [0, 1, 2, 3, 4], [gltf.turn_y(angle) for angle in np.radians([0, 90, 180, 270, 360])]),
        ],
    )
    spot = nodes["spot"]
    still = np.zeros(4)
    swing = [part for angle in (0, LEAN, 0, -LEAN, 0) for part in (still, leaning(angle), still)]
    glb.add_animation("swing", [(spot, "rotation", [0, 1, 2, 3, 4], swing, "CUBICSPLINE")])
    camera = nodes["camera.cornell"]
    position = np.array(glb.json["nodes"][camera]["translation"])
    glb.add_animation("dolly", [(camera, "translation", [0, 2], [position, position + (0, 0, 0.3)])])
    return glb
