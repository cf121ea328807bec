#pragma once
// What a pixel of the camera sees, as a ray of the traced scene.

#include <cmath>
#include <limits>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "raster/trace/trace_scene.hpp"

namespace earthshine::trace {

/// Rays of the camera, in trace space, t from 0 at the near plane to 1 at the far one (or without end).
class CameraRays {
public:
    CameraRays(const Camera& camera, Extent extent, const glm::dvec3& originWs)
        : extent_(extent),
          viewFromTrace_(glm::dmat4(camera.viewFromWorld) * glm::translate(glm::dmat4(1.0), originWs)),
          traceFromClip_(glm::inverse(glm::dmat4(camera.clipFromView) * viewFromTrace_)) {}

    /// Through the centre of a pixel, which may lie beyond the picture.
    Ray through(int xPx, int yPx) const {
        const double x = 2.0 * (xPx + 0.5) / extent_.widthPx - 1.0;
        const double y = 1.0 - 2.0 * (yPx + 0.5) / extent_.heightPx;
        const auto at = [&](double z) { return traceFromClip_ * glm::dvec4(x, y, z, 1.0); };
        const glm::dvec4 nearClip = at(-1.0), middleClip = at(0.0), farClip = at(1.0);
        const glm::dvec3 near = glm::dvec3(nearClip) / nearClip.w;
        const glm::dvec3 towards = glm::dvec3(middleClip) / middleClip.w - near;
        Ray ray{glm::vec3(near), glm::vec3(towards), 0.0f, std::numeric_limits<float>::infinity()};
        // A projection without far plane has w = 0 there, or what rounding makes of it.
        if (std::abs(farClip.w) < 1e-9 * std::abs(nearClip.w)) return ray;
        const glm::dvec3 whole = glm::dvec3(farClip) / farClip.w - near;
        if (glm::dot(whole, towards) > 0.0) ray.tFar = float(glm::length(whole) / glm::length(towards));
        return ray;
    }

    float depth(const glm::vec3& position) const { return float(-(viewFromTrace_ * glm::dvec4(position, 1.0f)).z); }

private:
    Extent extent_;
    glm::dmat4 viewFromTrace_, traceFromClip_;
};

}  // namespace earthshine::trace
