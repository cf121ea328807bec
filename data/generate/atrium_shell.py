"""What encloses atrium.glb: floors, walls, cornices, ceiling and roof. Each function returns {material: Mesh} in the
frame that atrium_plan.py describes, or about the court's centre where it takes half_x and half_z.
"""

import numpy as np

from atrium_parts import archivolt
from atrium_plan import (
    BAY,
    COURT_LEVEL,
    STEP,
    HALF_WALL,
    UPPER_FLOOR,
    UPPER_HALF_WALL,
    CEILING,
    EAVES_OUT,
    EAVES_LEVEL,
    OUTER,
    ROOF_PITCH,
    DADO,
    WINDOW_RADIUS,
    WINDOW_SPRINGING,
)
from mesh import Mesh, arc, arch_sweep, arch_wall, box, merged, quad, rectangle_moulding, surface


def cornice(half_x, half_z):
    """The string course between the storeys and the cornice under the eaves, all round the court."""
    w, u = HALF_WALL, UPPER_HALF_WALL
    f = UPPER_FLOOR
    course = [
        [(w, f - 0.34), (w + 0.04, f - 0.34)],
        [(w + 0.04, f - 0.34), (w + 0.04, f - 0.24)],
        [(w + 0.04, f - 0.24)] + arc((w + 0.16, f - 0.24), 0.10, 180, 90, 6) + [(w + 0.16, f - 0.14)],
        [(w + 0.16, f - 0.14), (w + 0.24, f - 0.14)],
        [(w + 0.24, f - 0.14), (w + 0.24, f - 0.05)],
        [(w + 0.24, f - 0.05)] + arc((w + 0.24, f - 0.025), 0.025, -90, 90, 6) + [(w + 0.24, f)],
        [(w + 0.24, f), (-BAY, f)],
    ]
    top = CEILING + 0.17
    crown = [
        [(u, CEILING - 0.16), (u + 0.03, CEILING - 0.16)],
        [(u + 0.03, CEILING - 0.16), (u + 0.03, CEILING - 0.06)],
        [(u + 0.03, CEILING - 0.06)] + arc((u + 0.13, CEILING - 0.06), 0.10, 180, 90, 6),
        [(u + 0.13, CEILING + 0.04), (u + 0.20, CEILING + 0.04)],
        [(u + 0.20, CEILING + 0.04), (u + 0.20, top)],
    ]
    # These run upwards, so they look outwards before they are turned round.
    upward = lambda pieces: [piece[::-1] for piece in pieces]
    return {"stone": rectangle_moulding(half_x, half_z, upward(course) + upward(crown))}


def shell(half_x, half_z):
    """Everything that runs round the court in one piece: floors, back walls, ceiling, outer walls and roof."""
    band = lambda *points: rectangle_moulding(half_x, half_z, [list(points)])
    ridge = EAVES_LEVEL + (EAVES_OUT + OUTER) * ROOF_PITCH
    inset = -BAY
    rail = [
        [(inset, DADO + 0.07), (inset + 0.05, DADO + 0.07)],
        [(inset + 0.05, DADO + 0.07), (inset + 0.05, DADO + 0.03)],
        arc((inset + 0.02, DADO + 0.03), 0.03, 0, -90, 4),
        [(inset + 0.02, DADO), (inset, DADO)],
    ]
    base = [[(inset, 0.20), (inset + 0.03, 0.20)], [(inset + 0.03, 0.20), (inset + 0.03, 0.0)]]
    soffit = EAVES_LEVEL - 0.10
    north_inside, north_outside = band((inset, UPPER_FLOOR), (inset, DADO + 0.07)), band(
        (-OUTER, 0), (-OUTER, UPPER_FLOOR)
    )
    return {
        "arcade_tiles": band((inset, 0), (STEP - 0.3, 0)),
        "stone": merged(
            [
                band((STEP - 0.3, 0), (STEP, 0)),
                band((STEP, 0), (STEP, COURT_LEVEL)),
                rectangle_moulding(half_x, half_z, rail + base),
            ]
        ),
        "dado": band((inset, DADO), (inset, 0.20)),
        "plaster": merged(
            [
                without_south(north_inside),
                without_south(north_outside),
                band((inset, CEILING), (inset, UPPER_FLOOR)),
                band((-OUTER, COURT_LEVEL - 0.4), (-OUTER, 0)),
                band((-OUTER, UPPER_FLOOR), (-OUTER, ridge)),
            ]
        ),
        "wood": merged(
            [
                band((-UPPER_HALF_WALL, CEILING), (inset, CEILING)),
                band((EAVES_OUT, soffit), (UPPER_HALF_WALL, soffit)),
                band((EAVES_OUT, EAVES_LEVEL), (EAVES_OUT, soffit)),
            ]
        ),
        "terracotta": band((-OUTER, ridge), (EAVES_OUT, EAVES_LEVEL)),
    }


def without_south(wall):
    """A wall that runs round the court, less its stretch at -z."""
    south = (wall.positions[wall.triangles][:, :, 2] < 0).all(axis=1)
    return Mesh(wall.positions, wall.normals, wall.uvs, wall.triangles[~south])


def south_wall(half_x):
    """The lower south wall above the dado, with a window on the axis of each long arcade; its frame is the side's."""
    reach, centre = half_x + BAY, half_x + BAY / 2
    sill = DADO + 0.07
    inside, outside = [], []
    for faces, end, level in ((inside, reach, sill), (outside, half_x + OUTER, 0.0)):
        faces.append(quad((-half_x, level, 0), (half_x, level, 0), (half_x, UPPER_FLOOR, 0), (-half_x, UPPER_FLOOR, 0)))
        for side in (-1, 1):
            head = arch_wall(BAY / 2, WINDOW_RADIUS, WINDOW_SPRINGING, UPPER_FLOOR, 20)
            faces.append(head.moved(side * centre, 0, 0))
            jambs = [(-BAY / 2, -WINDOW_RADIUS, level), (WINDOW_RADIUS, BAY / 2, level)]
            if level < sill:
                jambs.append((-WINDOW_RADIUS, WINDOW_RADIUS, level))
            for x0, x1, low in jambs:
                top = sill if x0 < 0 < x1 else WINDOW_SPRINGING
                faces.append(quad((x0, low, 0), (x1, low, 0), (x1, top, 0), (x0, top, 0)).moved(side * centre, 0, 0))
            if end > reach:
                x0, x1 = sorted((side * reach, side * end))
                faces.append(quad((x0, 0, 0), (x1, 0, 0), (x1, UPPER_FLOOR, 0), (x0, UPPER_FLOOR, 0)))
    reveals, bars = [], []
    r, top = WINDOW_RADIUS, WINDOW_SPRINGING
    for side in (-1, 1):
        reveal = [
            arch_sweep(r, top, [[(0, -OUTER), (0, -BAY)]], 20),
            archivolt(r, top, -BAY, 0.16, 20),
            quad((-r, sill, -BAY), (-r, sill, -OUTER), (-r, top, -OUTER), (-r, top, -BAY)),
            quad((r, sill, -OUTER), (r, sill, -BAY), (r, top, -BAY), (r, top, -OUTER)),
            quad((-r, sill, -BAY), (r, sill, -BAY), (r, sill, -OUTER), (-r, sill, -OUTER)),
        ]
        for edge in (-1, 1):
            x0, x1 = sorted((edge * r, edge * (r + 0.16)))
            reveal.append(box((x0, sill, -BAY - 0.01), (x1, top, -BAY + 0.045), "-z -y"))
        reveals += [m.moved(side * centre, 0, 0) for m in reveal]
        grille = [
            box((x - 0.012, sill, -OUTER + 0.1), (x + 0.012, top + np.sqrt(r * r - x * x), -OUTER + 0.124), "-y +y")
            for x in (-0.45, -0.27, -0.09, 0.09, 0.27, 0.45)
        ]
        grille += [
            box((-r, y - 0.012, -OUTER + 0.09), (r, y + 0.012, -OUTER + 0.098), "-x +x") for y in (1.5, 1.9, 2.25)
        ]
        bars += [m.moved(side * centre, 0, 0) for m in grille]
    return {
        "plaster": merged(
            [m.moved(0, 0, -BAY) for m in inside] + [m.turned_y(np.pi).moved(0, 0, -OUTER) for m in outside]
        ),
        "stone": merged(reveals),
        "iron": merged(bars),
    }


def beams(half_length, spacing):
    """Ceiling beams of one side of the gallery and the rafter tails under its eaves, along x."""
    wood = []
    count = int(2 * half_length / spacing)
    for k in range(count):
        x = (k - (count - 1) / 2) * spacing
        wood.append(box((x - 0.07, CEILING - 0.2, -BAY), (x + 0.07, CEILING, -UPPER_HALF_WALL), "+y -z +z"))
    tails = int(2 * (half_length - EAVES_OUT) / 0.4)
    for k in range(tails):
        x = (k - (tails - 1) / 2) * 0.4
        wood.append(
            box(
                (x - 0.045, EAVES_LEVEL - 0.2, UPPER_HALF_WALL + 0.2),
                (x + 0.045, EAVES_LEVEL - 0.1, EAVES_OUT - 0.08),
                "+y -z",
            )
        )
    return {"wood": merged(wood)}


def dentils(half_length):
    """The rows of small blocks under the string course and the cornice of one side, along x."""
    blocks = []
    for level, z, size in (
        (UPPER_FLOOR - 0.22, HALF_WALL + 0.04, 0.085),
        (CEILING - 0.05, UPPER_HALF_WALL + 0.03, 0.075),
    ):
        count = int(2 * (half_length - z - 0.1) / (2 * size))
        for k in range(count):
            x = (k - (count - 1) / 2) * 2 * size
            blocks.append(
                box((x - size / 2, level - 0.01, z - 0.01), (x + size / 2, level + 0.08, z + size * 0.9), "-z +y")
            )
    return {"stone": merged(blocks)}


TILE_COUNT = 11


def tile_column(count):
    """The uppermost `count` roof tiles of one column, ridge to eaves; the slope's own frame is that of the bay."""
    tiles = []
    run = (EAVES_OUT + OUTER) / TILE_COUNT
    angle = np.linspace(np.pi, 0, 5)
    ridge = EAVES_LEVEL + (EAVES_OUT + OUTER) * ROOF_PITCH
    for k in range(count):
        z0, z1 = -OUTER + run * k, -OUTER + run * (k + 1) + 0.04
        rings = []
        for z, radius, lift in ((z0, 0.070, -0.012), (z1, 0.092, 0.012), (z1, 0.074, 0.010)):
            y = ridge - (z + OUTER) * ROOF_PITCH
            rings.append(
                np.stack([radius * np.cos(angle), y + lift + radius * np.sin(angle), np.full_like(angle, z)], axis=1)
            )
        tiles.append(surface(np.stack([rings[1], rings[0]], axis=1)))
        tiles.append(surface(np.stack([rings[2], rings[1]], axis=1)))
    return {"terracotta": merged(tiles)}
