#include "raster/scene/gltf_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "raster/scene/gltf_accessor.hpp"
#include "raster/scene/tangents.hpp"

namespace earthshine::raster {

namespace {

using Indices = std::vector<std::uint32_t>;

/// Reads the attributes of one primitive, with its morph targets added.
class Attributes {
public:
    Attributes(const GltfContext& context, const tinygltf::Primitive& primitive, const std::vector<double>& weights,
               const std::string& place)
        : context_(context), primitive_(primitive), weights_(weights), place_(place) {}

    bool has(const char* name) const { return primitive_.attributes.contains(name); }

    /// `components` floats a vertex; `fill` for those that the file leaves out.
    std::vector<float> read(const char* name, int components, float fill) const {
        std::vector<float> values =
            readFloats(context_, primitive_.attributes.at(name), components, fill, fmt::format("{}.{}", place_, name));
        for (std::size_t t = 0; t < std::min(weights_.size(), primitive_.targets.size()); ++t) {
            const auto found = primitive_.targets[t].find(name);
            const auto weight = float(weights_[t]);
            if (found == primitive_.targets[t].end() || weight == 0.0f) continue;
            const std::vector<float> change = readFloats(context_, found->second, components, 0.0f,
                                                         fmt::format("{}.targets[{}].{}", place_, t, name));
            for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * change[i];
        }
        return values;
    }

private:
    const GltfContext& context_;
    const tinygltf::Primitive& primitive_;
    const std::vector<double>& weights_;
    const std::string& place_;
};

/// Three indices a triangle, from a list, a strip or a fan (glTF 2.0, 3.7.2.1); those that name a vertex twice, as
/// stitched strips do, have no area and are left out.
Indices triangleList(const Indices& from, int mode) {
    Indices to;
    to.reserve(mode == TINYGLTF_MODE_TRIANGLES ? from.size() : from.size() * 3);
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a != b && b != c && a != c) to.insert(to.end(), {a, b, c});
    };
    const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
    for (std::size_t i = 0; i + 3 <= from.size(); i += step) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            add(from[i + 1], from[i + 2], from[0]);
        } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1) {
            add(from[i], from[i + 2], from[i + 1]);
        } else {
            add(from[i], from[i + 1], from[i + 2]);
        }
    }
    return to;
}

glm::vec3 faceNormalTimesArea(const std::vector<Vertex>& vertices, const std::uint32_t* corner) {
    const glm::vec3& origin = vertices[corner[0]].position;
    return glm::cross(vertices[corner[1]].position - origin, vertices[corner[2]].position - origin);
}

/// `v` as a unit vector; `otherwise` if it has no direction.
glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& otherwise) {
    const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0f) || !std::isfinite(largest)) return otherwise;
    return glm::normalize(v / largest);  // scaled first: tiny and huge vectors survive the squares
}

/// glTF 2.0, 3.7.2.1: without normals in the file every triangle is flat, so corners share no vertex.
void makeFlat(std::vector<Vertex>& vertices, Indices& indices) {
    std::vector<Vertex> corners(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        corners[i] = vertices[indices[i]];
        corners[i].normal = unitOr(faceNormalTimesArea(vertices, &indices[i / 3 * 3]), glm::vec3(0.0f, 0.0f, 1.0f));
    }
    vertices = std::move(corners);
    std::iota(indices.begin(), indices.end(), 0u);
}

/// Sets the normals to unit length. Those without a direction become the mean of the faces around, weighted by area.
/// Returns how many had none.
std::size_t normalizeNormals(std::vector<Vertex>& vertices, const Indices& indices) {
    std::vector<bool> missing(vertices.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        vertices[i].normal = unitOr(vertices[i].normal, glm::vec3(0.0f));
        missing[i] = vertices[i].normal == glm::vec3(0.0f);
        count += missing[i];
    }
    if (count == 0) return 0;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (missing[indices[i]]) vertices[indices[i]].normal += faceNormalTimesArea(vertices, &indices[i / 3 * 3]);
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (missing[i]) vertices[i].normal = unitOr(vertices[i].normal, glm::vec3(0.0f, 0.0f, 1.0f));
    }
    return count;
}

/// Copies `components` floats a vertex into the member of Vertex at `offset` bytes.
void fill(std::vector<Vertex>& vertices, const std::vector<float>& values, std::size_t components, std::size_t offset) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        std::memcpy(reinterpret_cast<char*>(&vertices[i]) + offset, &values[i * components],
                    components * sizeof(float));
    }
}

/// The file's tangents: unit, perpendicular to the normal, w = +1 or -1.
void tidyTangents(std::vector<Vertex>& vertices) {
    for (Vertex& vertex : vertices) {
        const glm::vec3 given(vertex.tangent);
        const glm::vec3 inPlane = given - vertex.normal * glm::dot(vertex.normal, given);
        vertex.tangent =
            glm::vec4(unitOr(inPlane, perpendicularTo(vertex.normal)), vertex.tangent.w < 0.0f ? -1.0f : 1.0f);
    }
}

}  // namespace

const std::vector<int>& GltfMeshes::meshesOf(int mesh, const std::vector<double>& weights) {
    const tinygltf::Mesh& from = context_.model.meshes[std::size_t(mesh)];
    const std::vector<double>& effective = weights.empty() ? from.weights : weights;
    const auto [entry, isNew] = meshes_.try_emplace({mesh, effective});
    if (!isNew) return entry->second;
    for (std::size_t i = 0; i < from.primitives.size(); ++i) {
        Mesh to;
        to.name = from.name.empty() ? fmt::format("mesh {}", mesh) : from.name;
        if (from.primitives.size() > 1) to.name += fmt::format("/{}", i);
        if (!convert(from.primitives[i], effective, to, fmt::format("meshes[{}].primitives[{}]", mesh, i))) continue;
        entry->second.push_back(int(context_.scene.meshes.size()));
        context_.scene.meshes.push_back(std::move(to));
    }
    return entry->second;
}

bool GltfMeshes::convert(const tinygltf::Primitive& from, const std::vector<double>& weights, Mesh& to,
                         const std::string& place) {
    const GltfFile& file = context_.file;
    if (from.mode < TINYGLTF_MODE_TRIANGLES) {
        context_.note(place + ": points and lines are not drawn");
        return false;
    }
    const Attributes attributes(context_, from, weights, place);
    if (!attributes.has("POSITION")) {
        context_.note(place + ": has no POSITION, and is not drawn");
        return false;
    }
    const std::vector<float> positions = attributes.read("POSITION", 3, 0.0f);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!std::isfinite(positions[i]))
            file.fail(fmt::format("{}.POSITION[{}]", place, i / 3), "is not finite once morphed");
    }
    to.vertices.resize(positions.size() / 3);
    fill(to.vertices, positions, 3, offsetof(Vertex, position));

    Indices given;
    if (from.indices >= 0) {
        given = readIndices(context_, from.indices, to.vertices.size(), place + ".indices");
    } else {
        given.resize(to.vertices.size());
        std::iota(given.begin(), given.end(), 0u);
    }
    if (given.size() < 3) {
        context_.note(place + ": has no triangle");
        return false;
    }
    if (from.mode == TINYGLTF_MODE_TRIANGLES && given.size() % 3 != 0) {
        context_.note(
            fmt::format("{}: {} indices are no whole number of triangles; the last are left out", place, given.size()));
    }
    to.indices = triangleList(given, from.mode);
    // Flat and mirrored vertices are split later: a vertex for each corner is the most there can be.
    vertexCount_ += std::max(to.vertices.size(), to.indices.size());
    indexCount_ += to.indices.size();
    if (vertexCount_ > 3 * gltf_limits::kVertices || indexCount_ > gltf_limits::kIndices) {
        file.fail(place, fmt::format("the scene has more than {} triangles", gltf_limits::kIndices / 3));
    }
    to.material = materials_.materialOf(from.material);
    const Material& material = context_.scene.materials[std::size_t(to.material)];

    if (attributes.has("TEXCOORD_0"))
        fill(to.vertices, attributes.read("TEXCOORD_0", 2, 0.0f), 2, offsetof(Vertex, uv0));
    if (attributes.has("TEXCOORD_1"))
        fill(to.vertices, attributes.read("TEXCOORD_1", 2, 0.0f), 2, offsetof(Vertex, uv1));
    if (attributes.has("COLOR_0")) fill(to.vertices, attributes.read("COLOR_0", 4, 1.0f), 4, offsetof(Vertex, color));
    const bool hasNormals = attributes.has("NORMAL");
    if (hasNormals) {
        fill(to.vertices, attributes.read("NORMAL", 3, 0.0f), 3, offsetof(Vertex, normal));
        if (const std::size_t missing = normalizeNormals(to.vertices, to.indices); missing > 0) {
            context_.note(fmt::format("{}: {} normals have no direction; those of the faces stand in", place, missing));
        }
    } else {
        makeFlat(to.vertices, to.indices);
    }
    if (hasNormals && attributes.has("TANGENT")) {
        fill(to.vertices, attributes.read("TANGENT", 4, 1.0f), 4, offsetof(Vertex, tangent));
        tidyTangents(to.vertices);
    } else if (material.normalTexture.texture >= 0) {
        generateTangents(to.vertices, to.indices, material.normalTexture.texCoord, material.normalTexture.uvFromUv);
    } else {
        for (Vertex& vertex : to.vertices) vertex.tangent = glm::vec4(perpendicularTo(vertex.normal), 1.0f);
    }
    return true;
}

}  // namespace earthshine::raster
