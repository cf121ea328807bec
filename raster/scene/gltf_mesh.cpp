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

    /// Copies an attribute into the member of Vertex at `offset`, `components` floats wide; nothing if the file has it
    /// not. POSITION comes first: `vertices` is resized. Components that the file leaves out (an alpha) are 1.
    void read(const char* name, std::size_t offset, int components, std::vector<Vertex>& vertices) const {
        if (!has(name)) return;
        std::vector<float> values =
            readFloats(context_, primitive_.attributes.at(name), components, 1.0f, fmt::format("{}.{}", place_, name));
        morph(name, components, values);
        const auto width = std::size_t(components);
        vertices.resize(values.size() / width);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            std::memcpy(reinterpret_cast<char*>(&vertices[i]) + offset, &values[i * width], width * sizeof(float));
        }
    }

private:
    void morph(const char* name, int components, std::vector<float>& values) const {
        for (std::size_t t = 0; t < std::min(weights_.size(), primitive_.targets.size()); ++t) {
            const auto found = primitive_.targets[t].find(name);
            const auto weight = float(weights_[t]);
            if (found == primitive_.targets[t].end() || weight == 0.0f) continue;
            const std::string place = fmt::format("{}.targets[{}].{}", place_, t, name);
            const std::vector<float> change = readFloats(context_, found->second, components, 0.0f, place);
            for (std::size_t i = 0; i < values.size(); ++i) {
                values[i] += weight * change[i];
                if (!std::isfinite(values[i])) context_.file.fail(place, "makes a number that is not finite");
            }
        }
    }

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
    const Attributes attributes(context_, from, weights, place);
    if (from.mode < TINYGLTF_MODE_TRIANGLES || !attributes.has("POSITION")) {
        context_.note(place + ": only triangles with a POSITION are drawn");
        return false;
    }
    attributes.read("POSITION", offsetof(Vertex, position), 3, to.vertices);
    to.indices = readTriangles(from, to.vertices.size(), place);
    if (to.indices.empty()) {
        context_.note(place + ": has no triangle");
        return false;
    }
    const bool hasNormals = attributes.has("NORMAL");
    count(hasNormals ? to.vertices.size() : to.indices.size(), to.indices.size(), place);

    attributes.read("TEXCOORD_0", offsetof(Vertex, uv0), 2, to.vertices);
    attributes.read("TEXCOORD_1", offsetof(Vertex, uv1), 2, to.vertices);
    attributes.read("COLOR_0", offsetof(Vertex, color), 4, to.vertices);
    for (Vertex& vertex : to.vertices) vertex.color = glm::clamp(vertex.color, 0.0f, 1.0f);
    attributes.read("NORMAL", offsetof(Vertex, normal), 3, to.vertices);
    if (!hasNormals) {
        makeFlat(to.vertices, to.indices);
    } else if (const std::size_t missing = normalizeNormals(to.vertices, to.indices); missing > 0) {
        context_.note(fmt::format("{}: {} normals have no direction; those of the faces stand in", place, missing));
    }

    to.material = materials_.materialOf(from.material);
    const Material& material = context_.scene.materials[std::size_t(to.material)];
    const TextureRef& normalMap = material.normalTexture;
    if (hasNormals && attributes.has("TANGENT")) {
        attributes.read("TANGENT", offsetof(Vertex, tangent), 4, to.vertices);
        tidyTangents(to.vertices);
    } else if (normalMap.texture >= 0) {
        generateTangents(to.vertices, to.indices, normalMap.texCoord, normalMap.uvFromUv);
    } else {
        for (Vertex& vertex : to.vertices) vertex.tangent = glm::vec4(perpendicularTo(vertex.normal), 1.0f);
    }
    for (const TextureRef* ref :
         {&material.baseColorTexture, &material.metallicTexture, &normalMap, &material.emissionTexture}) {
        const char* set = ref->texCoord == 0 ? "TEXCOORD_0" : "TEXCOORD_1";
        if (ref->texture >= 0 && !attributes.has(set)) {
            context_.note(fmt::format("{}: has no {}, which its material reads; (0, 0) stands in", place, set));
        }
    }
    return true;
}

Indices GltfMeshes::readTriangles(const tinygltf::Primitive& from, std::size_t vertexCount,
                                  const std::string& place) const {
    Indices given;
    if (from.indices >= 0) {
        given = readIndices(context_, from.indices, vertexCount, place + ".indices");
    } else {
        given.resize(vertexCount);
        std::iota(given.begin(), given.end(), 0u);
    }
    if (from.mode == TINYGLTF_MODE_TRIANGLES && given.size() % 3 != 0) {
        context_.note(
            fmt::format("{}: {} corners are no whole number of triangles; the last are left out", place, given.size()));
    }
    return triangleList(given, from.mode);
}

void GltfMeshes::count(std::size_t vertices, std::size_t indices, const std::string& place) {
    vertexCount_ += vertices;
    indexCount_ += indices;
    if (vertexCount_ > gltf_limits::kVertices || indexCount_ > gltf_limits::kIndices) {
        context_.file.fail(place, fmt::format("the scene has more than {} vertices or {} indices",
                                              gltf_limits::kVertices, gltf_limits::kIndices));
    }
}

}  // namespace earthshine::raster
