// The ruler itself: closed forms, the published numbers of FLIP, and what must not count.
//
// The golden numbers were made with pictures of the formula in synthetic() below by
//   FLIP   flip-evaluator 1.7 (the authors' own package on PyPI): evaluate(reference, test, "LDR" or "HDR",
//          inputsRGB=False, applyMagma=False, parameters={"ppd": 67.0206432766})
//   SSIM   SciPy's gaussian_filter (sigma 1.5, truncate 3.34, mode "nearest"); away from the edges the same numbers as
//          scikit-image's structural_similarity(gaussian_weights=True, sigma=1.5, use_sample_covariance=False)
//   others NumPy, in double precision

#include "image/metrics.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "earthshine/error.hpp"
#include "image/plane.hpp"
#include "temp_folder.hpp"

namespace earthshine {
namespace {

using test::thrown;
using ::testing::HasSubstr;

constexpr Extent kExtent{96, 64};

/// Waves and a checkerboard; the test picture is shifted by 0.6 pixels and loses a tenth of its red.
HostImage synthetic(double shiftPx, double red, bool highDynamicRange) {
    HostImage image(PixelFormat::RGBA32F, kExtent);
    for (int y = 0; y < kExtent.heightPx; ++y)
        for (int x = 0; x < kExtent.widthPx; ++x) {
            const double u = x + shiftPx;
            const bool isBright = (int(std::floor(u / 8)) + y / 8) % 2 == 0;
            const double scale = highDynamicRange ? std::exp2(6 * std::sin(0.07 * x) * std::cos(0.05 * y)) : 1.0;
            float* p = image.pixel(x, y);
            p[0] = float(scale * red * (0.5 + 0.45 * std::sin(0.31 * u) * std::cos(0.11 * y)));
            p[1] = float(scale * (0.5 + 0.40 * std::sin(0.05 * u + 0.23 * y)));
            p[2] = float(scale * (isBright ? 0.8 : 0.15));
            p[3] = 1.0f;
        }
    return image;
}

HostImage constant(float r, float g, float b, Extent extent = {16, 12}) {
    HostImage image(PixelFormat::RGBA32F, extent);
    for (int i = 0; i < extent.widthPx * extent.heightPx; ++i) {
        float* p = image.pixel(0, 0) + 4 * i;
        p[0] = r, p[1] = g, p[2] = b, p[3] = 1.0f;
    }
    return image;
}

double mean(const HostImage& map) {
    double sum = 0.0;
    const int count = map.extent().widthPx * map.extent().heightPx;
    for (int i = 0; i < count; ++i) sum += double(map.pixel(0, 0)[i]);
    return sum / count;
}

TEST(Flip, LdrAgreesWithTheAuthorsPackage) {
    const HostImage reference = synthetic(0.0, 1.0, false), test = synthetic(0.6, 0.9, false);
    const HostImage map = ldrFlip(test.view(), reference.view());
    // The package works in floats and other orders of summation: they agree to the fifth digit.
    EXPECT_NEAR(mean(map), 0.1573130, 2e-5);
    EXPECT_NEAR(map.pixel(0, 0)[0], 0.0814423, 5e-5);
    EXPECT_NEAR(map.pixel(20, 10)[0], 0.1015983, 5e-5);
    EXPECT_NEAR(map.pixel(95, 63)[0], 0.1328274, 5e-5);
    EXPECT_NEAR(mean(ldrFlip(test.view(), reference.view(), 30.0)), 0.1538155, 2e-5);
}

TEST(Flip, HdrAgreesWithTheAuthorsPackage) {
    const HostImage reference = synthetic(0.0, 1.0, true), test = synthetic(0.6, 0.9, true);
    const HdrFlip flip = hdrFlip(test.view(), reference.view());
    EXPECT_NEAR(flip.startExposureStops, -4.709957, 1e-4);
    EXPECT_NEAR(flip.stopExposureStops, 2.249748, 1e-4);
    EXPECT_EQ(flip.exposureCount, 7);
    EXPECT_NEAR(mean(flip.errors), 0.1254303, 2e-5);
    EXPECT_NEAR(flip.errors.pixel(0, 0)[0], 0.0653559, 5e-5);
    EXPECT_NEAR(flip.errors.pixel(20, 10)[0], 0.0815514, 5e-5);
    EXPECT_NEAR(flip.errors.pixel(95, 63)[0], 0.1690451, 5e-5);
}

TEST(Flip, ExtremesOfTheRange) {
    const HostImage black = constant(0, 0, 0), white = constant(1, 1, 1), huge = constant(1e30f, 0, 3);
    EXPECT_EQ(mean(ldrFlip(white.view(), white.view())), 0.0);
    EXPECT_GT(mean(ldrFlip(white.view(), black.view())), 0.95);
    EXPECT_EQ(mean(hdrFlip(huge.view(), huge.view()).errors), 0.0);
    EXPECT_TRUE(std::isfinite(mean(hdrFlip(huge.view(), white.view()).errors)));
    EXPECT_TRUE(std::isfinite(mean(hdrFlip(white.view(), black.view()).errors)));
    EXPECT_THAT(thrown<UsageError>([&] {
                    ldrFlip(black.view(), constant(0, 0, 0, {3, 3}).view());
                }),
                HasSubstr("16x12 and 3x3"));
    EXPECT_THAT(thrown<UsageError>([&] { ldrFlip(black.view(), black.view(), 0.0); }), HasSubstr("pixels a degree"));
}

TEST(Metrics, AgreeWithNumPyAndSciPy) {
    const HostImage reference = synthetic(0.0, 1.0, false), test = synthetic(0.6, 0.9, false);
    CompareOptions options;
    options.kind = PictureKind::Display;
    const PictureErrors errors = measureErrors(test.view(), reference.view(), options);
    EXPECT_EQ(errors.pixels, 96u * 64u);
    EXPECT_NEAR(errors.relMse, 0.0074664831, 1e-8);
    EXPECT_NEAR(errors.mae, 0.0216117387, 1e-8);
    EXPECT_NEAR(errors.meanError, -0.0344691412, 1e-7);
    EXPECT_NEAR(errors.psnrDb, 31.2377711, 1e-4);  // the sRGB curve in floats
    EXPECT_NEAR(errors.ssim, 0.9965798157, 1e-5);  // variances are differences of float means
    EXPECT_NEAR(errors.ldrFlip, 0.1573130, 2e-5);
    EXPECT_FALSE(errors.hdrFlip.has_value());
}

TEST(Metrics, ConstantPicturesHaveClosedForms) {
    const PictureErrors errors = measureErrors(constant(3, 1.5f, 6).view(), constant(2, 2, 5).view());
    EXPECT_DOUBLE_EQ(errors.meanError, 10.5 / 9.0 - 1.0);
    EXPECT_DOUBLE_EQ(errors.channelMeanErrors[0], 0.5);
    EXPECT_DOUBLE_EQ(errors.channelMeanErrors[1], -0.25);
    EXPECT_NEAR(errors.mae, 2.5 / 3.0, 1e-12);
    EXPECT_NEAR(errors.mse, 2.25 / 3.0, 1e-12);
    // The mean of the reference is 3, so 0.09 is added to each square.
    EXPECT_NEAR(errors.relMse, (1.0 / 4.09 + 0.25 / 4.09 + 1.0 / 25.09) / 3.0, 1e-12);
    const double luminance = 0.2126 * 2 + 0.7152 * 2 + 0.0722 * 5;
    EXPECT_NEAR(errors.exposure, 0.18 / luminance, 1e-6);

    CompareOptions display;
    display.kind = PictureKind::Display;
    const auto linear = [](float encoded) { return linearFromSrgb(encoded); };
    const float a = linear(0.4f), b = linear(0.5f);
    const PictureErrors grey = measureErrors(constant(a, a, a).view(), constant(b, b, b).view(), display);
    EXPECT_NEAR(grey.psnrDb, 20.0, 1e-4);
    // Variances are differences of float means: 2e-8 beside C2 = 9e-4.
    EXPECT_NEAR(grey.ssim, (2 * 0.4 * 0.5 + 1e-4) / (0.16 + 0.25 + 1e-4), 5e-5);
}

TEST(Metrics, EqualPicturesHaveNoError) {
    const HostImage image = synthetic(0.0, 1.0, true);
    const PictureErrors errors = measureErrors(image.view(), image.view());
    EXPECT_EQ(errors.relMse, 0.0);
    EXPECT_EQ(errors.mae, 0.0);
    EXPECT_EQ(errors.meanError, 0.0);
    EXPECT_TRUE(std::isinf(errors.psnrDb));
    EXPECT_NEAR(errors.ssim, 1.0, 1e-12);
    EXPECT_EQ(errors.ldrFlip, 0.0);
    EXPECT_EQ(errors.hdrFlipMean, 0.0);
    const HostImage black = constant(0, 0, 0);
    EXPECT_EQ(measureErrors(black.view(), black.view()).relMse, 0.0);
    EXPECT_TRUE(std::isinf(measureErrors(image.view(), constant(0, 0, 0, kExtent).view()).meanError));
}

TEST(Metrics, MaskedAndBrokenPixelsDoNotCount) {
    HostImage reference = constant(2, 2, 2), test = constant(3, 3, 3), mask(PixelFormat::R32F, {16, 12});
    for (int i = 0; i < 16 * 12; ++i) mask.pixel(0, 0)[i] = 7.0f;
    mask.pixel(3, 3)[0] = mask.pixel(4, 3)[0] = 0.0f;
    test.pixel(3, 3)[0] = 1e9f;                                     // sky
    test.pixel(4, 3)[0] = std::numeric_limits<float>::quiet_NaN();  // sky, and broken: said of neither
    test.pixel(5, 5)[1] = std::numeric_limits<float>::infinity();
    test.pixel(6, 5)[1] = std::numeric_limits<float>::quiet_NaN();
    reference.pixel(6, 5)[2] = -std::numeric_limits<float>::infinity();
    CompareOptions options;
    options.mask = mask.view();
    const PictureErrors errors = measureErrors(test.view(), reference.view(), options);
    EXPECT_EQ(errors.maskedPixels, 2u);
    EXPECT_EQ(errors.nonFiniteTestPixels, 2u);
    EXPECT_EQ(errors.nonFiniteReferencePixels, 1u);
    EXPECT_EQ(errors.pixels, 16u * 12u - 4u);
    EXPECT_NEAR(errors.meanError, 0.5, 1e-12);
    EXPECT_NEAR(errors.mae, 1.0, 1e-12);
    EXPECT_NEAR(errors.testMean, 3.0, 1e-12);
    EXPECT_TRUE(std::isfinite(errors.ldrFlip) && std::isfinite(errors.hdrFlipMean) && std::isfinite(errors.ssim));

    const HostImage nothing(PixelFormat::R32F, {16, 12});
    options.mask = nothing.view();
    EXPECT_THAT(thrown<UsageError>([&] { measureErrors(test.view(), reference.view(), options); }),
                HasSubstr("no pixel that counts"));
}

TEST(Metrics, RefusesPicturesThatDoNotFit) {
    const HostImage a = constant(1, 1, 1), b = constant(1, 1, 1, {12, 16});
    EXPECT_THAT(thrown<UsageError>([&] { measureErrors(a.view(), b.view()); }), HasSubstr("16x12 and 12x16"));
    const HostImage depth(PixelFormat::R32F, {16, 12});
    EXPECT_THAT(thrown<UsageError>([&] { measureErrors(a.view(), depth.view()); }), HasSubstr("R32F"));
}

TEST(Metrics, PicturesShowTheSignOfTheError) {
    HostImage test = constant(2, 2, 2), reference = constant(2, 2, 2);
    test.pixel(1, 1)[0] = test.pixel(1, 1)[1] = test.pixel(1, 1)[2] = 4.0f;
    test.pixel(2, 1)[0] = test.pixel(2, 1)[1] = test.pixel(2, 1)[2] = 0.0f;
    test.pixel(3, 1)[0] = std::numeric_limits<float>::quiet_NaN();
    const PictureErrors errors = measureErrors(test.view(), reference.view());
    const HostImage picture = signedDifferencePicture(test.view(), reference.view(), errors, 0.5f);
    const auto at = [&](int x) {
        const auto* p = reinterpret_cast<const std::uint8_t*>(picture.data()) + 4 * (16 + x);
        return std::vector<int>(p, p + 4);
    };
    EXPECT_EQ(at(0), (std::vector<int>{255, 255, 255, 255}));
    EXPECT_EQ(at(1), (std::vector<int>{255, 0, 0, 255}));
    EXPECT_EQ(at(2), (std::vector<int>{0, 0, 255, 255}));
    EXPECT_EQ(at(3), (std::vector<int>{64, 64, 64, 255}));
}

TEST(Plane, FilterContinuesThePictureBeyondItsEdges) {
    Plane plane(Extent{3, 2});
    plane.values = {1, 2, 4, 8, 16, 32};
    const float shift[] = {1, 0, 0}, same[] = {1};
    EXPECT_THAT(filtered(plane, shift, same).values, ::testing::ElementsAre(1, 1, 2, 8, 8, 16));
    EXPECT_THAT(filtered(plane, same, shift).values, ::testing::ElementsAre(1, 2, 4, 1, 2, 4));
}

}  // namespace
}  // namespace earthshine
