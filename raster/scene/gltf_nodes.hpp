#pragma once
// The node trees of a glTF file: instances, cameras and lights, placed in the world.

#include <vector>

#include "raster/scene/gltf_mesh.hpp"

namespace earthshine::raster {

/// Places everything that the file's default scene holds (without one: scene 0; without scenes: every root) and fills
/// in Scene's name, nodes, instances, cameras and lights. Returns where in Scene::nodes each node of the file is, -1
/// for those outside the scene. Throws InputError.
std::vector<int> placeNodes(const GltfContext& context, GltfMeshes& meshes);

}  // namespace earthshine::raster
