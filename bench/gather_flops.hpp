#pragma once
// The arithmetic of rsm_gather.clh, which two kernels share.

#include "earthshine/settings.hpp"
#include "flops.hpp"
#include "rsm_choose_params.h"

namespace earthshine::bench {

/// Of one pixel and one light: its place, the pattern's move (a shift, a turn), the disk's centre on the map (w, 1 / w,
/// u and v scaled and kept on it), its samples, the sum scaled. A sample: u shifted and wrapped (+, -), mapped
/// to a radius, turned to a place (a product, two mad a coordinate), the texel, geometry, weight, flux.
inline double gatherFlops(bool hasRecords, const Settings& settings) {
    constexpr double kMove = 1 + 3 + 3, kCentre = kRowTimesPoint + 2 + 2 * (kRowTimesPoint + 1) + 4;
    const double mapping = settings.mapping == RadiusMapping::Area    ? 1
                           : settings.mapping == RadiusMapping::Polar ? 2
                                                                      : 4;
    const double place = 1 + 2 * (3 + kFma);
    const double texel = hasRecords ? kUnpackRecord : kTexelOfMaps;
    const double sample = 2 + mapping + place + texel + kTexelGeometry + 1 + kMad3;
    return kPositionFromDepth + kMove + kCentre + settings.sampleCount * sample + kMad3;
}

/// rsm_choose.cl: of one set and one light. Sixteen points and their centres on the map, the pattern's move. A sample:
/// u shifted, wrapped, mapped and turned; its place (two sums); sixteen densities (two differences, a square, max, the
/// mapping's, a sum); its weight.
inline double chooseFlops(const Settings& settings) {
    constexpr double kCentres = COHERENT_SPAN_PX / COHERENT_STRIDE_PX, kMove = 1 + 3 + 3;
    constexpr double kCentre = kPositionFromDepth + kRowTimesPoint + 2 + 2 * (kRowTimesPoint + 1) + 4;
    const bool isArea = settings.mapping == RadiusMapping::Area, isPolar = settings.mapping == RadiusMapping::Polar;
    const double point = 2 + (isArea ? 1 : isPolar ? 2 : 4) + 1 + 2 * (3 + 1);
    const double density = 2 + kFma + 1 + 1 + (isArea ? 0 : isPolar ? 1 : 3) + 1;
    return kCentres * kCentre + kMove + settings.sampleCount * (point + 2 + kCentres * density + 1);
}

/// rsm_gather_coherent.cl: of one pixel and one light. Texels are the same for all lanes; what is left is geometry,
/// weight and flux.
inline double coherentGatherFlops(const Settings& settings) {
    return kPositionFromDepth + settings.sampleCount * (kTexelGeometry + 1 + kMad3);
}

}  // namespace earthshine::bench
