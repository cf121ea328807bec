#include "stages/blue_noise.hpp"

#include <cmath>
#include <numbers>

namespace earthshine {

std::vector<float> makeRotationNoise() {
    constexpr int kTexels = kBlueNoiseSizePx * kBlueNoiseSizePx;
    std::vector<float> planes(3 * kTexels);
    for (int i = 0; i < kTexels; ++i) {
        const double fraction = (kBlueNoiseRanks[kTexels + i] + 0.5) / kTexels;
        const double turn = 2.0 * std::numbers::pi * fraction;
        // The turn's noise fills the steps of the shift's: 4096 radii are too few where irradiance peaks at the centre.
        planes[std::size_t(i)] = float((kBlueNoiseRanks[i] + fraction) / kTexels);
        planes[std::size_t(kTexels + i)] = float(std::cos(turn));
        planes[std::size_t(2 * kTexels + i)] = float(std::sin(turn));
    }
    return planes;
}

}  // namespace earthshine
