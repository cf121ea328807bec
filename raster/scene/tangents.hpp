#pragma once
// Tangents for normal maps, for meshes whose file gives none.

#include <cstdint>
#include <vector>

#include <glm/mat3x3.hpp>

#include "raster/scene/scene.hpp"

namespace earthshine::raster {

/// Any unit vector perpendicular to the unit vector `normal`; continuous over all of the sphere but one point.
glm::vec3 perpendicularTo(const glm::vec3& normal);

/// Gives every vertex a tangent that goes with the coordinates `uvFromUv * (uvN, 1)`, N = `texCoord`: the tangent
/// follows increasing u, the bitangent decreasing v, since glTF's normal maps count green upwards and v downwards.
/// The weights are those of MikkTSpace (mikktspace.com): each corner adds its triangle's direction, projected to the
/// plane of the normal and weighted by its angle, to all corners of equal position, normal, uv and handedness. A vertex
/// that mirrored and unmirrored triangles share is split in two, so `vertices` may grow and `indices` change.
/// Triangles without area in uv take the tangent of a neighbour, or any perpendicular one.
void generateTangents(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices, int texCoord,
                      const glm::mat3& uvFromUv);

}  // namespace earthshine::raster
