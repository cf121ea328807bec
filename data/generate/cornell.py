"""cornell.glb: the Cornell box as measured, https://www.graphics.cornell.edu/online/box/data.html

Vertices, camera and reflectance spectra are the published ones. The published frame (x to the left, y up, z into the
box) is right-handed already, so only the unit changes: 1 unit = 1 mm. The blocks get a bottom, which closes them. The
light is a spot at the centre of the published luminaire, because a reflective shadow map needs a light with a
projection; its colour is white.
"""

import numpy as np

import gltf
import mesh
from spectra import linear_rec709, GREEN, RED, WHITE

METRES = 0.001

# Four corners a face, in the published order.
FLOOR = [(552.8, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 559.2), (549.6, 0.0, 559.2)]
CEILING = [(556.0, 548.8, 0.0), (556.0, 548.8, 559.2), (0.0, 548.8, 559.2), (0.0, 548.8, 0.0)]
BACK_WALL = [(549.6, 0.0, 559.2), (0.0, 0.0, 559.2), (0.0, 548.8, 559.2), (556.0, 548.8, 559.2)]
RIGHT_WALL = [(0.0, 0.0, 559.2), (0.0, 0.0, 0.0), (0.0, 548.8, 0.0), (0.0, 548.8, 559.2)]
LEFT_WALL = [(552.8, 0.0, 0.0), (549.6, 0.0, 559.2), (556.0, 548.8, 559.2), (556.0, 548.8, 0.0)]
SHORT_BLOCK_TOP = [(130.0, 165.0, 65.0), (82.0, 165.0, 225.0), (240.0, 165.0, 272.0), (290.0, 165.0, 114.0)]
TALL_BLOCK_TOP = [(423.0, 330.0, 247.0), (265.0, 330.0, 296.0), (314.0, 330.0, 456.0), (472.0, 330.0, 406.0)]
LUMINAIRE = [(343.0, 548.8, 227.0), (343.0, 548.8, 332.0), (213.0, 548.8, 332.0), (213.0, 548.8, 227.0)]

CAMERA_POSITION = (278.0, 273.0, -800.0)
FOCAL_LENGTH, FILM_HEIGHT = 0.035, 0.025

BELOW_CEILING = 1.8  # mm, so that the light stands clear of the ceiling
CANDELA = 300.0  # 1000 lux on the floor straight below
CONE = np.radians([25.0, 65.0])


def face(corners):
    return mesh.quad(*(np.array(corners) * METRES))


def block(top):
    """The five published faces of a block, which follow from its top, and its bottom."""
    bottom = [(x, 0.0, z) for x, _, z in top]
    sides = [face([bottom[i], top[i], top[i - 1], bottom[i - 1]]) for i in range(4)]
    return mesh.merged([face(top)] + sides + [face(bottom[::-1])])


def build():
    glb = gltf.Glb("cornell", "Earthshine authors; measurements by the Cornell Program of Computer Graphics")
    white, red, green = (
        glb.add_material(name, linear_rec709(spectrum))
        for name, spectrum in (("white", WHITE), ("red", RED), ("green", GREEN))
    )
    for name, shape, material in (
        ("floor", face(FLOOR), white),
        ("ceiling", face(CEILING), white),
        ("back_wall", face(BACK_WALL), white),
        ("right_wall", face(RIGHT_WALL), green),
        ("left_wall", face(LEFT_WALL), red),
        ("short_block", block(SHORT_BLOCK_TOP), white),
        ("tall_block", block(TALL_BLOCK_TOP), white),
    ):
        glb.add_node(name, mesh=glb.add_mesh(name, [(shape, material)]))

    position = np.mean(LUMINAIRE, axis=0) - (0.0, BELOW_CEILING, 0.0)
    glb.add_node(
        "spot",
        light=glb.add_light("spot", "spot", CANDELA, cone=CONE.tolist()),
        translation=position * METRES,
        rotation=gltf.look_rotation((0, -1, 0), up=(0, 0, 1)),
    )
    vertical_fov = 2 * np.arctan(FILM_HEIGHT / 2 / FOCAL_LENGTH)
    position = np.array(CAMERA_POSITION) * METRES
    glb.place_camera("cornell", vertical_fov, 1.0, 0.1, 10.0, position, position + (0, 0, 1))
    return glb
