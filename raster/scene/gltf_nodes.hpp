#pragma once
// The node trees of a glTF file: instances, cameras and lights, placed in the world.

#include "raster/scene/gltf_mesh.hpp"

namespace earthshine::raster {

/// Places everything that the file's default scene holds (without one: scene 0; without scenes: every root) and fills
/// in Scene's name, instances, cameras and lights. Throws InputError.
void placeNodes(const GltfContext& context, GltfMeshes& meshes);

}  // namespace earthshine::raster
