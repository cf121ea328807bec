#pragma once
// What the tests of the denoiser share: walls that slide, pictures as numbers, and what counts as near.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <glm/vec3.hpp>

#include "earthshine/pipeline.hpp"
#include "reference/denoiser_reference.hpp"
#include "reference/device_variants.hpp"

namespace earthshine {

// Sums of a few dozen floats whose weights hold a plane's distance, a difference of positions some 1e-6 exact.
inline constexpr double kRelative = 2e-3;
inline FrameImages slidingWalls(Extent extent) {
    return reference::wallsFrame({extent});
}

inline std::vector<glm::dvec3> colors(const HostImage& image) {
    std::vector<glm::dvec3> result;
    for (int i = 0; i < image.extent().widthPx * image.extent().heightPx; ++i) {
        const float* p = image.pixel(0, 0) + 4 * i;
        result.emplace_back(p[0], p[1], p[2]);
    }
    return result;
}

inline double meanOf(const std::vector<glm::dvec3>& picture) {
    double sum = 0.0;
    for (const glm::dvec3& e : picture) sum += reference::luminanceOf(e);
    return sum / double(picture.size());
}

inline void expectNear(const HostImage& actual, const std::vector<glm::dvec3>& expected) {
    double mean = 0.0;
    for (const glm::dvec3& e : expected) mean += (e.x + e.y + e.z) / 3.0 / double(expected.size());
    ASSERT_GT(mean, 0.0);
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(double(actual.pixel(0, 0)[4 * int(i) + c]), expected[i][c],
                        kRelative * (std::fabs(expected[i][c]) + mean))
                << int(i) % actual.extent().widthPx << ", " << int(i) / actual.extent().widthPx;
}

inline Settings fewSamples() {
    Settings s;
    s.sampleCount = 4;
    s.antiLag = 0.0f;
    return s;
}

class Denoiser : public testing::TestWithParam<reference::Variant> {
protected:
    Device device_{GetParam().caps, GetParam().options};
};

}  // namespace earthshine
