#pragma once
// Animations of nodes, from the document and its accessors.

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "raster/scene/gltf_context.hpp"

namespace earthshine::raster {

/// Fills in Scene::animations with what moves nodes of the scene: translation, rotation and scale. `animations` are the
/// document's, which has passed the checks; `sceneNodes` is what placeNodes() returned. Morph weights and what
/// extensions animate are left out with a note. Throws InputError.
void readAnimations(const GltfContext& context, const nlohmann::json& animations, const std::vector<int>& sceneNodes);

}  // namespace earthshine::raster
