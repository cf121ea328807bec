#pragma once
// What the parts of the glTF loader share while they make one Scene.

#include <string>

#include <tiny_gltf.h>

#include "raster/scene/gltf_file.hpp"
#include "raster/scene/scene.hpp"

namespace earthshine::raster {

/// `model` has passed checkSchema() and checkReferences(), its buffers are loaded, its images are not.
struct GltfContext {
    GltfFile& file;
    const tinygltf::Model& model;
    Scene& scene;
    bool drawsMarkers = false;  ///< LoadOptions

    /// Adds a line to Scene::notes, once.
    void note(const std::string& line) const;
};

}  // namespace earthshine::raster
