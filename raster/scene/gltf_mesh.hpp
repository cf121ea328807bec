#pragma once
// Meshes: triangles with normals, tangents and coordinates, whatever the file stores.

#include <map>
#include <utility>
#include <vector>

#include "raster/scene/gltf_material.hpp"

namespace earthshine::raster {

/// Makes the meshes of a scene as nodes ask for them.
class GltfMeshes {
public:
    GltfMeshes(const GltfContext& context, GltfMaterials& materials) : context_(context), materials_(materials) {}

    /// The indices in Scene::meshes of the primitives of meshes[mesh], morphed by `weights` (empty: the mesh's own).
    /// Throws InputError if an index or a number is out of range.
    const std::vector<int>& meshesOf(int mesh, const std::vector<double>& weights);

private:
    bool convert(const tinygltf::Primitive& from, const std::vector<double>& weights, Mesh& to,
                 const std::string& place);
    std::vector<std::uint32_t> readTriangles(const tinygltf::Primitive& from, std::size_t vertexCount,
                                             const std::string& place) const;
    /// Keeps the scene within gltf_limits.
    void count(std::size_t vertices, std::size_t indices, const std::string& place);

    const GltfContext& context_;
    GltfMaterials& materials_;
    std::map<std::pair<int, std::vector<double>>, std::vector<int>> meshes_;
    std::size_t vertexCount_ = 0;
    std::size_t indexCount_ = 0;
};

}  // namespace earthshine::raster
