#pragma once
// Directions of the path tracer: drawn about a normal, and in what order rays along them are near one another.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/glm.hpp>

namespace earthshine::trace {

// Cells of directions, by which the rays are sorted.
inline constexpr std::uint32_t kCellColumns = 64, kCells = kCellColumns * kCellColumns;

/// Which cell of directions a unit vector lies in: of an octahedron unfolded to a square, numbered along a curve that
/// stays close to itself (Morton's).
inline std::uint32_t cellOf(const glm::vec3& direction) {
    const float scale = 1.0f / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    glm::vec2 p = glm::vec2(direction) * scale;
    if (direction.z < 0.0f) p = {std::copysign(1.0f - std::abs(p.y), p.x), std::copysign(1.0f - std::abs(p.x), p.y)};
    const auto spread = [](float t) {
        auto bits = std::min(std::uint32_t((0.5f * t + 0.5f) * float(kCellColumns)), kCellColumns - 1);
        bits = (bits | bits << 4) & 0x0f0fu;
        bits = (bits | bits << 2) & 0x3333u;
        return (bits | bits << 1) & 0x5555u;
    };
    return spread(p.x) | spread(p.y) << 1;
}

/// A direction about the unit vector `normal`, as likely as its cosine.
inline glm::vec3 cosineDirection(const glm::vec3& normal, const glm::vec2& random) {
    // Orthonormal basis: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z), b = normal.x * normal.y * a;
    const glm::vec3 tangent(1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
    const glm::vec3 bitangent(b, sign + normal.y * normal.y * a, -normal.y);
    const float radius = std::sqrt(random.x), angle = 2.0f * std::numbers::pi_v<float> * random.y;
    return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
           std::sqrt(std::max(1.0f - random.x, 0.0f)) * normal;
}

}  // namespace earthshine::trace
