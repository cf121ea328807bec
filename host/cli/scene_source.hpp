#pragma once
// Scenes from files, for every command that looks at one.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "earthshine/frame.hpp"
#include "raster/scene/scene.hpp"

namespace earthshine::cli {

/// Loads a .gltf or .glb file, and logs what is in it and what of it is not drawn as it asks. Throws as loadGltf.
raster::Scene loadScene(const std::string& file);

/// A scene, and the lights that are drawn, as reports show them.
nlohmann::ordered_json sceneJson(const std::string& file, const raster::Scene& scene, const std::vector<Light>& lights);

}  // namespace earthshine::cli
