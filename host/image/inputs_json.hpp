#pragma once
// The inputs.json of a folder of inputs (inputs_folder.hpp): everything but the pixels.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "earthshine/frame.hpp"

namespace earthshine {

/// The files of images by their key, relative to the folder.
using ImageFiles = std::map<std::string, std::string>;

struct InputsDescription {
    Camera camera;
    ImageFiles images;
    std::vector<Light> lights;
    std::vector<ImageFiles> lightMaps;  ///< parallel to lights
};

/// The text of an inputs.json.
std::string writeDescription(const InputsDescription& description);

/// Reads and checks `file`. Throws InputError naming the file and the key.
InputsDescription readDescription(const std::filesystem::path& file);

}  // namespace earthshine
