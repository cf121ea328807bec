#pragma once
// Pictures of a glTF file as texels.

#include "raster/scene/gltf_context.hpp"

namespace earthshine::raster {

/// Decodes images[image], a PNG or a JPEG, to RGBA; the 16 bits of a 16-bit PNG are kept. Sets the name, the size and
/// the texels only. Throws InputError with the image's name if it is missing, of another format, broken or too large.
Texture decodeImage(const GltfContext& context, int image);

}  // namespace earthshine::raster
