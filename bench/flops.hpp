#pragma once
// How many floating-point operations the dialect's helpers do a lane, counted by their source: + - * / sqrt rsqrt min
// max floor rint are one each, vmad is two. Comparisons, selections, signs, conversions, addresses and what is the same
// for all lanes are none. So a row's GFLOP/s does not depend on how a driver spells any of them.

namespace earthshine::bench {

// lanes.clh, vec3.clh
inline constexpr double kFma = 2, kMul3 = 3, kAdd3 = 3, kSub3 = 3, kScale3 = 3, kMad3 = 3 * kFma;
inline constexpr double kDot3 = 1 + 2 * kFma, kRowTimesPoint = 3 * kFma, kLuminance = 1 + 2 * kFma;

// geometry.clh: ray and origin two mad3 each, and one of the depth
inline constexpr double kPositionFromDepth = 5 * kMad3;

// math.clh
inline constexpr double kExp2 = 2 + 2 + 1 + 7 * kFma;  // clamp, rounding, t, the series
inline constexpr double kLog2 = 3 + 1 + 5 * kFma;      // s, s^2, the series
inline constexpr double kPow = 1 + kLog2 + 1 + kExp2;

// rsm.clh
inline constexpr double kTexelGeometry = kSub3 + kDot3 + (2 * (kDot3 + 1) + 1) + (2 * kFma + 1);
inline constexpr double kTexelRadius = 1 + kDot3 + 3;  // of a directional light: area / pi, cosine, max, /, sqrt
inline constexpr double kUnpackRecord = 4;             // three snorm16 and a half, scaled
inline constexpr double kPositiveFlux = 3;             // max(0, .)
inline constexpr double kTexelOfMaps = kPositionFromDepth + kTexelRadius + kPositiveFlux;  // without records

// rsm_record.clh: three snorm16 (clamp, scaled and rounded at once) and a half
inline constexpr double kStoreRecord = 3 * 4 + 1;

}  // namespace earthshine::bench
