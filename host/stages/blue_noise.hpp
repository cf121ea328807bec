#pragma once
// Blue noise for per-pixel randomisation: data/noise/blue_noise.pgm, embedded (data/generate/blue_noise.py made it).

#include <cstdint>
#include <vector>

namespace earthshine {

inline constexpr int kBlueNoiseSizePx = 64;  ///< side of a tile; it repeats without a seam

/// Two tiles of ranks [0; 64 x 64), one after the other.
extern const std::uint16_t kBlueNoiseRanks[2 * kBlueNoiseSizePx * kBlueNoiseSizePx];

/// What rsm_gather turns its pattern by: three planes of 64 x 64 floats: a shift [0; 1) of the radius's place in the
/// pattern, and the cosine and sine of a turn.
std::vector<float> makeRotationNoise();

}  // namespace earthshine
