#include "image/plane.hpp"

#include <algorithm>

#include "parallel.hpp"

namespace earthshine {

Plane filtered(const Plane& plane, std::span<const float> alongX, std::span<const float> alongY) {
    const auto [width, height] = plane.extent;
    const int radiusX = int(alongX.size()) / 2;
    const int radiusY = int(alongY.size()) / 2;
    Plane rows(plane.extent), result(plane.extent);
    parallelFor(height, 0, [&](int y) {
        const float* in = plane.row(y);
        std::vector<float> padded(std::size_t(width) + alongX.size() - 1);
        for (int x = 0; x < int(padded.size()); ++x) padded[std::size_t(x)] = in[std::clamp(x - radiusX, 0, width - 1)];
        float* out = rows.row(y);
        for (std::size_t tap = 0; tap < alongX.size(); ++tap)
            for (int x = 0; x < width; ++x) out[x] += alongX[tap] * padded[std::size_t(x) + tap];
    });
    parallelFor(height, 0, [&](int y) {
        float* out = result.row(y);
        for (int tap = 0; tap < int(alongY.size()); ++tap) {
            const float* in = rows.row(std::clamp(y + tap - radiusY, 0, height - 1));
            for (int x = 0; x < width; ++x) out[x] += alongY[std::size_t(tap)] * in[x];
        }
    });
    return result;
}

}  // namespace earthshine
