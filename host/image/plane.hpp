#pragma once
// One channel of a picture in floats, and separable filters over it.

#include <span>
#include <vector>

#include "earthshine/image.hpp"

namespace earthshine {

/// Row 0 is the top; rows follow each other without padding.
struct Plane {
    Extent extent;
    std::vector<float> values;

    Plane() = default;
    explicit Plane(Extent e) : extent(e), values(std::size_t(e.widthPx) * std::size_t(e.heightPx)) {}
    float* row(int y) { return values.data() + std::size_t(y) * std::size_t(extent.widthPx); }
    const float* row(int y) const { return values.data() + std::size_t(y) * std::size_t(extent.widthPx); }
};

/// Correlates the rows with `alongX` and then the columns with `alongY`: odd numbers of weights, the middle one on the
/// pixel itself. Beyond the edge the picture goes on with its outermost pixels.
Plane filtered(const Plane& plane, std::span<const float> alongX, std::span<const float> alongY);

}  // namespace earthshine
