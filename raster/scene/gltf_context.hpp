#pragma once
// What the parts of the glTF loader share while they make one Scene.

#include <algorithm>
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
    std::size_t& elementsRead;  ///< by all accessors so far; see gltf_limits::kElements
    bool drawsMarkers = false;  ///< LoadOptions

    /// Adds a line to Scene::notes, once; the first hundred are kept.
    void note(const std::string& line) const {
        constexpr std::size_t kMost = 100;
        std::vector<std::string>& notes = scene.notes;
        if (notes.size() <= kMost && std::find(notes.begin(), notes.end(), line) == notes.end()) {
            notes.push_back(notes.size() < kMost ? line : "further notes are left out");
        }
    }
};

}  // namespace earthshine::raster
