#pragma once
// Lower resolution and back, in plain doubles from the contracts of downsample.cl, bilateral_upsample.cl and
// interpolate.cl; and pictures to try them on. Nothing here is shared with the kernels or the stages.

#include "reference/frame_reference.hpp"

namespace earthshine::reference {

/// Every `stride`-th pixel of a picture, what is left over shared between both ends.
struct Picks {
    Picks(Extent full, int stride);
    /// The pixel that a texel is.
    int x(int texelX) const { return texelX * stride + offsetX; }
    int y(int texelY) const { return texelY * stride + offsetY; }

    int stride;
    Extent full, low;
    int offsetX, offsetY;
};

/// What the camera sees: some simple surfaces with edges of every kind, a pole thinner than a texel, and sky.
struct Still {
    Camera camera;
    HostImage normalWs;  ///< RGBA16F
    HostImage depth;     ///< R32F
    HostImage motion;    ///< RGBA16F, random
};
Still makeStill(Extent extent, bool isOrthographic);

/// A pixel's answer. Where a threshold or a choice is so near that rounding decides, `isClear` is false.
struct Answer {
    glm::dvec3 irradiance{0.0};
    bool isListed = false;  ///< by interpolate
    bool isLost = false;    ///< to upsample: none of the four fits
    bool isClear = true;
};

/// Of each pixel, row by row. `points` are the full picture's (surfacePoints), `low` the irradiance of the picks, row
/// by row.
std::vector<Answer> upsample(const Camera& camera, const std::vector<SurfacePoint>& points, const HostImage& depth,
                             const Picks& picks, const std::vector<glm::dvec3>& low);
std::vector<Answer> interpolate(const Camera& camera, const std::vector<SurfacePoint>& points, const HostImage& depth,
                                const Picks& picks, const std::vector<glm::dvec3>& low, double minCosine,
                                double maxPlaneTexels);

}  // namespace earthshine::reference
