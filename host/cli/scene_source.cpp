#include "cli/scene_source.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "earthshine/log.hpp"
#include "raster/scene/gltf_loader.hpp"

namespace earthshine::cli {

nlohmann::ordered_json sceneJson(const std::string& file, const raster::Scene& scene,
                                 const std::vector<Light>& lights) {
    nlohmann::ordered_json drawn = nlohmann::ordered_json::array();
    for (const Light& light : lights)
        drawn.push_back({{"name", light.name},
                         {"type", light.type == LightType::Spot ? "spot" : "directional"},
                         {"intensity", {light.intensity.r, light.intensity.g, light.intensity.b}}});
    return {{"file", file},
            {"triangles", scene.triangleCount()},
            {"meshes", scene.meshes.size()},
            {"instances", scene.instances.size()},
            {"materials", scene.materials.size()},
            {"textures", scene.textures.size()},
            {"cameras", scene.cameras.size()},
            {"lights", drawn},
            {"notes", scene.notes}};
}

raster::Scene loadScene(const std::string& file) {
    raster::Scene scene = raster::loadGltf(file);
    log(LogLevel::Info,
        fmt::format("{}: {} triangles, {} materials, {} textures, {} lights", file, scene.triangleCount(),
                    scene.materials.size(), scene.textures.size(), scene.lights.size()));
    for (const std::string& note : scene.notes) log(LogLevel::Info, fmt::format("{}: {}", file, note));
    if (!scene.notes.empty())
        log(LogLevel::Warning,
            fmt::format("{}: {} things in it are not drawn as it asks; --verbose and --report list them", file,
                        scene.notes.size()));
    return scene;
}

}  // namespace earthshine::cli
