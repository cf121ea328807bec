#pragma once
// The door to glTF 2.0: one function from a file to a Scene.

#include <filesystem>

#include "raster/scene/scene.hpp"

namespace earthshine::raster {

struct LoadOptions {
    bool drawsMarkers = false;  ///< also nodes that are named like an engine's markers (editor_markers.hpp)
};

/// Loads the default scene of a .gltf or .glb file: its meshes as triangles with normals and tangents, its instances,
/// materials, textures, lights and cameras, placed in the world, and the animations of its nodes (animator.hpp plays
/// them). Meshes, materials and images that nothing in the scene uses are checked but not loaded.
///
/// Read: glTF 2.0, KHR_lights_punctual, KHR_texture_transform, KHR_materials_emissive_strength, KHR_mesh_quantization;
/// KHR_materials_unlit and KHR_materials_pbrSpecularGlossiness are drawn as diffuse surfaces. Morph targets stand at
/// their default weights, skins in their bind pose; nodes that engines use as markers are left out unless asked for.
/// What is left out is a line each in Scene::notes; an extension that the file requires and that is not in this list is
/// an error.
///
/// Every number is checked before it is used, so the file may come from anywhere. Only files in the folder of `path`
/// (after links are resolved) and data URIs are read.
///
/// @throws InputError with one line: the file, the place in it, what is wrong.
Scene loadGltf(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace earthshine::raster
