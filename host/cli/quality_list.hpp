#pragma once
// What `quality` measures: scenes and settings, from a JSON file.
//
//   {"scenes":   [{"file": "cornell.glb", "camera": "front", "sun": [135, 50, 50000]}, ...],
//    "settings": [{"series": "disk, radius 0.5", "estimator": "disk", "spp": 8, "radius": 0.5}, ...]}
//
// Files are found from the list's own folder; "camera" and "sun" may be left out. A setting's keys are those of
// earthshine/settings.hpp, and "preset", which the others then change, and "frames" of a still camera, of which the
// last is measured; points of one series are joined in plots.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "earthshine/settings.hpp"
#include "raster/light_fit.hpp"

namespace earthshine::cli {

struct QualityScene {
    std::filesystem::path file;
    std::string camera;  ///< "" = the first
    std::optional<raster::Sun> sun;
    std::string name;  ///< file without folder and ending, and the camera: fit for a file's name
};

struct QualitySetting {
    std::string series;
    Settings settings;
    int frames = 1;     ///< [1; 1000] - of a still camera
    std::string label;  ///< the keys that were given, as "disk, spp 8, radius 0.5"
};

struct QualityList {
    std::vector<QualityScene> scenes;
    std::vector<QualitySetting> settings;
};

/// Throws InputError naming the file and the place in it if the list does not hold what it should.
QualityList readQualityList(const std::filesystem::path& path);

}  // namespace earthshine::cli
