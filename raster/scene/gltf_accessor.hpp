#pragma once
// Accessors as plain arrays: any component type, normalised, interleaved or sparse.

#include <cstdint>
#include <string>
#include <vector>

#include "raster/scene/gltf_context.hpp"

namespace earthshine::raster {

/// The elements of an accessor as floats, `components` for each; what the accessor's type has more is left out, what it
/// has less is `fill`. Normalised integers become [0; 1] or [-1; 1] (glTF 2.0, 3.6.2.2), others keep their value.
/// Throws InputError if a number is not finite or a sparse index is out of order or range.
std::vector<float> readFloats(const GltfContext& context, int accessor, int components, float fill,
                              const std::string& place);

/// The elements of a scalar unsigned accessor. Throws InputError if one is not below `vertexCount`.
std::vector<std::uint32_t> readIndices(const GltfContext& context, int accessor, std::size_t vertexCount,
                                       const std::string& place);

}  // namespace earthshine::raster
