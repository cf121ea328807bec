#pragma once
// The arithmetic of rsm_gather.clh, which two kernels share.

#include "earthshine/settings.hpp"
#include "flops.hpp"

namespace earthshine::bench {

/// Of one pixel and one light: its place, the pattern's move (a shift, a turn), the disk's centre on the map (w, 1 / w,
/// u and v scaled and kept on it), its samples, the sum scaled. A sample: u shifted and wrapped (+, floor, -), mapped
/// to a radius, turned to a place (a product, two mad a coordinate), the texel, geometry, weight, flux.
inline double gatherFlops(bool hasRecords, const Settings& settings) {
    constexpr double kMove = 1 + 3 + 3, kCentre = kRowTimesPoint + 2 + 2 * (kRowTimesPoint + 1) + 4;
    const double mapping = settings.mapping == RadiusMapping::Area    ? 1
                           : settings.mapping == RadiusMapping::Polar ? 2
                                                                      : 4;
    const double place = 1 + 2 * (3 + kFma);
    const double texel = hasRecords ? kUnpackRecord : kTexelOfMaps;
    const double sample = 3 + mapping + place + texel + kTexelGeometry + 1 + kMad3;
    return kPositionFromDepth + kMove + kCentre + settings.sampleCount * sample + kMad3;
}

}  // namespace earthshine::bench
