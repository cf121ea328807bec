#include "stages/blue_noise.hpp"

#include <cmath>
#include <numbers>

namespace earthshine {

std::vector<float> makeRotationNoise() {
    constexpr int kTexels = kBlueNoiseSizePx * kBlueNoiseSizePx;
    std::vector<float> planes(3 * kTexels);
    for (int i = 0; i < kTexels; ++i) {
        const double turn = 2.0 * std::numbers::pi * (kBlueNoiseRanks[kTexels + i] + 0.5) / kTexels;
        planes[std::size_t(i)] = float((kBlueNoiseRanks[i] + 0.5) / kTexels);
        planes[std::size_t(kTexels + i)] = float(std::cos(turn));
        planes[std::size_t(2 * kTexels + i)] = float(std::sin(turn));
    }
    return planes;
}

}  // namespace earthshine
