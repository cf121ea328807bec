#include "raster/scene/node_transform.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace earthshine::raster {

bool isFinite(const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(matrix[column][row])) return false;
        }
    }
    return true;
}

std::optional<glm::mat4> rigid(const glm::dmat4& matrix) {
    const auto unit = [](const glm::dvec3& v) { return v / glm::length(v); };
    const glm::dvec3 z = unit(glm::dvec3(matrix[2]));
    const glm::dvec3 x = unit(glm::cross(unit(glm::dvec3(matrix[1])), z));
    const glm::dvec3 y = glm::cross(z, x);
    const glm::mat4 result(glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(y, 0.0), glm::dvec4(z, 0.0), matrix[3]));
    if (!isFinite(result)) return std::nullopt;
    return result;
}

}  // namespace earthshine::raster
