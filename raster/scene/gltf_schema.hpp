#pragma once
// The shape of a glTF document: which properties there are, of which type, in which range.

#include <nlohmann/json_fwd.hpp>

#include "raster/scene/gltf_file.hpp"

namespace earthshine::raster {

/// Checks that every property which the loader reads has the type, range and length that glTF 2.0 says, and
/// that every index points into its array. tinygltf itself drops what has a wrong type and goes on, so that a negative
/// offset becomes an offset of 0. Throws InputError with the place: "accessors[4].byteOffset: ...".
void checkSchema(const nlohmann::json& document, const GltfFile& file);

}  // namespace earthshine::raster
