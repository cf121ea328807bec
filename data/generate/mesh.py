"""Triangle meshes and the shapes that the scenes are built of. Metres, +y up, counter-clockwise seen from the front.

Texture coordinates are metres along the surface (u right, v down), so that one material fits every shape; the
material says how many metres one tile of its picture covers.
"""

import numpy as np


class Mesh:
    """Positions, unit normals and uvs (n x 3, n x 3, n x 2 or None) and triangles (m x 3 indices)."""

    def __init__(self, positions, normals, uvs, triangles):
        self.positions = np.asarray(positions, dtype=float).reshape(-1, 3)
        self.normals = np.asarray(normals, dtype=float).reshape(-1, 3)
        self.uvs = None if uvs is None else np.asarray(uvs, dtype=float).reshape(-1, 2)
        self.triangles = np.asarray(triangles, dtype=int).reshape(-1, 3)

    def flipped(self):
        """The same surface seen from its other side."""
        return Mesh(self.positions, -self.normals, self.uvs, self.triangles[:, ::-1])

    def transformed(self, matrix, translation=(0.0, 0.0, 0.0)):
        """Every point p becomes matrix * p + translation; a mirror keeps its front in front."""
        matrix = np.asarray(matrix, dtype=float)
        normals = self.normals @ np.linalg.inv(matrix)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        triangles = self.triangles if np.linalg.det(matrix) > 0 else self.triangles[:, ::-1]
        return Mesh(self.positions @ matrix.T + np.asarray(translation, dtype=float), normals, self.uvs, triangles)

    def moved(self, x, y, z):
        return self.transformed(np.eye(3), (x, y, z))

    def turned_y(self, angle):
        c, s = np.cos(angle), np.sin(angle)
        return self.transformed([[c, 0, s], [0, 1, 0], [-s, 0, c]])

    def tangents(self):
        """Per-vertex tangents along +u, handedness as glTF: bitangent = w * cross(normal, tangent) points to -v."""
        p, t, tri = self.positions, self.uvs, self.triangles
        e1, e2 = p[tri[:, 1]] - p[tri[:, 0]], p[tri[:, 2]] - p[tri[:, 0]]
        d1, d2 = t[tri[:, 1]] - t[tri[:, 0]], t[tri[:, 2]] - t[tri[:, 0]]
        determinant = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
        sign = np.where(determinant < 0, -1.0, 1.0)[:, None]
        along_u = (e1 * d2[:, 1:] - e2 * d1[:, 1:]) * sign
        along_v = (e2 * d1[:, :1] - e1 * d2[:, :1]) * sign
        tangent, bitangent = np.zeros_like(p), np.zeros_like(p)
        for corner in range(3):
            np.add.at(tangent, tri[:, corner], along_u)
            np.add.at(bitangent, tri[:, corner], -along_v)
        tangent -= self.normals * np.sum(tangent * self.normals, axis=1, keepdims=True)
        length = np.linalg.norm(tangent, axis=1, keepdims=True)
        # A vertex without a direction of u (the pole of a lathe) takes any tangent.
        other = np.cross(self.normals, np.where(np.abs(self.normals[:, :1]) < 0.9, [[1.0, 0, 0]], [[0, 1.0, 0]]))
        other /= np.linalg.norm(other, axis=1, keepdims=True)
        tangent = np.where(length > 1e-12, tangent / np.maximum(length, 1e-12), other)
        handedness = np.sum(np.cross(self.normals, tangent) * bitangent, axis=1)
        return np.column_stack([tangent, np.where(handedness < 0, -1.0, 1.0)])


def merged(meshes):
    """One mesh of many."""
    meshes = list(meshes)
    starts = np.cumsum([0] + [len(m.positions) for m in meshes[:-1]])
    return Mesh(
        np.concatenate([m.positions for m in meshes]),
        np.concatenate([m.normals for m in meshes]),
        np.concatenate([m.uvs for m in meshes]),
        np.concatenate([m.triangles + start for m, start in zip(meshes, starts)]),
    )


def quad(a, b, c, d):
    """Two triangles of four corners, counter-clockwise from the lower left; uv from the origin of the object."""
    corners = np.array([a, b, c, d], dtype=float)
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    normal /= np.linalg.norm(normal)
    right = (corners[1] - corners[0]) / np.linalg.norm(corners[1] - corners[0])
    up = np.cross(normal, right)
    return Mesh(
        corners, np.tile(normal, (4, 1)), np.column_stack([corners @ right, -(corners @ up)]), [[0, 1, 2], [0, 2, 3]]
    )


def box(low, high, open_faces=""):
    """A closed box, or one without the faces named in `open_faces` (of "-x +x -y +y -z +z")."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    faces = {
        "-x": ((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)),
        "+x": ((x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)),
        "-y": ((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)),
        "+y": ((x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)),
        "-z": ((x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)),
        "+z": ((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)),
    }
    return merged(quad(*corners) for name, corners in faces.items() if name not in open_faces.split())


def surface(points, uvs=None):
    """A smooth sheet through a grid of points (n x m x 3); its front is where d(points)/dn x d(points)/dm looks.

    Normals are averaged over coinciding points, so a sheet that closes on itself has no seam. `uvs` (n x m x 2)
    default to lengths along the grid, u along n and v against m. Triangles without area are left out.
    """
    points = np.asarray(points, dtype=float)
    n, m = points.shape[:2]
    if uvs is None:
        along = np.linalg.norm(np.diff(points, axis=0), axis=2).mean(axis=1)
        across = np.linalg.norm(np.diff(points, axis=1), axis=2).mean(axis=0)
        u, v = np.concatenate([[0], np.cumsum(along)]), np.concatenate([[0], np.cumsum(across)])
        uvs = np.stack(np.meshgrid(u, -v, indexing="ij"), axis=2)
    corner = np.arange(n * m).reshape(n, m)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    triangles = np.stack([a, b, c, a, c, d], axis=2).reshape(-1, 3)
    flat = points.reshape(-1, 3)
    face = np.cross(flat[triangles[:, 1]] - flat[triangles[:, 0]], flat[triangles[:, 2]] - flat[triangles[:, 0]])
    solid = np.linalg.norm(face, axis=1) > 2e-8
    triangles, face = triangles[solid], face[solid]
    _, spot = np.unique(np.round(flat, 5), axis=0, return_inverse=True)
    sums = np.zeros((spot.max() + 1, 3))
    for k in range(3):
        np.add.at(sums, spot[triangles[:, k]], face)
    normals = sums[spot]
    used = np.unique(triangles)
    renumber = np.zeros(n * m, dtype=int)
    renumber[used] = np.arange(len(used))
    normals = normals[used] / np.linalg.norm(normals[used], axis=1, keepdims=True)
    return Mesh(flat[used], normals, np.asarray(uvs).reshape(-1, 2)[used], renumber[triangles])


def ring(segments, radius=1.0):
    """Points (segments + 1) x 2 around the y axis as (x, z), the first one again at the end."""
    angle = np.linspace(0, 2 * np.pi, segments + 1)
    angle[-1] = 0.0
    return radius * np.column_stack([np.sin(angle), np.cos(angle)])


def lathe(pieces, segments):
    """Turns profiles about the y axis. `pieces`: polylines of (radius, y), smooth within, creased between; going up,
    the front is outside."""
    meshes = []
    around = ring(segments)
    widest = max(radius for piece in pieces for radius, _ in piece)
    for piece in pieces:
        radius, y = np.array(piece, dtype=float).T
        points = np.stack(
            [around[:, :1] * radius, np.broadcast_to(y, (segments + 1, len(y))), around[:, 1:] * radius], axis=2
        )
        length = np.concatenate([[0], np.cumsum(np.hypot(np.diff(radius), np.diff(y)))]) + y[0]
        u = np.linspace(0, 2 * np.pi * widest, segments + 1)
        meshes.append(surface(points, np.stack(np.meshgrid(u, -length, indexing="ij"), axis=2)))
    return merged(meshes)


def arc(centre, radius, start, end, steps):
    """Points on a circle in a profile's plane, angles in degrees."""
    angle = np.radians(np.linspace(start, end, steps + 1))
    return [(centre[0] + radius * np.cos(a), centre[1] + radius * np.sin(a)) for a in angle]


def rectangle_moulding(half_x, half_z, pieces):
    """A moulding around the inside of a rectangle, mitred. `pieces`: polylines of (projection inwards, y), creased
    between each other; going down, the front looks inwards and down."""
    meshes = []
    for piece in pieces:
        offset, y = np.array(piece, dtype=float).T
        for side in range(4):
            lengthwise, across = (half_x, half_z) if side % 2 == 0 else (half_z, half_x)
            along = lengthwise - offset
            points = np.stack(
                [np.stack([-along, y, -(across - offset)], axis=1), np.stack([along, y, -(across - offset)], axis=1)]
            )
            length = np.concatenate([[0], np.cumsum(np.hypot(np.diff(offset), np.diff(y)))])
            uvs = np.stack([np.column_stack([-along, length]), np.column_stack([along, length])])
            meshes.append(surface(points, uvs).flipped().turned_y(-side * np.pi / 2))
    return merged(meshes)


def arch_wall(half_width, radius, springing, top, steps):
    """The front (facing +z, in z = 0) of a wall pier to pier with a round-headed opening about x = 0."""
    angle = np.linspace(np.pi, 0, steps + 1)
    x, y = radius * np.cos(angle), springing + radius * np.sin(angle)
    positions, triangles = [], []
    for column, (px, py) in enumerate(zip(x, y)):
        positions += [(px, py, 0.0), (px, top, 0.0)]
        if column:
            k = 2 * column
            triangles += [(k - 2, k, k + 1), (k - 2, k + 1, k - 1)]
    positions = np.array(positions)
    head = Mesh(
        positions,
        np.tile([0.0, 0.0, 1.0], (len(positions), 1)),
        np.column_stack([positions[:, 0], -positions[:, 1]]),
        triangles,
    )
    pier = quad((-half_width, springing, 0), (-radius, springing, 0), (-radius, top, 0), (-half_width, top, 0))
    other = quad((radius, springing, 0), (half_width, springing, 0), (half_width, top, 0), (radius, top, 0))
    return merged([head, pier, other])


def arch_sweep(radius, springing, pieces, steps):
    """Carries a profile round a semicircular arch about x = 0. `pieces`: polylines of (distance beyond the radius,
    z); going outwards along the profile, the front looks to +z; going to +z, it looks at the centre."""
    angle = np.linspace(np.pi, 0, steps + 1)
    meshes = []
    for piece in pieces:
        offset, z = np.array(piece, dtype=float).T
        r = radius + offset
        points = np.stack(
            [
                np.cos(angle)[:, None] * r,
                springing + np.sin(angle)[:, None] * r,
                np.broadcast_to(z, (steps + 1, len(z))),
            ],
            axis=2,
        )
        meshes.append(surface(points))
    return merged(meshes)
