"""Writes binary glTF 2.0 (.glb): meshes, materials, embedded pictures, cameras and KHR_lights_punctual.

One `Glb` is one file. Every add function returns the index that glTF itself uses. Nothing here depends on the
time, on the machine or on the order of a hash: the same calls give the same bytes.
"""

import json
import struct

import numpy as np

FLOAT, UINT16, UINT32 = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
TYPE_OF_WIDTH = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def plain(values):
    """A list of Python floats that are exactly the 32-bit values given."""
    return [float(np.float32(v)) for v in values]


class Glb:
    """A scene under construction; `write` turns it into bytes."""

    def __init__(self, scene_name, copyright_line):
        self.binary = bytearray()
        self.extensions = set()
        self.accessors_of = {}  # (id of a mesh.Mesh, with tangents?) -> (the mesh, kept alive; attributes; indices)
        self.json = {
            "asset": {"version": "2.0", "generator": "earthshine data/generate", "copyright": copyright_line},
            "scene": 0,
            "scenes": [{"name": scene_name, "nodes": []}],
        }

    def _add(self, kind, value):
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def _add_view(self, data, target=None):
        self.binary.extend(b"\0" * (-len(self.binary) % 4))
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.binary.extend(data)
        return self._add("bufferViews", view)

    def _add_attribute(self, values, bounds=False):
        data = np.ascontiguousarray(values, dtype="<f4")
        accessor = {
            "bufferView": self._add_view(data.tobytes(), ARRAY_BUFFER),
            "componentType": FLOAT,
            "count": len(data),
            "type": TYPE_OF_WIDTH[data.shape[1]],
        }
        if bounds:
            accessor["min"], accessor["max"] = plain(data.min(axis=0)), plain(data.max(axis=0))
        return self._add("accessors", accessor)

    def _add_indices(self, triangles, vertex_count):
        wide = vertex_count > 65535
        data = np.ascontiguousarray(triangles, dtype="<u4" if wide else "<u2")
        return self._add(
            "accessors",
            {
                "bufferView": self._add_view(data.tobytes(), ELEMENT_ARRAY_BUFFER),
                "componentType": UINT32 if wide else UINT16,
                "count": int(data.size),
                "type": "SCALAR",
            },
        )

    def add_image(self, name, data, mime_type):
        """Embeds an encoded picture; `data` are its bytes."""
        return self._add("images", {"name": name, "mimeType": mime_type, "bufferView": self._add_view(data)})

    def add_texture(self, image):
        """A texture that repeats and is filtered with mipmaps."""
        if "samplers" not in self.json:
            self._add("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497})
        return self._add("textures", {"source": image, "sampler": 0})

    def texture_info(self, texture, tile=(1.0, 1.0), offset=(0.0, 0.0)):
        """Where a material reads a texture: one tile of it covers `tile` units of uv."""
        info = {"index": texture}
        if tuple(tile) != (1.0, 1.0) or tuple(offset) != (0.0, 0.0):
            self.extensions.add("KHR_texture_transform")
            transform = {"scale": [1.0 / tile[0], 1.0 / tile[1]]}
            if tuple(offset) != (0.0, 0.0):
                transform["offset"] = list(offset)
            info["extensions"] = {"KHR_texture_transform": transform}
        return info

    def add_material(
        self,
        name,
        color=(1.0, 1.0, 1.0),
        color_texture=None,
        normal_texture=None,
        double_sided=False,
        alpha_cutoff=None,
    ):
        """A Lambertian surface: `color` is linear Rec. 709 and multiplies the picture; textures are texture_info."""
        pbr = {"baseColorFactor": list(color) + [1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
        if color_texture:
            pbr["baseColorTexture"] = color_texture
        material = {"name": name, "pbrMetallicRoughness": pbr}
        if normal_texture:
            material["normalTexture"] = normal_texture
        if alpha_cutoff is not None:
            material.update(alphaMode="MASK", alphaCutoff=alpha_cutoff)
        if double_sided:
            material["doubleSided"] = True
        return self._add("materials", material)

    def add_mesh(self, name, parts):
        """`parts`: pairs of a mesh.Mesh and a material index. Tangents are written where there is a normal map."""
        primitives = []
        for mesh, material in parts:
            attributes, indices = self._add_geometry(mesh, "normalTexture" in self.json["materials"][material])
            primitives.append({"attributes": attributes, "indices": indices, "material": material})
        return self._add("meshes", {"name": name, "primitives": primitives})

    def _add_geometry(self, mesh, with_tangents):
        """The accessors of a mesh; those of one that was added before serve again."""
        key = (id(mesh), with_tangents)
        if key not in self.accessors_of:
            attributes = {
                "POSITION": self._add_attribute(mesh.positions, bounds=True),
                "NORMAL": self._add_attribute(mesh.normals),
            }
            if mesh.uvs is not None:
                attributes["TEXCOORD_0"] = self._add_attribute(mesh.uvs)
            if with_tangents:
                attributes["TANGENT"] = self._add_attribute(mesh.tangents())
            self.accessors_of[key] = (mesh, attributes, self._add_indices(mesh.triangles, len(mesh.positions)))
        return self.accessors_of[key][1:]

    def place_camera(self, name, vertical_fov, aspect, near, far, position, target):
        """A perspective camera at `position`, looking at `target`; `vertical_fov` in radians, planes in metres."""
        camera = self._add(
            "cameras",
            {
                "name": name,
                "type": "perspective",
                "perspective": {"yfov": float(vertical_fov), "aspectRatio": float(aspect), "znear": near, "zfar": far},
            },
        )
        return self.add_node(
            f"camera.{name}", camera=camera, translation=position, rotation=look_rotation(np.subtract(target, position))
        )

    def add_light(self, name, kind, intensity, color=(1.0, 1.0, 1.0), cone=None):
        """`kind`: "directional" (lux) or "spot" (candela; `cone`: inner and outer half angle in radians)."""
        self.extensions.add("KHR_lights_punctual")
        light = {"name": name, "type": kind, "color": list(color), "intensity": intensity}
        if cone:
            light["spot"] = {"innerConeAngle": cone[0], "outerConeAngle": cone[1]}
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        return len(lights) - 1

    def add_node(self, name, mesh=None, camera=None, light=None, translation=None, rotation=None, scale=None):
        """Places something in the world; `rotation` is a unit quaternion (x, y, z, w)."""
        node = {"name": name}
        if mesh is not None:
            node["mesh"] = mesh
        if camera is not None:
            node["camera"] = camera
        if light is not None:
            node["extensions"] = {"KHR_lights_punctual": {"light": light}}
        if translation is not None:
            node["translation"] = plain(translation)
        if rotation is not None:
            node["rotation"] = plain(rotation)
        if scale is not None:
            node["scale"] = plain(scale)
        index = self._add("nodes", node)
        self.json["scenes"][0]["nodes"].append(index)
        return index

    def add_animation(self, name, channels):
        """`channels`: (node, "translation", "rotation" or "scale", times in seconds, a value for each time[, kind]).

        `kind` is "LINEAR" (the default), "STEP" or "CUBICSPLINE"; that one has three values for each time: in-tangent,
        value, out-tangent.
        """
        animation = {"name": name, "samplers": [], "channels": []}
        for node, path, times, values, *kind in channels:
            data = np.ascontiguousarray(times, dtype="<f4")
            times_at = self._add(
                "accessors",
                {
                    "bufferView": self._add_view(data.tobytes()),
                    "componentType": FLOAT,
                    "count": len(data),
                    "type": "SCALAR",
                    "min": [float(data.min())],
                    "max": [float(data.max())],
                },
            )
            data = np.ascontiguousarray(values, dtype="<f4")
            values_at = self._add(
                "accessors",
                {
                    "bufferView": self._add_view(data.tobytes()),
                    "componentType": FLOAT,
                    "count": len(data),
                    "type": TYPE_OF_WIDTH[data.shape[1]],
                },
            )
            sampler = {"input": times_at, "output": values_at, "interpolation": kind[0] if kind else "LINEAR"}
            animation["channels"].append(
                {"sampler": len(animation["samplers"]), "target": {"node": node, "path": path}}
            )
            animation["samplers"].append(sampler)
        return self._add("animations", animation)

    def triangle_count(self):
        """Triangles drawn, over all instances."""
        per_mesh = [
            sum(self.json["accessors"][p["indices"]]["count"] // 3 for p in m["primitives"])
            for m in self.json["meshes"]
        ]
        return sum(per_mesh[n["mesh"]] for n in self.json["nodes"] if "mesh" in n)

    def write(self, path):
        """Writes the file and returns its size in bytes."""
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        if self.extensions:
            self.json["extensionsUsed"] = sorted(self.extensions)
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.binary) + b"\0" * (-len(self.binary) % 4)
        total = 12 + 8 + len(text) + 8 + len(binary)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, total))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
        return total


def look_rotation(forward, up=(0.0, 1.0, 0.0)):
    """The quaternion (x, y, z, w) that turns -z to `forward` and +y as near to `up` as it goes: cameras and lights."""
    z = -np.asarray(forward, dtype=float)
    z /= np.linalg.norm(z)
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    return quaternion(np.column_stack([x, np.cross(z, x), z]))


def quaternion(rotation):
    """The unit quaternion (x, y, z, w) of a 3x3 rotation, by the largest of its four components."""
    m = np.asarray(rotation, dtype=float)
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    squares = np.array([1 + 2 * m[0, 0] - trace, 1 + 2 * m[1, 1] - trace, 1 + 2 * m[2, 2] - trace, 1 + trace])
    largest = int(np.argmax(squares))
    q = {
        0: [squares[0], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
        1: [m[0, 1] + m[1, 0], squares[1], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
        2: [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], squares[2], m[1, 0] - m[0, 1]],
        3: [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], squares[3]],
    }[largest]
    return np.array(q) / np.linalg.norm(q)


def turn_y(angle):
    """The quaternion of a turn by `angle` radians about +y."""
    return np.array([0.0, np.sin(angle / 2), 0.0, np.cos(angle / 2)])
