"""Checks .glb files against what the scenes promise:  python3 data/generate/check.py data/*.glb

Container and alignment, accessor bounds, finite values, unit normals and tangents, windings that agree with the
normals, no triangle without area. Prints one line a file; the first broken promise ends it with exit code 1.
"""

import json
import struct
import sys

import numpy as np

COMPONENT = {5126: "<f4", 5125: "<u4", 5123: "<u2"}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Broken(Exception):
    pass


def require(condition, message):
    if not condition:
        raise Broken(message)


def load(path):
    """The JSON and the binary chunk of a .glb."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version, total = struct.unpack_from("<4sII", data)
    require(magic == b"glTF" and version == 2 and total == len(data), "header")
    json_size, json_kind = struct.unpack_from("<I4s", data, 12)
    require(json_kind == b"JSON" and json_size % 4 == 0, "JSON chunk")
    size, kind = struct.unpack_from("<I4s", data, 20 + json_size)
    require(kind == b"BIN\0" and size % 4 == 0 and 28 + json_size + size == total, "BIN chunk")
    return json.loads(data[20 : 20 + json_size]), data[28 + json_size :]


def read_accessor(gltf, binary, index):
    """The values of an accessor, count x width; views here are tightly packed."""
    accessor = gltf["accessors"][index]
    view = gltf["bufferViews"][accessor["bufferView"]]
    dtype = np.dtype(COMPONENT[accessor["componentType"]])
    width = WIDTH[accessor["type"]]
    require(view["byteOffset"] % 4 == 0, f"bufferView of accessor {index} is not aligned")
    require(
        view["byteLength"] == accessor["count"] * width * dtype.itemsize, f"accessor {index} does not fill its view"
    )
    require(view["byteOffset"] + view["byteLength"] <= len(binary), f"accessor {index} runs past the end")
    return np.frombuffer(binary, dtype, accessor["count"] * width, view["byteOffset"]).reshape(-1, width)


def check_primitive(gltf, binary, primitive, name):
    """Raises Broken; returns the number of triangles."""
    attributes = {
        key: read_accessor(gltf, binary, index).astype(float) for key, index in primitive["attributes"].items()
    }
    position, normal = attributes["POSITION"], attributes["NORMAL"]
    bounds = gltf["accessors"][primitive["attributes"]["POSITION"]]
    for key, values in attributes.items():
        require(len(values) == len(position), f"{name}: {key} has another length than POSITION")
        require(np.isfinite(values).all(), f"{name}: {key} is not finite")
    require(
        (position.min(axis=0) == bounds["min"]).all() and (position.max(axis=0) == bounds["max"]).all(),
        f"{name}: bounds of POSITION",
    )
    require(np.abs(np.linalg.norm(normal, axis=1) - 1).max() < 1e-5, f"{name}: normals are not unit")
    if "TANGENT" in attributes:
        tangent = attributes["TANGENT"]
        require(np.abs(np.linalg.norm(tangent[:, :3], axis=1) - 1).max() < 1e-5, f"{name}: tangents are not unit")
        require(np.abs(np.sum(tangent[:, :3] * normal, axis=1)).max() < 1e-4, f"{name}: tangents lean into normals")
        require((np.abs(tangent[:, 3]) == 1).all(), f"{name}: handedness")
    material = gltf["materials"][primitive["material"]]
    pictures = ("baseColorTexture" in material["pbrMetallicRoughness"]) or "normalTexture" in material
    require(not pictures or "TEXCOORD_0" in attributes, f"{name}: a texture without uvs")
    triangles = read_accessor(gltf, binary, primitive["indices"]).reshape(-1, 3).astype(int)
    require(triangles.max() < len(position), f"{name}: an index past the vertices")
    a, b, c = (position[triangles[:, i]] for i in range(3))
    face = np.cross(b - a, c - a)
    area = np.linalg.norm(face, axis=1) / 2
    require(area.min() > 1e-9, f"{name}: a triangle of {area.min():.1e} m^2")
    face /= 2 * area[:, None]
    agreement = np.sum(face * normal[triangles].mean(axis=1), axis=1)
    require(agreement.min() > 0.1, f"{name}: winding against the normal (cosine {agreement.min():.2f})")
    return len(triangles)


def check(path):
    gltf, binary = load(path)
    unique = {}
    for index, mesh in enumerate(gltf["meshes"]):
        unique[index] = sum(check_primitive(gltf, binary, p, mesh["name"]) for p in mesh["primitives"])
    names = [node["name"] for node in gltf["nodes"]]
    require(len(set(names)) == len(names), "two nodes of one name")
    for node in gltf["nodes"]:
        require(abs(np.linalg.norm(node.get("rotation", [0, 0, 0, 1])) - 1) < 1e-5, f"{node['name']}: rotation")
    for image in gltf.get("images", []):
        view = gltf["bufferViews"][image["bufferView"]]
        require(view["byteOffset"] + view["byteLength"] <= len(binary), f"image {image['name']} runs past the end")
    drawn = sum(unique[node["mesh"]] for node in gltf["nodes"] if "mesh" in node)
    size = (len(binary) + 27) / 1e6
    require(size < 15, f"{size:.1f} MB is more than 15 MB")
    print(f"{path}: {size:.2f} MB, {len(gltf['nodes'])} nodes, {sum(unique.values())} triangles stored, {drawn} drawn")


def main(paths):
    for path in paths:
        try:
            check(path)
        except Broken as broken:
            sys.exit(f"{path}: {broken}")


if __name__ == "__main__":
    main(sys.argv[1:])
