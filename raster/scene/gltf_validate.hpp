#pragma once
// What must hold between the parts of a glTF document before anybody follows an offset in it.

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "raster/scene/gltf_file.hpp"

namespace earthshine::raster {

/// Whether the loader does something about an extension.
bool isKnownExtension(std::string_view name);

/// Checks the version and that this loader knows every extension that the document requires. Throws InputError.
void checkExtensions(const nlohmann::json& document, const GltfFile& file);

/// Checks a document that checkSchema() passed: every buffer view lies in its buffer, every accessor (sparse or not) in
/// its view, every image in its view; attributes and indices have types that glTF 2.0 with KHR_mesh_quantization allows
/// and agree in length; the nodes are trees; images, cameras and scenes are complete; no URI leaves the scene's folder.
/// `bufferBytes` is the size of each buffer as it was read. Throws InputError with the place.
///
/// What is in the buffers (indices, positions) is not looked at here: the readers of accessors check it as they go.
void checkReferences(const nlohmann::json& document, const std::vector<std::size_t>& bufferBytes, const GltfFile& file);

}  // namespace earthshine::raster
