#include "raster/scene/gltf_loader.hpp"

#include <cmath>
#include <new>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "earthshine/error.hpp"
#include "raster/scene/gltf_animation.hpp"
#include "raster/scene/gltf_nodes.hpp"
#include "raster/scene/gltf_schema.hpp"
#include "raster/scene/gltf_validate.hpp"

namespace earthshine::raster {

namespace {

using nlohmann::json;

json parseJson(const GltfFile& file) {
    const auto limitDepth = [&](int depth, json::parse_event_t, json&) {
        if (depth > gltf_limits::kJsonDepth)
            file.fail("", fmt::format("is nested deeper than {}", gltf_limits::kJsonDepth));
        return true;
    };
    try {
        return json::parse(file.json(), limitDepth);
    } catch (const json::exception& error) {
        file.fail("", fmt::format("is not JSON: {}", printable(error.what(), 200)));
    }
}

/// The bytes of each buffer, cut to the length that the document says.
std::vector<Bytes> readBuffers(const json& document, GltfFile& file) {
    std::vector<Bytes> buffers;
    if (!document.contains("buffers")) return buffers;
    for (const json& buffer : document["buffers"]) {
        const std::string place = fmt::format("buffers[{}]", buffers.size());
        const bool isChunk = !buffer.contains("uri");
        if (isChunk && (!buffers.empty() || file.binaryChunk().empty())) {
            file.fail(place, "has no uri, and is not the first of a .glb with a binary chunk");
        }
        Bytes bytes = isChunk ? file.binaryChunk() : file.read(buffer["uri"].get<std::string>(), place);
        const auto length = buffer["byteLength"].get<std::uint64_t>();
        if (bytes.size() < length)
            file.fail(place, fmt::format("needs {} B, its data holds {} B", length, bytes.size()));
        bytes.resize(length);
        buffers.push_back(std::move(bytes));
    }
    return buffers;
}

/// Leaves to tinygltf what we use of the document but bytes and pictures, which it would read from anywhere and
/// unchecked. Its doors to the disk are shut as well.
tinygltf::Model parseModel(json document, const GltfFile& file) {
    for (const char* name : {"buffers", "images", "animations", "skins", "extras"}) document.erase(name);
    const std::string text = document.dump();
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({[](const std::string&, void*) { return false; },
                           [](const std::string& path, void*) { return path; },
                           [](Bytes*, std::string*, const std::string&, void*) { return false; },
                           [](std::string*, const std::string&, const Bytes&, void*) { return false; }, nullptr});
    tinygltf::Model model;
    std::string error;
    std::string warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "")) {
        file.fail("", fmt::format("tinygltf cannot read it: {}", printable(error, 200)));
    }
    return model;
}

/// The images as the document names them, not yet read.
std::vector<tinygltf::Image> imagesOf(const json& document) {
    std::vector<tinygltf::Image> images;
    if (!document.contains("images")) return images;
    for (const json& image : document["images"]) {
        tinygltf::Image& to = images.emplace_back();
        to.name = image.value("name", "");
        to.uri = image.value("uri", "");
        to.bufferView = image.value("bufferView", -1);
    }
    return images;
}

void noteIgnoredExtensions(const GltfContext& context) {
    for (const std::string& name : context.model.extensionsUsed) {
        if (!isKnownExtension(name)) context.note(printable(name) + ": is not supported, and left out");
    }
}

Scene load(GltfFile& file, const LoadOptions& options) {
    json document = parseJson(file);
    if (!document.is_object()) file.fail("", "is no JSON object");
    checkExtensions(document, file);
    checkSchema(document, file);
    std::vector<Bytes> buffers = readBuffers(document, file);
    std::vector<std::size_t> bufferBytes;
    bufferBytes.reserve(buffers.size());
    for (const Bytes& bytes : buffers) bufferBytes.push_back(bytes.size());
    checkReferences(document, bufferBytes, file);

    std::vector<tinygltf::Image> images = imagesOf(document);
    const json animations = document.value("animations", json::array());
    tinygltf::Model model = parseModel(std::move(document), file);
    model.images = std::move(images);
    for (Bytes& bytes : buffers) model.buffers.emplace_back().data = std::move(bytes);

    Scene scene;
    std::size_t elementsRead = 0;
    const GltfContext context{file, model, scene, elementsRead, options.drawsMarkers};
    noteIgnoredExtensions(context);
    GltfMaterials materials(context);
    GltfMeshes meshes(context, materials);
    const std::vector<int> sceneNodes = placeNodes(context, meshes);
    readAnimations(context, animations, sceneNodes);
    if (scene.materials.empty()) materials.materialOf(-1);
    computeBounds(scene);
    const glm::vec3 extent = scene.boundsMax - scene.boundsMin;
    if (!std::isfinite(extent.x + extent.y + extent.z)) file.fail("", "its extent is beyond what 32-bit floats hold");
    return scene;
}

}  // namespace

Scene loadGltf(const std::filesystem::path& path, const LoadOptions& options) {
    GltfFile file(path);
    try {
        return load(file, options);
    } catch (const std::bad_alloc&) {
        file.fail("", "needs more memory than there is");
    } catch (const std::length_error&) {
        file.fail("", "needs more memory than there is");
    }
}

}  // namespace earthshine::raster
