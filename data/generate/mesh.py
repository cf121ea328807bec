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
        """Per-vertex tangents along +u with the handedness of glTF: bitangent = w * cross(normal, tangent) is up, -v."""
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
    return Mesh(np.concatenate([m.positions for m in meshes]), np.concatenate([m.normals for m in meshes]),
                np.concatenate([m.uvs for m in meshes]),
                np.concatenate([m.triangles + start for m, start in zip(meshes, starts)]))


def quad(a, b, c, d):
    """Two triangles of four corners, counter-clockwise from the lower left; uv in metres, v = 0 at the lower edge."""
    corners = np.array([a, b, c, d], dtype=float)
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    normal /= np.linalg.norm(normal)
    right = (corners[1] - corners[0]) / np.linalg.norm(corners[1] - corners[0])
    up = np.cross(normal, right)
    offsets = corners - corners[0]
    return Mesh(corners, np.tile(normal, (4, 1)), np.column_stack([offsets @ right, -(offsets @ up)]),
                [[0, 1, 2], [0, 2, 3]])
