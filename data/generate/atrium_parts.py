"""The parts that atrium.glb repeats: columns, arches, vaults, balustrade, doors. Each function returns
{material: Mesh} in the frame that atrium_plan.py describes, or a Mesh that such a part is made of.
"""

import numpy as np

from atrium_plan import (
    BAY,
    SPRINGING,
    ARCH_RADIUS,
    HALF_WALL,
    RIB,
    PILASTER,
    VAULT_RISE,
    UPPER_FLOOR,
    UPPER_SPRINGING,
    UPPER_RADIUS,
    UPPER_HALF_WALL,
    CEILING,
    RAIL,
)
from mesh import arc, arch_sweep, arch_wall, box, lathe, merged, quad, ring, surface


def block_stack(levels, half=None):
    """Square blocks one above another: (bottom, top, half width) each."""
    return merged(box((-h, low, -h), (h, high, h)) for low, high, h in levels)


def acanthus(radius, bottom, height, width, reach, count, turn, rows, columns):
    """A ring of leaves that rise from a bell and curl outwards at the tip; rows x columns points a leaf."""
    along, across = np.linspace(0, 1, rows), np.linspace(-1, 1, columns)
    outline = width * (np.sqrt(1 - 0.97 * along**3) * (0.85 + 0.15 * np.cos(along * 9)))
    curl = np.clip((along - 0.55) / 0.45, 0, 1) * np.radians(150)  # the tip turns over by this angle
    out = radius + 0.006 + 0.012 * along + reach / 2 * (1 - np.cos(curl))
    up = bottom + height * np.where(along < 0.55, along, 0.55) + height * 0.25 * np.sin(curl)
    ridge = 0.06 * width * (1 - np.abs(across)) - 0.25 * width * across**2
    points = np.stack(
        [
            across[None, :] * outline[:, None],
            np.broadcast_to(up[:, None], (rows, columns)),
            out[:, None] + ridge[None, :],
        ],
        axis=2,
    )
    leaf = surface(points.transpose(1, 0, 2))
    return merged(leaf.turned_y(2 * np.pi * (k + turn) / count) for k in range(count))


def fluted_shaft(foot, head, bottom, top, flutes):
    """A shaft that is smooth in its lower third and fluted above; the grooves run out in rounded ends."""
    t = np.array([0.0, 0.16, 0.32, 0.335, 0.35, 0.38, 0.53, 0.68, 0.83, 0.95, 0.965, 0.98, 1.0])
    depth = np.interp(t, [0.32, 0.335, 0.35, 0.38, 0.95, 0.965, 0.98], [0.0, 0.6, 0.87, 1.0, 1.0, 0.75, 0.0])
    around = ring(6 * flutes)
    groove = np.tile([0.0, 0.55, 0.95, 1.0, 0.95, 0.55], flutes + 1)[: 6 * flutes + 1]
    radius = foot - (foot - head) * t**1.8
    r = radius * (1 - 0.075 * depth * groove[:, None])
    points = np.stack(
        [around[:, :1] * r, np.broadcast_to(bottom + t * (top - bottom), r.shape), around[:, 1:] * r], axis=2
    )
    return surface(points)


def column(height, radius, segments, leaf_grid, flutes=0):
    """Attic base, shaft with entasis (fluted if `flutes` > 0), leafed capital and abacus; `radius` is that of the
    shaft's foot."""
    r = radius
    plinth, abacus = 0.66 * r, 0.52 * r
    capital = 2.1 * r
    base_top, shaft_top = plinth + 1.15 * r, height - abacus - capital
    base = [
        arc((1.22 * r, plinth + 0.25 * r), 0.25 * r, -90, 90, 8),
        [(1.22 * r, plinth + 0.50 * r), (1.22 * r, plinth + 0.56 * r)],
        [(1.22 * r, plinth + 0.56 * r)]
        + arc((1.26 * r, plinth + 0.74 * r), 0.17 * r, 250, 130, 6)
        + [(1.14 * r, plinth + 0.90 * r)],
        arc((1.12 * r, plinth + 1.0 * r), 0.10 * r, -90, 90, 6),
        [(1.12 * r, plinth + 1.10 * r), (1.03 * r, base_top)],
    ]
    if flutes:
        shaft = fluted_shaft(r, 0.86 * r, base_top, shaft_top, flutes)
    else:
        t = np.linspace(0, 1, 7)
        shaft = lathe([list(zip(r * (1 - 0.14 * t**1.8), base_top + t * (shaft_top - base_top)))], segments)
    neck = 0.86 * r
    bell_at = np.linspace(0, 1, 7)
    capital_profile = [
        arc((neck, shaft_top + 0.07 * r), 0.10 * r, -80, 80, 5),
        list(
            zip(
                neck * (0.98 + 0.06 * bell_at + 0.42 * bell_at**5),
                shaft_top + 0.14 * r + bell_at * (capital - 0.14 * r),
            )
        ),
    ]
    foot = shaft_top + 0.14 * r
    half = 1.57 * r
    return {
        "stone": merged(
            [
                box((-1.6 * r, 0, -1.6 * r), (1.6 * r, plinth, 1.6 * r), "-y"),
                lathe(base, segments),
                shaft,
                lathe(capital_profile, segments),
                acanthus(neck, foot, 1.0 * r, 0.30 * r, 0.20 * r, 8, 0.0, *leaf_grid),
                acanthus(neck * 1.04, foot + 0.1 * r, 1.62 * r, 0.30 * r, 0.34 * r, 8, 0.5, *leaf_grid),
                acanthus(neck * 1.08, foot + 0.3 * r, 1.66 * r, 0.20 * r, 0.86 * r, 4, 0.5, *leaf_grid),
                box(
                    (-half * 0.94, height - abacus, -half * 0.94),
                    (half * 0.94, height - abacus * 0.45, half * 0.94),
                    "+y",
                ),
                box((-half, height - abacus * 0.5, -half), (half, height, half)),
            ]
        )
    }


def pier(height, half):
    """A square pier for the corners, with the base and the abacus of the columns."""
    r = 0.21
    return {
        "ashlar": box((-half, 0.3, -half), (half, height - 0.3, half), "-y +y"),
        "stone": block_stack(
            [
                (0, 0.14, half + 0.09),
                (0.14, 0.24, half + 0.06),
                (0.24, 0.30, half + 0.03),
                (height - 0.34, height - 0.28, half + 0.03),
                (height - 0.20, height - 0.10, half + 0.04),
                (height - 0.28, height - 0.20, half),
                (height - 0.52 * r, height, max(1.57 * r, half + 0.07)),
            ]
        ),
    }


def keystone(radius, springing, depth, z):
    low, high = springing + radius - 0.02, springing + radius + 0.34
    a, b = 0.085, 0.125
    front, back = z + depth, z - 0.02
    corners = [(-a, low), (a, low), (b, high), (-b, high)]
    faces = [quad(*[(x, y, front) for x, y in corners])]
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1]):
        faces.append(quad((x0, y0, back), (x1, y1, back), (x1, y1, front), (x0, y0, front)))
    return merged(faces)


def archivolt(radius, springing, z, size, steps):
    """The moulding around an arch on its +z side: two fasciae and a roll."""
    s = size
    return arch_sweep(
        radius,
        springing,
        [
            [(0, z - 0.001), (0, z + 0.20 * s)],
            [(0, z + 0.20 * s), (0.42 * s, z + 0.20 * s)],
            [(0.42 * s, z + 0.20 * s), (0.42 * s, z + 0.30 * s)],
            [(0.42 * s, z + 0.30 * s), (0.74 * s, z + 0.30 * s)],
            arc((0.87 * s, z + 0.30 * s), 0.13 * s, 180, 0, 5),
            [(s, z + 0.30 * s), (s, z)],
        ],
        steps,
    )


def roundel(radius, y, z):
    """A glazed tondo in a spandrel: a rim and a shallow blue dish."""
    rim = lathe([arc((radius, 0.0), 0.05, 180, 0, 8)[::-1]], 28)
    dish = lathe([[(radius * 0.97, 0.012), (radius * 0.5, 0.022), (0.0, 0.05)]], 28)
    boss = lathe([[(radius * 0.30, 0.02), (radius * 0.28, 0.06), (radius * 0.15, 0.085), (0.0, 0.09)]], 16)
    stand = lambda m: m.transformed([[1, 0, 0], [0, 0, -1], [0, 1, 0]]).moved(0, y, z)
    return {"stone": merged([stand(rim), stand(boss)]), "glaze": stand(dish)}


def groin_vault(half_x, half_z, rise, steps):
    """Two crossing barrels over a rectangle about the origin, springing from y = 0, seen from below."""

    def barrel(hx, hz):
        phi = np.linspace(-np.pi / 2, np.pi / 2, 2 * steps + 1)
        t = np.linspace(0, 1, max(steps // 2, 2) + 1)
        v = np.sin(phi)
        u = np.abs(v)[None, :] + t[:, None] * (1 - np.abs(v))[None, :]
        points = np.stack(
            [hx * u, np.broadcast_to(rise * np.cos(phi), u.shape), np.broadcast_to(hz * v, u.shape)], axis=2
        )
        uvs = np.stack([hx * u, np.broadcast_to(phi * (hz + rise) / 2, u.shape)], axis=2)
        half = surface(points, uvs)
        return [half, half.turned_y(np.pi)]

    return merged(barrel(half_x, half_z) + [m.turned_y(np.pi / 2) for m in barrel(half_z, half_x)])


def transverse_rib(steps=16):
    """The rib over a column line, from the arcade wall to the pilaster on the back wall, with that pilaster."""
    angle = np.linspace(np.pi, 0, steps + 1)

    def curve(near, far, rise, x):
        return np.stack(
            [
                np.full_like(angle, x),
                SPRINGING + rise * np.sin(angle),
                (near + far) / 2 + (near - far) / 2 * np.cos(angle),
            ],
            axis=1,
        )

    inner = lambda x: curve(-HALF_WALL, -BAY + PILASTER, 1.27, x)
    outer = lambda x: curve(-HALF_WALL + 0.03, -BAY - 0.03, VAULT_RISE + 0.03, x)
    right = surface(np.stack([inner(RIB), outer(RIB)], axis=1))
    left = surface(np.stack([outer(-RIB), inner(-RIB)], axis=1))
    soffit = surface(np.stack([inner(-RIB), inner(RIB)], axis=1))
    stone = [right, left, soffit]
    for low, high, half, out in (
        (0, 0.16, 0.30, 0.09),
        (0.16, 0.24, 0.27, 0.05),
        (0.24, 2.66, 0.22, 0.0),
        (2.66, 2.71, 0.25, 0.03),
        (2.71, 2.89, 0.22, 0.0),
        (2.89, 2.94, 0.26, 0.04),
        (2.94, 3.00, 0.29, 0.07),
    ):
        stone.append(box((-half, low, -BAY - 0.01), (half, high, -BAY + PILASTER + out), "-z"))
    return {"stone": merged(stone)}


def lower_bay():
    """One bay of the lower arcade above its columns: the arch, its mouldings and the groin vault behind it."""
    front = arch_wall(BAY / 2, ARCH_RADIUS, SPRINGING, UPPER_FLOOR, 28)
    depth = BAY - HALF_WALL
    vault = groin_vault(BAY / 2 - RIB, depth / 2, VAULT_RISE, 12)
    return {
        "ashlar": front.moved(0, 0, HALF_WALL),
        "plaster": merged(
            [front.turned_y(np.pi).moved(0, 0, -HALF_WALL), vault.moved(0, SPRINGING, -HALF_WALL - depth / 2)]
        ),
        "stone": merged(
            [
                arch_sweep(ARCH_RADIUS, SPRINGING, [[(0, -HALF_WALL), (0, HALF_WALL)]], 28),
                archivolt(ARCH_RADIUS, SPRINGING, HALF_WALL, 0.17, 28),
                keystone(ARCH_RADIUS, SPRINGING, 0.11, HALF_WALL),
            ]
        ),
    }


def corner_vault():
    """The groin vault over a corner of the arcade; its frame: the origin is the corner pier, the room in +x and +z."""
    half = (BAY - RIB) / 2
    return {"plaster": groin_vault(half, half, VAULT_RISE, 12).moved(RIB + half, SPRINGING, RIB + half)}


def upper_bay():
    """One bay of the gallery: two small arches, pedestals and rails of the balustrade."""
    wall, sweep, volts = [], [], []
    for x in (-BAY / 4, BAY / 4):
        front = arch_wall(BAY / 4, UPPER_RADIUS, UPPER_SPRINGING, CEILING, 18)
        wall += [front.moved(x, 0, UPPER_HALF_WALL), front.turned_y(np.pi).moved(x, 0, -UPPER_HALF_WALL)]
        sweep.append(
            arch_sweep(UPPER_RADIUS, UPPER_SPRINGING, [[(0, -UPPER_HALF_WALL), (0, UPPER_HALF_WALL)]], 18).moved(
                x, 0, 0
            )
        )
        volts.append(archivolt(UPPER_RADIUS, UPPER_SPRINGING, UPPER_HALF_WALL, 0.11, 18).moved(x, 0, 0))
    rails = []
    for x0, x1 in ((-BAY / 2 + 0.19, -0.19), (0.19, BAY / 2 - 0.19)):
        for low, high, half in (
            (UPPER_FLOOR, UPPER_FLOOR + 0.12, 0.13),
            (RAIL - 0.16, RAIL - 0.11, 0.11),
            (RAIL - 0.11, RAIL, 0.15),
        ):
            rails.append(box((x0, low, -half), (x1, high, half), "-x +x"))
    return {"stone": merged(sweep + volts + rails), "plaster": merged(wall)}


def pedestal():
    """What an upper column stands on, part of the balustrade."""
    return {
        "stone": block_stack(
            [
                (UPPER_FLOOR, UPPER_FLOOR + 0.14, 0.22),
                (UPPER_FLOOR + 0.14, RAIL - 0.12, 0.19),
                (RAIL - 0.12, RAIL - 0.07, 0.21),
                (RAIL - 0.07, RAIL + 0.01, 0.235),
            ]
        )
    }


def baluster():
    """A turned baluster, 0.62 m."""
    profile = [
        arc((0.050, 0.075), 0.026, -80, 60, 4) + [(0.040, 0.115)],
        [
            (0.040, 0.115),
            (0.062, 0.165),
            (0.076, 0.215),
            (0.074, 0.265),
            (0.058, 0.330),
            (0.040, 0.400),
            (0.031, 0.460),
            (0.032, 0.490),
        ],
        arc((0.030, 0.510), 0.020, -80, 80, 3),
        [(0.036, 0.535), (0.060, 0.570)],
    ]
    return {
        "stone": merged(
            [
                lathe(profile, 10),
                box((-0.075, 0, -0.075), (0.075, 0.05, 0.075), "-y"),
                box((-0.068, 0.57, -0.068), (0.068, 0.62, 0.068), "+y"),
            ]
        )
    }


def door():
    """A panelled door in a stone frame with a round head, standing against the back wall (its frame: z = 0)."""
    half, spring = 0.62, 2.05
    leaf = arch_sweep(0.0, spring, [[(0, 0.03), (half, 0.03)]], 16)
    panels = [box((-half, 0.0, -0.01), (half, spring, 0.03), "-y +y -z")]
    for x in (-0.31, 0.31):
        for low, high in ((0.15, 0.75), (0.9, 1.9)):
            panels.append(box((x - 0.22, low, 0.02), (x + 0.22, high, 0.06), "-z"))
    frame = [archivolt(half, spring, 0.0, 0.2, 18)]
    for side in (-1, 1):
        x0, x1 = sorted((side * half, side * (half + 0.2)))
        frame.append(box((x0, 0, -0.01), (x1, spring, 0.055), "-z -y"))
        x0, x1 = sorted((side * (half - 0.02), side * (half + 0.24)))
        frame += [
            box((x0, 0, -0.01), (x1, 0.2, 0.085), "-z -y"),
            box((x0, spring - 0.09, -0.01), (x1, spring, 0.085), "-z"),
        ]
    return {"wood": merged([leaf] + panels), "stone": merged(frame + [keystone(half, spring, 0.08, 0.0)])}
