#pragma once
// What a node's world transform must be for what hangs on it.

#include <optional>

#include <glm/mat4x4.hpp>

namespace earthshine::raster {

bool isFinite(const glm::mat4& matrix);

/// Place and direction without scale, shear or reflection, for cameras and lights: the z axis is kept, y is as near as
/// it can be. Nothing if the scale leaves no direction.
std::optional<glm::mat4> rigid(const glm::dmat4& matrix);

}  // namespace earthshine::raster
