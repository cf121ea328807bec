"""Compares `earthshine reference` with Mitsuba 3, a renderer that shares no code with it. Not a part of ./check.

    pip install mitsuba numpy
    python3 tests/trace/compare_mitsuba.py build/release/bin/earthshine data/cornell.glb --size 256x256 --spp 1024
    python3 tests/trace/compare_mitsuba.py build/release/bin/earthshine data/atrium.glb --camera court

Reads the same .glb, independently (no code of this project): meshes flattened into the world, base colours and their
textures, the camera and the light. Two things are left out on both sides, by way of a copy of the file: normal maps,
since the two treat a shading normal that disagrees with its triangle differently by design, and alpha masks, which the
shadow rays of Mitsuba's path integrator do not see through.

Mitsuba's pixels are means over the pixel and ours are its centre, so the program makes a picture of four times the
width and height, with as many samples in all, of which 4 x 4 pixels are averaged. The difference picture is of blocks
of 8 x 8 pixels. One bounce is what Mitsuba's path integrator sees at depth 3 less what
it sees at depth 2; direct light is depth 2.
"""

import argparse
import json
import pathlib
import struct
import subprocess
import tempfile

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

COMPONENTS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
FINER = 4  # pixels of ours along a side of one of Mitsuba's
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Glb:
    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        size = struct.unpack("<I", data[12:16])[0]
        self.json = json.loads(data[20:20 + size])
        self.binary = data[20 + size + 8:]

    def view(self, index):
        view = self.json["bufferViews"][index]
        start = view.get("byteOffset", 0)
        return self.binary[start:start + view["byteLength"]], view.get("byteStride")

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        data, stride = self.view(accessor["bufferView"])
        kind, width = COMPONENTS[accessor["componentType"]], WIDTHS[accessor["type"]]
        item = np.dtype(kind).itemsize * width
        stride = stride or item
        start = accessor.get("byteOffset", 0)
        rows = [np.frombuffer(data, kind, width, start + i * stride) for i in range(accessor["count"])] \
            if stride != item else np.frombuffer(data, kind, width * accessor["count"], start).reshape(-1, width)
        values = np.asarray(rows)
        if accessor.get("normalized"):
            values = np.maximum(values / float(np.iinfo(kind).max), -1.0)
        return values

    def placements(self):
        """(node, its 4 x 4 matrix into the world) for every node of the default scene."""
        def matrix_of(node):
            if "matrix" in node:
                return np.array(node["matrix"]).reshape(4, 4).T
            x, y, z, w = node.get("rotation", (0, 0, 0, 1))
            rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
            result = np.eye(4)
            result[:3, :3] = rotation * np.array(node.get("scale", (1, 1, 1)))
            result[:3, 3] = node.get("translation", (0, 0, 0))
            return result

        def walk(index, parent):
            node = self.json["nodes"][index]
            matrix = parent @ matrix_of(node)
            yield node, matrix
            for child in node.get("children", ()):
                yield from walk(child, matrix)

        for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            yield from walk(root, np.eye(4))


def simplified(path, out):
    """A copy of a .glb whose materials have no normal texture and no alpha mask."""
    data = bytearray(pathlib.Path(path).read_bytes())
    size = struct.unpack("<I", data[12:16])[0]
    content = json.loads(data[20:20 + size])
    for material in content.get("materials", ()):
        for key in ("normalTexture", "alphaMode", "alphaCutoff"):
            material.pop(key, None)
    text = json.dumps(content, separators=(",", ":")).encode()
    text += b" " * (size - len(text))
    assert len(text) == size, "the text only gets shorter"
    data[20:20 + size] = text
    pathlib.Path(out).write_bytes(data)


def bitmap(glb, texture):
    """A texture of the file as Mitsuba's own decoder reads it."""
    image = glb.json["images"][glb.json["textures"][texture]["source"]]
    data, _ = glb.view(image["bufferView"])
    with tempfile.NamedTemporaryFile(suffix=".png" if "png" in image["mimeType"] else ".jpg") as file:
        file.write(data)
        file.flush()
        return mi.Bitmap(file.name)


def material_of(glb, index, cache):
    if index in cache:
        return cache[index]
    material = glb.json["materials"][index] if index is not None else {}
    pbr = material.get("pbrMetallicRoughness", {})
    factor = np.array(pbr.get("baseColorFactor", (1, 1, 1, 1)), float)
    assert "metallicRoughnessTexture" not in pbr, "metallic textures are not translated"
    factor[:3] *= 1.0 - pbr.get("metallicFactor", 1.0)
    transform = np.eye(3)
    if "baseColorTexture" in pbr:
        info = pbr["baseColorTexture"]
        extension = info.get("extensions", {}).get("KHR_texture_transform", {})
        angle = extension.get("rotation", 0.0)
        turn = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        transform = np.array([[1, 0, extension.get("offset", (0, 0))[0]], [0, 1, extension.get("offset", (0, 0))[1]],
                              [0, 0, 1]]) @ turn @ np.diag([*extension.get("scale", (1, 1)), 1])
        image = bitmap(glb, info["index"])
        pixels = np.array(image.convert(mi.Bitmap.PixelFormat.RGBA, mi.Struct.Type.Float32, srgb_gamma=False))
        color = pixels[..., :3] * factor[:3]
        reflectance = {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(color, np.float32)), "raw": True}
    else:
        reflectance = {"type": "rgb", "value": factor[:3].tolist()}
    bsdf = {"type": "twosided", "nested": {"type": "diffuse", "reflectance": reflectance}}
    cache[index] = mi.load_dict(bsdf), transform
    return cache[index]


def shape_of(glb, primitive, matrix, cache, name):
    attributes = primitive["attributes"]
    positions = glb.accessor(attributes["POSITION"]) @ matrix[:3, :3].T + matrix[:3, 3]
    indices = glb.accessor(primitive["indices"]).reshape(-1, 3)
    bsdf, transform = material_of(glb, primitive.get("material"), cache)
    normals = glb.accessor(attributes["NORMAL"]) @ np.linalg.inv(matrix[:3, :3]) if "NORMAL" in attributes else None
    uvs = glb.accessor(attributes["TEXCOORD_0"]) if "TEXCOORD_0" in attributes else None
    properties = mi.Properties()
    properties["bsdf"] = bsdf
    mesh = mi.Mesh(name, len(positions), len(indices), has_vertex_normals=normals is not None,
                   has_vertex_texcoords=uvs is not None, props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = positions.astype(np.float32).ravel()
    if normals is not None:
        normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        parameters["vertex_normals"] = normals.astype(np.float32).ravel()
    if uvs is not None:
        uvs = (np.c_[uvs, np.ones(len(uvs))] @ transform.T)[:, :2]
        parameters["vertex_texcoords"] = uvs.astype(np.float32).ravel()
    if np.linalg.det(matrix[:3, :3]) < 0:
        indices = indices[:, ::-1]
    parameters["faces"] = indices.astype(np.uint32).ravel()
    parameters.update()
    return mesh


def spot_map(light):
    """A projector's picture that makes it a glTF spot; Mitsuba's own spot falls off otherwise.

    Measured: a projector whose picture is 1 has the intensity pi / cos^3 (Mitsuba 3.9)."""
    outer, inner = light["spot"].get("outerConeAngle", np.pi / 4), light["spot"].get("innerConeAngle", 0.0)
    size = 2048
    axis = (np.arange(size) + 0.5) / size * 2 - 1
    x, y = np.meshgrid(axis, axis)
    cosine = 1.0 / np.sqrt(1.0 + (x * x + y * y) * np.tan(outer) ** 2)
    t = np.clip((cosine - np.cos(outer)) / max(np.cos(inner) - np.cos(outer), 1e-3), 0, 1)
    intensity = (t * t)[..., None] * np.array(light.get("color", (1, 1, 1))) * light.get("intensity", 1.0)
    return (intensity * cosine[..., None] ** 3 / np.pi).astype(np.float32), np.degrees(2 * outer)


def load(path, camera, size, spp):
    glb = Glb(path)
    scene, cache, sensors, count = {"type": "scene"}, {}, {}, 0
    lights = glb.json.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
    for node, matrix in glb.placements():
        if "mesh" in node:
            for primitive in glb.json["meshes"][node["mesh"]]["primitives"]:
                scene[f"shape{count}"] = shape_of(glb, primitive, matrix, cache, f"shape{count}")
                count += 1
        if "camera" in node:
            definition = glb.json["cameras"][node["camera"]]
            sensors[definition.get("name", "")] = (definition["perspective"], matrix)
        light = node.get("extensions", {}).get("KHR_lights_punctual", {}).get("light")
        if light is not None:
            scene[f"light{light}"] = emitter(lights[light], matrix)
    perspective, matrix = sensors[camera] if camera else next(iter(sensors.values()))
    target = matrix @ np.array([0, 0, -1, 1])
    scene["sensor"] = {
        "type": "perspective", "fov": float(np.degrees(perspective["yfov"])), "fov_axis": "y",
        "near_clip": perspective["znear"], "far_clip": perspective.get("zfar", 1e4),
        "to_world": mi.ScalarTransform4f().look_at(origin=matrix[:3, 3].tolist(), target=target[:3].tolist(),
                                                   up=matrix[:3, 1].tolist()),
        "film": {"type": "hdrfilm", "width": size[0], "height": size[1], "rfilter": {"type": "box"},
                 "pixel_format": "rgb", "component_format": "float32"},
        "sampler": {"type": "independent", "sample_count": spp}}
    return mi.load_dict(scene)


def emitter(light, matrix):
    color = np.array(light.get("color", (1, 1, 1))) * light.get("intensity", 1.0)
    position, direction = matrix[:3, 3], -matrix[:3, 2]
    if light["type"] == "directional":
        return {"type": "directional", "direction": direction.tolist(),
                "irradiance": {"type": "rgb", "value": color.tolist()}}
    assert light["type"] == "spot", "point lights are not translated"
    pixels, fov = spot_map(light)
    return {"type": "projector", "fov": float(fov), "scale": 1.0,
            "irradiance": {"type": "bitmap", "bitmap": mi.Bitmap(pixels), "raw": True},
            "to_world": mi.ScalarTransform4f().look_at(origin=position.tolist(),
                                                       target=(position + direction).tolist(),
                                                       up=matrix[:3, 1].tolist())}


def blocks(image, side=8):
    height, width = image.shape[0] // side * side, image.shape[1] // side * side
    return image[:height, :width].reshape(height // side, side, width // side, side, 3).mean((1, 3))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("--camera", default="")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--picture", default="difference.png", help="ours | Mitsuba's | relative difference, one bounce")
    arguments = parser.parse_args()
    size = [int(n) for n in arguments.size.split("x")]

    with tempfile.TemporaryDirectory() as folder:
        scene_file, ours_file = f"{folder}/scene.glb", f"{folder}/ours.exr"
        simplified(arguments.scene, scene_file)
        command = [arguments.program, "reference", scene_file, "-o", ours_file, "--size",
                   "x".join(str(FINER * n) for n in size), "--spp", str(max(arguments.spp // FINER ** 2, 1)), "--quiet"]
        subprocess.run(command + (["--camera", arguments.camera] if arguments.camera else []), check=True)
        layers = mi.Bitmap(ours_file).split()
        ours = {name: blocks(np.array(layer, np.float64)[..., :3], FINER) for name, layer in layers
                if name in ("direct", "indirect")}
        scene = load(scene_file, arguments.camera, size, arguments.spp)

    def render(depth, seed):
        integrator = mi.load_dict({"type": "path", "max_depth": depth, "rr_depth": 1000, "hide_emitters": True})
        return np.array(mi.render(scene, integrator=integrator, spp=arguments.spp, seed=seed), np.float64)

    direct, both = render(2, 1), render(3, 2)
    bounce = both - direct
    for name, theirs in (("direct", direct), ("indirect", bounce)):
        mine = ours[name]
        difference = mine.mean((0, 1)) / np.maximum(theirs.mean((0, 1)), 1e-12) - 1
        print(f"{name:9} mean {mine.mean():.6g} and {theirs.mean():.6g}: {100 * (mine.mean() / theirs.mean() - 1):+.3f} %"
              f" (R {100 * difference[0]:+.3f} %, G {100 * difference[1]:+.3f} %, B {100 * difference[2]:+.3f} %)")
    mine, theirs = blocks(ours["indirect"]), blocks(bounce)
    relative = (mine - theirs).mean(-1) / (np.abs(theirs).mean(-1) + 0.1 * theirs.mean())
    print(f"blocks    relative difference: mean {100 * relative.mean():+.3f} %, deviation {100 * relative.std():.2f} %")
    exposure = 0.5 / np.percentile(theirs, 90)
    signed = np.clip(relative / 0.2, -1, 1)[..., None]
    heat = np.where(signed > 0, 1 - signed * (0, 1, 1), 1 + signed * (1, 1, 0))
    picture = np.concatenate([np.clip(mine * exposure, 0, 1) ** (1 / 2.2), np.clip(theirs * exposure, 0, 1) ** (1 / 2.2),
                              heat], 1).repeat(4, 0).repeat(4, 1)
    mi.Bitmap((picture * 255).astype(np.uint8)).write(arguments.picture)
    print("wrote", arguments.picture)


if __name__ == "__main__":
    main()
