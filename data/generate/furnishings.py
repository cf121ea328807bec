"""What makes atrium.glb lived in: cloth, plants, pots, a fountain, lanterns. Each function returns {material: Mesh}."""

import numpy as np

from mesh import Mesh, arc, box, lathe, merged, surface


def curtain(width, height, folds, gather, seed):
    """A hanging curtain, top edge on y = 0 from x = 0 to `width`, falling to -height. `gather` in [0; 1] draws it
    together at two thirds of the height, as by a tie."""
    rng = np.random.default_rng(seed)
    columns, rows = folds * 12, 18
    s, t = np.linspace(0, 1, columns + 1)[:, None], np.linspace(0, 1, rows + 1)[None, :]
    depth = 0.19 * width / folds * rng.uniform(0.7, 1.3, folds + 2)
    fold = np.interp(s[:, 0] * folds, np.arange(folds + 2), depth)[:, None]
    wander = 0.9 * np.sin(3.1 * t + rng.uniform(0, 6)) * np.sin(5 * s + rng.uniform(0, 6))
    z = fold * (0.35 + 0.65 * np.sqrt(t)) * np.sin(2 * np.pi * folds * s + wander * t)
    z = z + 0.03 * t * np.sin(4.5 * s + rng.uniform(0, 6)) * np.sin(2.2 * t + 1)
    waist = np.exp(-(((t - 0.62) / 0.2) ** 2)) + 0.35 * (t > 0.62) * (1 - np.exp(-(((t - 0.62) / 0.2) ** 2)))
    squeeze = 1 - gather * 0.7 * waist
    x = width * squeeze * (s + 0.04 / folds * np.cos(4 * np.pi * folds * s) * t)
    y = (
        -height * t
        + 0.035 * np.sin(2 * np.pi * folds * s + 1.0) * t * t
        - 0.05 * (np.abs(((s * folds) % 1) - 0.5) - 0.25) * (1 - t) ** 6
    )
    z = z * (1 + 0.2 * gather * waist)
    points = np.stack([x + 0 * t, y + 0 * s, z + 0 * s * t], axis=2)
    uvs = np.stack([s * width * 1.5 + 0 * t, height * t + 0 * s], axis=2)
    return surface(points, uvs).flipped()


def banner(width, length, seed):
    """Cloth laid over the balustrade's rail: it starts behind (-z), passes over y = 0 and hangs down in front."""
    rng = np.random.default_rng(seed)
    over = [
        (-0.165, -0.35),
        (-0.165, -0.2),
        (-0.163, -0.06),
        (-0.155, -0.008),
        (-0.13, 0.008),
        (0.0, 0.010),
        (0.13, 0.008),
        (0.157, -0.008),
        (0.168, -0.05),
    ]
    fall = np.arange(1, 17) / 16
    ease = np.clip(fall * length / 0.85, 0, 1)  # it falls outwards, clear of the string course 0.9 m below the rail
    path = np.array(over + list(zip(0.17 + 0.43 * ease * ease * (3 - 2 * ease), -0.05 - (length - 0.05) * fall)))
    distance = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    s = np.linspace(0, 1, 33)
    hang = np.clip((distance - distance[8]) / (distance[-1] - distance[8]), 0, 1)
    phases = rng.uniform(0, 6, 3)
    ripple = 0.030 * np.sin(2 * np.pi * 2.4 * s + phases[0]) + 0.014 * np.sin(2 * np.pi * 5.3 * s + phases[1])
    z = path[:, 0][None, :] + np.sqrt(hang)[None, :] * (
        ripple[:, None] + 0.03 + 0.03 * np.sin(5 * hang + phases[2])[None, :]
    )
    x = (s[:, None] - 0.5) * width * (1 - 0.05 * hang[None, :])
    y = path[:, 1][None, :] - 0.03 * hang[None, :] ** 4 * np.cos(2 * np.pi * (s[:, None] - 0.5))
    points = np.stack([x, y, z], axis=2)
    uvs = np.stack([np.broadcast_to(s[:, None] * width, x.shape), np.broadcast_to(distance[None, :], x.shape)], axis=2)
    return surface(points, uvs).flipped()


def tapestry(width, height, seed):
    """A heavy cloth that hangs flat against a wall in its frame's z = 0, top edge on y = 0, centred on x = 0."""
    rng = np.random.default_rng(seed)
    s, t = np.linspace(0, 1, 41)[:, None], np.linspace(0, 1, 21)[None, :]
    wave = sum(
        a * np.sin(2 * np.pi * f * s + rng.uniform(0, 6) + 0.7 * t)
        for f, a in ((2.2, 0.016), (4.9, 0.010), (8.3, 0.006))
    )
    z = 0.09 + wave * (0.35 + 0.65 * t) + 0.02 * t
    points = np.stack(np.broadcast_arrays((s - 0.5) * width, -height * t, z), axis=2)
    uvs = np.stack(np.broadcast_arrays(s * width, height * t), axis=2)
    return surface(points, uvs).flipped()


def rod(length, radius=0.022):
    """A curtain rod along x from 0 to `length`, with knobs."""
    bar = lathe([[(radius, 0.0), (radius, length)]], 10)
    knob = lathe([arc((0, 0), radius * 2.2, -90, 90, 8)], 12)
    lie = lambda m: m.transformed([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    return {"iron": merged([lie(bar), lie(knob), lie(knob.moved(0, length, 0))])}


def pot(radius, height):
    """A terracotta pot with a rim, and earth in it."""
    r, h = radius, height
    shell = lathe(
        [
            [(0.0, 0.0), (0.62 * r, 0.0)],
            [(0.62 * r, 0.0), (0.80 * r, 0.45 * h), (0.92 * r, 0.80 * h)],
            [(0.92 * r, 0.80 * h), (1.02 * r, 0.81 * h)],
            arc((0.98 * r, 0.89 * h), 0.09 * h, -70, 90, 6),
            [(0.98 * r, 0.98 * h), (0.88 * r, 0.97 * h)],
            [(0.88 * r, 0.97 * h), (0.84 * r, 0.82 * h)],
        ],
        28,
    )
    earth = lathe([[(0.86 * r, 0.86 * h), (0.5 * r, 0.89 * h), (0.0, 0.90 * h)]], 20)
    return {"terracotta": shell, "earth": earth}


def spray(size):
    """One card with the picture of a spray of leaves, bent a little; its stem starts at the origin, it grows to +y."""
    s = np.linspace(-0.5, 0.5, 3)
    t = np.linspace(0, 1, 4)
    points = np.stack(
        np.broadcast_arrays(
            s[:, None] * size,
            (t - 0.10 * t * t)[None, :] * size,
            (0.22 * t**2)[None, :] * size - 0.25 * np.abs(s)[:, None] * size * 0.5,
        ),
        axis=2,
    )
    uvs = np.stack(np.broadcast_arrays(s[:, None] + 0.5, 1 - t[None, :]), axis=2)
    return surface(points, uvs)


def _aim(card, direction, roll):
    """Turns a card from +y to `direction`, after a turn by `roll` about its stem."""
    card = card.turned_y(roll)
    d = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    side = np.cross(d, (0.0, 0.0, 1.0) if abs(d[1]) > 0.9 else (0.0, 1.0, 0.0))
    side /= np.linalg.norm(side)
    return card.transformed(np.column_stack([side, d, np.cross(side, d)]))


def bush(radius, count, size, seed):
    """A round head of sprays about the origin."""
    rng = np.random.default_rng(seed)
    card = spray(size)
    cards = []
    for k in range(count):
        # Directions by the golden angle: even cover without pattern.
        y = 1 - 1.75 * (k + 0.5) / count
        around = k * 2.399963
        d = np.array([np.sqrt(1 - y * y) * np.cos(around), y, np.sqrt(1 - y * y) * np.sin(around)])
        start = d * radius * rng.uniform(0.25, 0.62)
        lean = d + rng.normal(0, 0.28, 3) + (0, 0.25, 0)
        cards.append(_aim(card, lean, rng.uniform(0, 2 * np.pi)).moved(*start))
    return {"leaves": merged(cards)}


def trunk(height, radius):
    return {
        "bark": lathe(
            [[(radius * 1.25, 0.0), (radius, height * 0.2), (radius * 0.9, height * 0.7), (radius * 0.75, height)]], 10
        )
    }


def citrus(seed):
    """A clipped little tree, 2.1 m with its pot."""
    head = bush(0.62, 150, 0.44, seed)["leaves"].moved(0, 1.50, 0)
    rng = np.random.default_rng(seed + 1)
    fruit = []
    ball = lathe([arc((0, 0), 0.042, -90, 90, 4)], 7)
    for _ in range(16):
        d = rng.normal(0, 1, 3)
        d /= np.linalg.norm(d)
        fruit.append(ball.moved(*(d * rng.uniform(0.5, 0.66) + (0, 1.52, 0))))
    parts = dict(pot(0.34, 0.58))
    parts["leaves"], parts["fruit"] = head, merged(fruit)
    parts["bark"] = trunk(1.1, 0.035)["bark"].moved(0, 0.5, 0)
    return parts


def fern(seed):
    """A low pot of arching sprays."""
    rng = np.random.default_rng(seed)
    card = spray(0.66)
    cards = []
    for k in range(44):
        around, rise = k * 2.399963, rng.uniform(0.35, 1.9) * (1 + 0.9 * (k % 5 == 0))
        cards.append(_aim(card, (np.cos(around), rise, np.sin(around)), rng.uniform(0, 2 * np.pi)).moved(0, 0.36, 0))
    parts = dict(pot(0.28, 0.42))
    parts["leaves"] = merged(cards)
    return parts


def fountain():
    """An octagonal basin with a stepped foot, a baluster stem and a bowl; water stands in both."""

    def octagon(pieces):
        return lathe([[p, q] for piece in pieces for p, q in zip(piece, piece[1:])], 8)

    basin = octagon(
        [
            [
                (2.10, -0.15),
                (2.10, 0.0),
                (1.80, 0.0),
                (1.80, 0.14),
                (1.58, 0.14),
                (1.52, 0.20),
                (1.47, 0.30),
                (1.47, 0.62),
                (1.52, 0.66),
                (1.58, 0.70),
                (1.58, 0.80),
                (1.36, 0.80),
                (1.36, 0.20),
            ]
        ]
    )
    # Each wall of the octagon is flat: its corners are creased, not rounded.
    flat = flat_faces(basin).turned_y(np.pi / 8)
    stem = lathe(
        [
            [(0.36, 0.2), (0.36, 0.62)],
            [(0.36, 0.62), (0.26, 0.66)],
            arc((0.22, 0.72), 0.06, -90, 90, 6),
            [(0.20, 0.78), (0.13, 0.90), (0.12, 1.0), (0.17, 1.12), (0.18, 1.2), (0.12, 1.34), (0.10, 1.44)],
            arc((0.11, 1.47), 0.035, -90, 90, 5),
            [(0.11, 1.50), (0.20, 1.52), (0.42, 1.57), (0.62, 1.66), (0.72, 1.76)],
            arc((0.71, 1.785), 0.03, -60, 120, 6),
            [(0.69, 1.81), (0.60, 1.74), (0.40, 1.68), (0.0, 1.66)],
        ],
        32,
    )
    finial = lathe([[(0.10, 1.66), (0.08, 1.80), (0.05, 1.86)], arc((0.0, 1.94), 0.085, -60, 90, 8)], 16)
    water = merged([lathe([[(1.37, 0.66), (0.0, 0.66)]], 24), lathe([[(0.655, 1.775), (0.0, 1.775)]], 24)])
    return {"stone": merged([flat, stem, finial]), "water": water}


def flat_faces(mesh):
    """The same triangles, each with its own normal."""
    corners = mesh.positions[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Mesh(
        corners.reshape(-1, 3),
        np.repeat(normals, 3, axis=0),
        mesh.uvs[mesh.triangles].reshape(-1, 2),
        np.arange(3 * len(mesh.triangles)).reshape(-1, 3),
    )


def lantern(chain):
    """An iron lantern with milk glass, hanging by a chain of the given length from y = 0."""
    frame = []
    for k in range(int(chain / 0.06)):
        frame.append(
            box((-0.006, -0.06 * (k + 1) + 0.008, -0.012), (0.006, -0.06 * k - 0.002, 0.012)).turned_y(
                (k % 2) * np.pi / 2
            )
        )
    cap = lathe([[(0.17, -0.16), (0.15, -0.12), (0.06, -0.06)], [(0.06, -0.06), (0.02, 0.0)]], 6)
    under = lathe([[(0.0, -0.16), (0.17, -0.16)]], 6)
    foot = lathe([[(0.0, -0.52), (0.05, -0.50), (0.11, -0.46)], [(0.11, -0.46), (0.0, -0.455)]], 6)
    bars = [
        box((-0.008, -0.47, -0.008), (0.008, -0.15, 0.008), "-y +y")
        .transformed([[1, 0, 0], [0, 1, 0], [0, 0.10, 1]])
        .moved(0, 0, 0.172)
        .turned_y(np.pi / 3 * k)
        for k in range(6)
    ]
    glass = lathe([[(0.095, -0.46), (0.145, -0.16)]], 6)
    lower = lambda m: m.moved(0, -chain, 0)
    return {"iron": merged(frame + [lower(m) for m in [cap, under, foot] + bars]), "milk_glass": lower(glass)}
