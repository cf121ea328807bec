#include "raster/scene/tangents.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include <glm/geometric.hpp>

namespace earthshine::raster {

namespace {

/// What two corners must share to share a tangent: position, normal and uv, bit for bit.
using CornerKey = std::array<std::uint32_t, 8>;

struct CornerKeyHash {
    std::size_t operator()(const CornerKey& key) const noexcept {
        std::uint64_t hash = 14695981039346656037ull;  // FNV-1a, a word at a time
        for (const std::uint32_t word : key) hash = (hash ^ word) * 1099511628211ull;
        return std::size_t(hash ^ (hash >> 32));
    }
};

CornerKey cornerKey(const Vertex& vertex, const glm::vec2& uv) {
    // Adding zero makes -0 and 0, which are equal numbers, equal bits.
    const std::array<float, 8> values = {vertex.position.x + 0.0f,
                                         vertex.position.y + 0.0f,
                                         vertex.position.z + 0.0f,
                                         vertex.normal.x + 0.0f,
                                         vertex.normal.y + 0.0f,
                                         vertex.normal.z + 0.0f,
                                         uv.x + 0.0f,
                                         uv.y + 0.0f};
    CornerKey key;
    std::memcpy(key.data(), values.data(), sizeof key);
    return key;
}

/// `v` in the plane of the unit vector `normal`, as a unit vector; zero if nothing of it is left.
glm::vec3 projectedUnit(const glm::vec3& v, const glm::vec3& normal) {
    const glm::vec3 inPlane = v - normal * glm::dot(normal, v);
    const float length = glm::length(inPlane);
    return length > 0.0f && std::isfinite(length) ? inPlane / length : glm::vec3(0.0f);
}

/// The side of uv space that a triangle shows: 0 as the texture is, 1 mirrored, -1 without area.
int handedness(const glm::vec2& duv1, const glm::vec2& duv2) {
    const double area = double(duv1.x) * double(duv2.y) - double(duv2.x) * double(duv1.y);
    // v points down, so a triangle that is counter-clockwise on the surface and in the picture has a negative area.
    return area < 0.0 ? 0 : area > 0.0 ? 1 : -1;
}

class TangentSpace {
public:
    TangentSpace(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices)
        : vertices_(vertices), indices_(indices) {}

    void accumulate(int texCoord, const glm::mat3& uvFromUv) {
        uvs_.reserve(vertices_.size());
        groups_.reserve(vertices_.size());
        std::unordered_map<CornerKey, std::uint32_t, CornerKeyHash> groupOf;
        for (const Vertex& vertex : vertices_) {
            uvs_.emplace_back(uvFromUv * glm::vec3(texCoord == 1 ? vertex.uv1 : vertex.uv0, 1.0f));
            const auto next = std::uint32_t(groupOf.size());
            groups_.push_back(groupOf.try_emplace(cornerKey(vertex, uvs_.back()), next).first->second);
        }
        sums_.assign(groupOf.size(), {glm::vec3(0.0f), glm::vec3(0.0f)});
        sides_.assign(indices_.size() / 3, -1);
        for (std::size_t t = 0; t < sides_.size(); ++t) addTriangle(t);
    }

    /// Writes the tangents; corners of a second handedness get vertices of their own.
    void assign() {
        std::vector<std::array<std::uint32_t, 2>> vertexOfSide(vertices_.size(), {kNone, kNone});
        for (const bool withArea : {true, false}) {  // triangles without area take what the others made
            for (std::size_t corner = 0; corner < indices_.size(); ++corner) {
                const int ownSide = sides_[corner / 3];
                if ((ownSide >= 0) != withArea) continue;
                std::array<std::uint32_t, 2>& made = vertexOfSide[indices_[corner]];
                const int side = withArea ? ownSide : made[0] == kNone && made[1] != kNone ? 1 : 0;
                std::uint32_t& vertex = made[std::size_t(side)];
                if (vertex == kNone) {
                    const std::uint32_t original = indices_[corner];
                    const bool first = made[std::size_t(1 - side)] == kNone;
                    vertex = first ? original : std::uint32_t(vertices_.size());
                    if (!first) vertices_.push_back(Vertex(vertices_[original]));
                    setTangent(vertices_[vertex], sums_[groups_[original]][std::size_t(side)], side);
                }
                indices_[corner] = vertex;
            }
        }
    }

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    void addTriangle(std::size_t t) {
        const std::uint32_t* corner = &indices_[3 * t];
        const glm::vec3 edge1 = vertices_[corner[1]].position - vertices_[corner[0]].position;
        const glm::vec3 edge2 = vertices_[corner[2]].position - vertices_[corner[0]].position;
        const glm::vec2 duv1 = uvs_[corner[1]] - uvs_[corner[0]];
        const glm::vec2 duv2 = uvs_[corner[2]] - uvs_[corner[0]];
        const int side = handedness(duv1, duv2);
        if (side < 0) return;
        sides_[t] = side;
        // The direction of increasing u: the gradient times the uv area, whose sign handedness() has.
        const glm::vec3 alongU = (edge1 * duv2.y - edge2 * duv1.y) * (side == 0 ? -1.0f : 1.0f);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vertex& vertex = vertices_[corner[i]];
            const glm::vec3 tangent = projectedUnit(alongU, vertex.normal);
            const glm::vec3 toNext =
                projectedUnit(vertices_[corner[(i + 1) % 3]].position - vertex.position, vertex.normal);
            const glm::vec3 toPrevious =
                projectedUnit(vertices_[corner[(i + 2) % 3]].position - vertex.position, vertex.normal);
            const float angle = std::acos(glm::clamp(glm::dot(toNext, toPrevious), -1.0f, 1.0f));
            sums_[groups_[corner[i]]][std::size_t(side)] += tangent * angle;
        }
    }

    static void setTangent(Vertex& vertex, const glm::vec3& sum, int side) {
        const glm::vec3 tangent = projectedUnit(sum, vertex.normal);
        const bool usable = glm::dot(tangent, tangent) > 0.5f;
        vertex.tangent = glm::vec4(usable ? tangent : perpendicularTo(vertex.normal), side == 0 ? 1.0f : -1.0f);
    }

    std::vector<Vertex>& vertices_;
    std::vector<std::uint32_t>& indices_;
    std::vector<glm::vec2> uvs_;                  // of each vertex, transformed
    std::vector<std::uint32_t> groups_;           // of each vertex, into sums_
    std::vector<std::array<glm::vec3, 2>> sums_;  // of each group, by handedness
    std::vector<int> sides_;                      // of each triangle
};

}  // namespace

glm::vec3 perpendicularTo(const glm::vec3& normal) {
    // Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z);
    return {1.0f + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a, -sign * normal.x};
}

void generateTangents(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices, int texCoord,
                      const glm::mat3& uvFromUv) {
    for (Vertex& vertex : vertices) vertex.tangent = glm::vec4(perpendicularTo(vertex.normal), 1.0f);
    TangentSpace space(vertices, indices);
    space.accumulate(texCoord, uvFromUv);
    space.assign();
}

}  // namespace earthshine::raster
