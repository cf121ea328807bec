#pragma once
// How far a picture is from the truth, in the numbers that people quote.

#include <array>
#include <cstddef>
#include <optional>

#include "earthshine/image.hpp"
#include "image/flip.hpp"

namespace earthshine {

/// What the values of two pictures mean.
enum class PictureKind {
    Scene,    ///< scene-linear radiance or irradiance, any unit
    Display,  ///< display-linear, [0; 1]: an 8-bit picture whose sRGB curve was undone
};

struct CompareOptions {
    PictureKind kind = PictureKind::Scene;
    double pixelsPerDegree = kFlipPixelsPerDegree;
    ImageView mask;  ///< R32F - pixels where it is 0 do not count; empty: all do
};

/// Errors of a test picture T against a reference R, over the pixels that count: those the mask leaves and that are
/// finite in both. Values are all three channels of them. "Display" is R or T as they are shown: scene-linear pictures
/// times `exposure`, clipped to [0; 1], sRGB-encoded.
struct PictureErrors {
    std::size_t pixels = 0;  ///< that count
    std::size_t maskedPixels = 0;
    std::size_t nonFiniteTestPixels = 0, nonFiniteReferencePixels = 0;  ///< among those that the mask leaves
    double testMean = 0, referenceMean = 0;
    double meanError = 0;  ///< signed: testMean / referenceMean - 1; 0 if both are 0, else infinite for a black R
    std::array<double, 3> channelMeanErrors{};
    double relMse = 0;  ///< mean of (T - R)^2 / (R^2 + (0.1 referenceMean)^2); a black R is compared with T's own mean
    double mae = 0;     ///< mean of |T - R|
    double mse = 0;     ///< mean of (T - R)^2
    double exposure = 1;             ///< Scene: R's log-average luminance becomes 0.18 (Reinhard et al. 2002)
    double psnrDb = 0;               ///< of the display pictures, peak 1; infinite if they are equal
    double ssim = 0;                 ///< of the display pictures' luma, mean over the pixels (Wang et al. 2004)
    double ldrFlip = 0;              ///< of the display pictures, mean
    std::optional<HdrFlip> hdrFlip;  ///< Scene: with its map
    double hdrFlipMean = 0;
    HostImage ldrFlipMap;  ///< R32F
    HostImage counted;     ///< R32F - 1 where a pixel counts, else 0
};

/// Measures RGBA32F pictures of one extent; alpha is not looked at. In filters (SSIM, FLIP) pixels that do not count
/// are black in both pictures. Throws UsageError if the formats or extents do not fit, or if no pixel counts.
PictureErrors measureErrors(const ImageView& test, const ImageView& reference, const CompareOptions& options = {});

/// The sRGB curve, [0; 1] to [0; 1], and back.
float srgbFromLinear(float linear);
float linearFromSrgb(float encoded);

/// RGBA32F, scene- or display-linear, as RGBA8: times `exposure`, clipped, sRGB-encoded, opaque.
HostImage displayPicture(const ImageView& linear, double exposure);

/// An R32F map as RGBA8 from black over violet and orange to pale yellow at `white`; where `counted` is 0 it is grey.
HostImage heatPicture(const ImageView& map, const ImageView& counted, float white);

/// (T - R) / (R + 0.1 referenceMean), luminance, as RGBA8: red where T is too bright, blue where it is too dark, full
/// at `fullScale`; where pixels do not count it is grey.
HostImage signedDifferencePicture(const ImageView& test, const ImageView& reference, const PictureErrors& errors,
                                  float fullScale);

}  // namespace earthshine
