#pragma once
// FLIP: how different two pictures look when one flips between them, pixel by pixel in [0; 1].

#include "earthshine/image.hpp"

namespace earthshine {

/// The authors' default: a display 0.7 m wide with 3840 pixels a row, 0.7 m away.
inline constexpr double kFlipPixelsPerDegree = 67.0206432766;

/// LDR-FLIP of two pictures on a display: RGBA32F, display-linear Rec. 709 in [0; 1] (sRGB already decoded; values are
/// clamped); the result is R32F. Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images".
/// Throws UsageError if the formats or extents are not as said, or for pixelsPerDegree outside [1; 1000].
HostImage ldrFlip(const ImageView& test, const ImageView& reference, double pixelsPerDegree = kFlipPixelsPerDegree);

struct HdrFlip {
    HostImage errors;  ///< R32F - the largest LDR-FLIP over the exposures
    double startExposureStops = 0;
    double stopExposureStops = 0;
    int exposureCount = 0;
};

/// HDR-FLIP of two scene-linear pictures, RGBA32F, finite; negative values count as 0. The exposures follow from the
/// reference, the tone curve is ACES, both as published: Andersson et al. 2021, "Visualizing Errors in Rendered High
/// Dynamic Range Images". A black reference is compared at the exposure 0. Throws as ldrFlip.
HdrFlip hdrFlip(const ImageView& test, const ImageView& reference, double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace earthshine
