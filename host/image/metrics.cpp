#include "image/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include "earthshine/error.hpp"
#include "image/plane.hpp"

namespace earthshine {

namespace {

constexpr glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);
constexpr double kMiddleGrey = 0.18;

std::size_t pixelCount(const ImageView& image) {
    return std::size_t(image.extent.widthPx) * std::size_t(image.extent.heightPx);
}

glm::vec3 rgb(const HostImage& image, std::size_t i) {
    const float* p = image.pixel(0, 0) + 4 * i;
    return {p[0], p[1], p[2]};
}

bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check(const ImageView& test, const ImageView& reference, const ImageView& mask) {
    if (test.format != PixelFormat::RGBA32F || reference.format != PixelFormat::RGBA32F)
        throw UsageError(fmt::format("cannot compare {} with {}: both pictures must be RGBA32F",
                                     formatName(test.format), formatName(reference.format)));
    if (test.extent != reference.extent)
        throw UsageError(fmt::format("the pictures differ in size: {}x{} and {}x{}", test.extent.widthPx,
                                     test.extent.heightPx, reference.extent.widthPx, reference.extent.heightPx));
    if (!mask.empty() && (mask.format != PixelFormat::R32F || mask.extent != test.extent))
        throw UsageError("the mask must be R32F and of the pictures' size");
}

/// The two pictures with 0 where a pixel does not count.
struct Counted {
    HostImage test, reference;
};

Counted count(const ImageView& test, const ImageView& reference, const ImageView& mask, PictureErrors& errors) {
    Counted result{toFloat(test), toFloat(reference)};
    errors.counted = HostImage(PixelFormat::R32F, test.extent);
    for (std::size_t i = 0; i < pixelCount(test); ++i) {
        const bool isMasked = !mask.empty() && static_cast<const float*>(mask.data)[i] == 0.0f;
        const bool testFinite = isFinite(rgb(result.test, i)), referenceFinite = isFinite(rgb(result.reference, i));
        const bool counts = !isMasked && testFinite && referenceFinite;
        errors.maskedPixels += isMasked;
        errors.nonFiniteTestPixels += !isMasked && !testFinite;
        errors.nonFiniteReferencePixels += !isMasked && !referenceFinite;
        errors.pixels += counts;
        errors.counted.pixel(0, 0)[i] = counts ? 1.0f : 0.0f;
        if (counts) continue;
        for (HostImage* image : {&result.test, &result.reference})
            for (int c = 0; c < 4; ++c) image->pixel(0, 0)[4 * i + std::size_t(c)] = 0.0f;
    }
    return result;
}

double relativeError(double test, double reference) {
    if (reference != 0.0) return test / reference - 1.0;
    return test == 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
}

/// Everything that is a mean over values. Pixels that do not count are 0 in both, and so add nothing to the sums.
void measureValues(const Counted& pictures, PictureErrors& errors) {
    const std::size_t total = pixelCount(pictures.test.view());
    const auto values = double(3 * errors.pixels);
    glm::dvec3 testSum(0.0), referenceSum(0.0);
    for (std::size_t i = 0; i < total; ++i) {
        testSum += rgb(pictures.test, i);
        referenceSum += rgb(pictures.reference, i);
    }
    errors.testMean = (testSum.x + testSum.y + testSum.z) / values;
    errors.referenceMean = (referenceSum.x + referenceSum.y + referenceSum.z) / values;
    errors.meanError = relativeError(errors.testMean, errors.referenceMean);
    for (int c = 0; c < 3; ++c) errors.channelMeanErrors[std::size_t(c)] = relativeError(testSum[c], referenceSum[c]);

    const double scale = errors.referenceMean != 0.0 ? errors.referenceMean : errors.testMean;
    const double floor = 0.01 * scale * scale;
    for (std::size_t i = 0; i < total; ++i) {
        const glm::dvec3 t = rgb(pictures.test, i), r = rgb(pictures.reference, i);
        for (int c = 0; c < 3; ++c) {
            const double difference = t[c] - r[c];
            errors.mae += std::abs(difference) / values;
            errors.mse += difference * difference / values;
            if (difference != 0.0) errors.relMse += difference * difference / (r[c] * r[c] + floor) / values;
        }
    }
}

double autoExposure(const HostImage& reference) {
    double sum = 0.0;
    std::size_t lit = 0;
    for (std::size_t i = 0; i < pixelCount(reference.view()); ++i) {
        const double luminance = double(glm::dot(rgb(reference, i), kLuminance));
        if (!(luminance > 1e-12)) continue;
        sum += std::log2(luminance);
        ++lit;
    }
    return lit ? kMiddleGrey / std::exp2(sum / double(lit)) : 1.0;
}

/// What the display shows, linear light in [0; 1]: in place.
void clipToDisplay(HostImage& image, double exposure) {
    for (std::size_t i = 0; i < 4 * pixelCount(image.view()); ++i)
        image.pixel(0, 0)[i] = float(std::clamp(double(image.pixel(0, 0)[i]) * exposure, 0.0, 1.0));
}

Plane luma(const HostImage& display) {
    Plane result(display.extent());
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        const glm::vec3 linear = rgb(display, i);
        result.values[i] = glm::dot(
            glm::vec3(srgbFromLinear(linear.x), srgbFromLinear(linear.y), srgbFromLinear(linear.z)), kLuminance);
    }
    return result;
}

double psnr(const Counted& display, std::size_t pixels) {
    double sum = 0.0;
    for (std::size_t i = 0; i < pixelCount(display.test.view()); ++i)
        for (int c = 0; c < 3; ++c) {
            const double difference =
                double(srgbFromLinear(rgb(display.test, i)[c])) - double(srgbFromLinear(rgb(display.reference, i)[c]));
            sum += difference * difference;
        }
    return -10.0 * std::log10(sum / double(3 * pixels));
}

/// Wang, Bovik, Sheikh and Simoncelli 2004, "Image Quality Assessment: From Error Visibility to Structural Similarity":
/// windows are Gaussians of 1.5 pixels cut at 5, K1 = 0.01, K2 = 0.03. Ours: the picture goes on beyond its edges with
/// its outermost pixels, so that every pixel has a window.
double ssim(const Plane& test, const Plane& reference, const HostImage& counted, std::size_t pixels) {
    constexpr int kRadius = 5;
    constexpr double kDeviation = 1.5, kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
    std::vector<float> window;
    double sum = 0.0;
    for (int i = -kRadius; i <= kRadius; ++i) sum += std::exp(-0.5 * i * i / (kDeviation * kDeviation));
    for (int i = -kRadius; i <= kRadius; ++i)
        window.push_back(float(std::exp(-0.5 * i * i / (kDeviation * kDeviation)) / sum));
    const auto product = [](const Plane& a, const Plane& b) {
        Plane result(a.extent);
        for (std::size_t i = 0; i < a.values.size(); ++i) result.values[i] = a.values[i] * b.values[i];
        return result;
    };
    const auto blurred = [&](const Plane& plane) { return filtered(plane, window, window); };
    const Plane meanT = blurred(test), meanR = blurred(reference);
    const Plane squareT = blurred(product(test, test)), squareR = blurred(product(reference, reference));
    const Plane cross = blurred(product(test, reference));
    double result = 0.0;
    for (std::size_t i = 0; i < test.values.size(); ++i) {
        if (counted.pixel(0, 0)[i] == 0.0f) continue;
        const double t = double(meanT.values[i]), r = double(meanR.values[i]);
        const double varianceT = double(squareT.values[i]) - t * t, varianceR = double(squareR.values[i]) - r * r;
        const double covariance = double(cross.values[i]) - t * r;
        result +=
            (2.0 * t * r + kC1) * (2.0 * covariance + kC2) / ((t * t + r * r + kC1) * (varianceT + varianceR + kC2));
    }
    return result / double(pixels);
}

double meanOver(const HostImage& map, const HostImage& counted, std::size_t pixels) {
    double sum = 0.0;
    for (std::size_t i = 0; i < pixelCount(map.view()); ++i)
        if (counted.pixel(0, 0)[i] != 0.0f) sum += double(map.pixel(0, 0)[i]);
    return sum / double(pixels);
}

}  // namespace

PictureErrors measureErrors(const ImageView& test, const ImageView& reference, const CompareOptions& options) {
    check(test, reference, options.mask);
    PictureErrors errors;
    Counted pictures = count(test, reference, options.mask, errors);
    if (errors.pixels == 0) throw UsageError("the pictures have no pixel that counts: all are masked or not finite");
    measureValues(pictures, errors);
    if (options.kind == PictureKind::Scene) {
        errors.hdrFlip = hdrFlip(pictures.test.view(), pictures.reference.view(), options.pixelsPerDegree);
        errors.hdrFlipMean = meanOver(errors.hdrFlip->errors, errors.counted, errors.pixels);
        errors.exposure = autoExposure(pictures.reference);
    }
    clipToDisplay(pictures.test, errors.exposure);
    clipToDisplay(pictures.reference, errors.exposure);
    errors.psnrDb = psnr(pictures, errors.pixels);
    errors.ssim = ssim(luma(pictures.test), luma(pictures.reference), errors.counted, errors.pixels);
    errors.ldrFlipMap = ldrFlip(pictures.test.view(), pictures.reference.view(), options.pixelsPerDegree);
    errors.ldrFlip = meanOver(errors.ldrFlipMap, errors.counted, errors.pixels);
    return errors;
}

}  // namespace earthshine
