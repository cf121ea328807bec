#pragma once
// Pictures from files, as `compare` and `quality` look at them.

#include <filesystem>
#include <string>
#include <vector>

#include "image/metrics.hpp"

namespace earthshine::cli {

/// One picture of a file as RGBA32F, linear, and what stands for its sky.
struct LoadedPicture {
    std::string name;  ///< file, and the layer if it is not the main one
    PictureKind kind = PictureKind::Scene;
    std::vector<std::string> channels;  ///< as the EXR names them; R, G, B of a PNG
    HostImage pixels;                   ///< a single channel stands in all three
    HostImage skyMask;                  ///< R32F - the file's depth layer (0 = sky); empty if it has none
};

/// Loads a PNG (its sRGB curve undone), or of an EXR the layer's R, G, B (or X, Y, Z, or its only channel). `layer` ""
/// or "color" is the main one. `channels`, if not empty, are one or three full names of channels to take instead.
/// Throws InputError if the file cannot be read or does not have them, naming the layers that it has.
LoadedPicture loadPicture(const std::filesystem::path& path, const std::string& layer,
                          const std::vector<std::string>& channels = {});

}  // namespace earthshine::cli
