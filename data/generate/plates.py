"""plates.glb: two pairs of unit squares whose form factors are known in closed form.

`parallel`      facing each other at a distance of 1 m:                 F = 0.199825 (Howell C-11, X = Y = 1)
`perpendicular` sharing an edge at a right angle, 1 m by 1 m each:      F = 0.200044 (Howell C-14, H = W = 1)

Every plate is single-sided. Light strikes the front of both emitters at 60 degrees and the front of no receiver; it
reaches the emitters past the receivers, so the truth is the same for a tracer that ignores the side of a plate. The
pairs exchange no light: the perpendicular pair lies in or above the plane that the parallel receiver looks down from,
and behind it the perpendicular receiver sees nothing of the parallel pair.
"""

import numpy as np

import gltf
import mesh

ALBEDO = 0.5
ILLUMINANCE = 40000.0  # lux across the beam; half of it arrives on a plate at 60 degrees
INCIDENCE = np.radians(60.0)
# The beam leans this much to the back of the perpendicular receiver, so that its front is surely unlit and no
# rasterizer has to decide about a plate seen exactly edge-on. Its shadow on the emitter is 0.7 mm wide.
LEAN = np.radians(0.02)


def light_direction():
    """The direction in which the light travels."""
    sideways = np.sin(LEAN)
    down = np.cos(INCIDENCE)
    return np.array([sideways, -down, -np.sqrt(1.0 - down * down - sideways * sideways)])


def plate(right, up):
    """A unit square about the origin; its front faces along cross(right, up)."""
    right, up = np.asarray(right, dtype=float) / 2, np.asarray(up, dtype=float) / 2
    return mesh.quad(-right - up, right - up, right + up, up - right)


def build():
    glb = gltf.Glb("plates", "Earthshine authors")
    matte = glb.add_material("matte", (ALBEDO,) * 3)
    faces_up = glb.add_mesh("plate.up", [(plate((1, 0, 0), (0, 0, -1)), matte)])
    faces_down = glb.add_mesh("plate.down", [(plate((1, 0, 0), (0, 0, 1)), matte)])
    faces_x = glb.add_mesh("plate.x", [(plate((0, 0, -1), (0, 1, 0)), matte)])

    glb.add_node("parallel.emitter", mesh=faces_up, translation=(-2.0, 0.0, 0.0))
    glb.add_node("parallel.receiver", mesh=faces_down, translation=(-2.0, 1.0, 0.0))
    glb.add_node("perpendicular.emitter", mesh=faces_up, translation=(2.0, 1.0, 0.0))
    glb.add_node("perpendicular.receiver", mesh=faces_x, translation=(1.5, 1.5, 0.0))

    glb.add_node(
        "sun",
        light=glb.add_light("sun", "directional", ILLUMINANCE),
        translation=(0.0, 4.0, 5.0),
        rotation=gltf.look_rotation(light_direction()),
    )

    for name, vertical_fov, aspect, position, target in (
        ("both", 34.0, 16 / 9, (5.4, -0.3, 2.4), (0.3, 1.0, 0.0)),
        ("parallel", 50.0, 1.0, (-2.0, 0.05, 1.7), (-2.0, 0.95, 0.0)),
        ("perpendicular", 50.0, 1.0, (3.6, 1.9, 0.4), (1.5, 1.5, 0.0)),
    ):
        glb.place_camera(name, np.radians(vertical_fov), aspect, 0.05, 50.0, position, target)
    return glb
