#include "image/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include "earthshine/error.hpp"
#include "image/plane.hpp"
#include "parallel.hpp"

namespace earthshine {

namespace {

using Planes = std::array<Plane, 3>;
using Kernel = std::vector<float>;

constexpr double kPi = std::numbers::pi;

// Rec. 709 to CIE XYZ as the paper's own code has it, in exact fractions; GLM's matrices are written column by column.
const glm::dmat3 kXyzFromLinear(10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0,
                                8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0,
                                4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0);
const glm::dmat3 kLinearFromXyz = glm::inverse(kXyzFromLinear);
const glm::dvec3 kWhiteXyz = kXyzFromLinear * glm::dvec3(1.0);

/// The linear opponent space in which the eye's contrast sensitivity is modelled (2020, section 4.1).
glm::vec3 opponentFromLinear(const glm::vec3& linear) {
    const glm::vec3 xyz = glm::mat3(kXyzFromLinear) * linear / glm::vec3(kWhiteXyz);
    return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
}

glm::vec3 linearFromOpponent(const glm::vec3& opponent) {
    const float y = (opponent.x + 16.0f) / 116.0f;
    const glm::vec3 xyz(y + opponent.y / 500.0f, y, y - opponent.z / 200.0f);
    return glm::mat3(kLinearFromXyz) * (xyz * glm::vec3(kWhiteXyz));
}

/// CIELAB with the Hunt effect: less light, less colour.
glm::vec3 huntLabFromLinear(const glm::vec3& linear) {
    constexpr float kDelta = 6.0f / 29.0f;
    const glm::vec3 xyz = glm::mat3(kXyzFromLinear) * linear / glm::vec3(kWhiteXyz);
    const auto f = [](float t) {
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
    };
    const float lightness = 116.0f * f(xyz.y) - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (f(xyz.x) - f(xyz.y)),
            0.01f * lightness * 200.0f * (f(xyz.y) - f(xyz.z))};
}

/// The HyAB distance: city blocks in lightness, as the crow flies in colour.
float hyab(const glm::vec3& a, const glm::vec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// Section 4.1, table 1: each channel's sensitivity is a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in
// degrees.
struct Gaussian {
    double a, b;
};
constexpr Gaussian kAchromatic{1.0, 0.0047};
constexpr Gaussian kRedGreen{1.0, 0.0053};
constexpr Gaussian kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};

struct SensitivityKernel {
    Kernel weights;    ///< along one side, sum 1
    double total = 0;  ///< of the two-dimensional kernel before it was scaled
};

SensitivityKernel sensitivityKernel(const Gaussian& gaussian, double pixelsPerDegree) {
    const int radius = int(std::ceil(3.0 * std::sqrt(kBlueYellow[0].b / (2.0 * kPi * kPi)) * pixelsPerDegree));
    std::vector<double> weights;
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i) {
        const double x = i / pixelsPerDegree;
        weights.push_back(std::exp(-kPi * kPi * x * x / gaussian.b));
        sum += weights.back();
    }
    SensitivityKernel result;
    for (const double w : weights) result.weights.push_back(float(w / sum));
    result.total = gaussian.a * std::sqrt(kPi / gaussian.b) * sum * sum;
    return result;
}

/// What the eye makes of a picture: filtered in opponent space, back in linear RGB and clamped to the display.
class SpatialFilter {
public:
    explicit SpatialFilter(double pixelsPerDegree)
        : achromatic_(sensitivityKernel(kAchromatic, pixelsPerDegree)),
          redGreen_(sensitivityKernel(kRedGreen, pixelsPerDegree)),
          blueYellow_{sensitivityKernel(kBlueYellow[0], pixelsPerDegree),
                      sensitivityKernel(kBlueYellow[1], pixelsPerDegree)} {}

    Planes apply(const Planes& opponent) const {
        Planes result{filtered(opponent[0], achromatic_.weights, achromatic_.weights),
                      filtered(opponent[1], redGreen_.weights, redGreen_.weights),
                      filtered(opponent[2], blueYellow_[0].weights, blueYellow_[0].weights)};
        const Plane second = filtered(opponent[2], blueYellow_[1].weights, blueYellow_[1].weights);
        const auto share = float(blueYellow_[1].total / (blueYellow_[0].total + blueYellow_[1].total));
        for (std::size_t i = 0; i < second.values.size(); ++i)
            result[2].values[i] += share * (second.values[i] - result[2].values[i]);
        return result;
    }

private:
    SensitivityKernel achromatic_, redGreen_, blueYellow_[2];
};

/// Edges and points: first and second derivatives of a Gaussian (section 4.2), each lobe's weights adding up to 1.
struct FeatureKernels {
    Kernel smooth, edge, point;

    explicit FeatureKernels(double pixelsPerDegree) {
        constexpr double kWidthDeg = 0.082;
        const double deviation = 0.5 * kWidthDeg * pixelsPerDegree;
        const int radius = int(std::ceil(3.0 * deviation));
        double smoothSum = 0.0, edgeSum = 0.0, pointSums[2] = {0.0, 0.0};
        const auto at = [&](int x) {
            const double g = std::exp(-0.5 * x * x / (deviation * deviation));
            return glm::dvec3(g, -x * g, (x * x / (deviation * deviation) - 1.0) * g);
        };
        for (int x = -radius; x <= radius; ++x) {
            smoothSum += at(x).x;
            edgeSum += std::max(at(x).y, 0.0);
            pointSums[at(x).z < 0.0] += std::abs(at(x).z);
        }
        for (int x = -radius; x <= radius; ++x) {
            smooth.push_back(float(at(x).x / smoothSum));
            edge.push_back(float(at(x).y / edgeSum));
            point.push_back(float(at(x).z / pointSums[at(x).z < 0.0]));
        }
    }
};

struct Features {
    Plane edge, point;
};

Plane magnitude(const Plane& x, const Plane& y) {
    Plane result(x.extent);
    for (std::size_t i = 0; i < x.values.size(); ++i) result.values[i] = std::hypot(x.values[i], y.values[i]);
    return result;
}

Features findFeatures(const Plane& lightness, const FeatureKernels& k) {
    Plane normalised(lightness.extent);
    for (std::size_t i = 0; i < lightness.values.size(); ++i)
        normalised.values[i] = (lightness.values[i] + 16.0f) / 116.0f;
    return {magnitude(filtered(normalised, k.edge, k.smooth), filtered(normalised, k.smooth, k.edge)),
            magnitude(filtered(normalised, k.point, k.smooth), filtered(normalised, k.smooth, k.point))};
}

/// The colour pipeline's distance in [0; 1] (section 4.1.3): compressed, and stretched so that the smaller half of the
/// distances, which matter most, fills nearly all of the range.
float colorError(const glm::vec3& testLab, const glm::vec3& referenceLab) {
    constexpr float kExponent = 0.7f, kKnee = 0.4f, kAtKnee = 0.95f;
    static const float largest = std::pow(hyab(huntLabFromLinear({0, 1, 0}), huntLabFromLinear({0, 0, 1})), kExponent);
    const float distance = std::pow(hyab(testLab, referenceLab), kExponent);
    const float knee = kKnee * largest;
    if (distance < knee) return distance * kAtKnee / knee;
    return kAtKnee + (distance - knee) / (largest - knee) * (1.0f - kAtKnee);
}

/// Everything that does not depend on the exposure.
class Flip {
public:
    explicit Flip(double pixelsPerDegree) : spatial_(pixelsPerDegree), features_(pixelsPerDegree) {}

    /// Of two display-linear pictures: calls sink(pixel, error).
    template <class Sink>
    void evaluate(const Planes& testOpponent, const Planes& referenceOpponent, Sink&& sink) const {
        const Planes test = spatial_.apply(testOpponent);
        const Planes reference = spatial_.apply(referenceOpponent);
        const Features testFeatures = findFeatures(testOpponent[0], features_);
        const Features referenceFeatures = findFeatures(referenceOpponent[0], features_);
        const auto seenLab = [](const Planes& p, std::size_t i) {
            const glm::vec3 linear = linearFromOpponent({p[0].values[i], p[1].values[i], p[2].values[i]});
            return huntLabFromLinear(glm::clamp(linear, 0.0f, 1.0f));
        };
        const auto [width, height] = test[0].extent;
        parallelFor(height, 0, [&, w = std::size_t(width)](int y) {
            for (std::size_t i = std::size_t(y) * w; i < (std::size_t(y) + 1) * w; ++i) {
                const float color = colorError(seenLab(test, i), seenLab(reference, i));
                const float difference =
                    std::max(std::abs(testFeatures.edge.values[i] - referenceFeatures.edge.values[i]),
                             std::abs(testFeatures.point.values[i] - referenceFeatures.point.values[i]));
                const float feature = std::sqrt(difference * float(1.0 / std::numbers::sqrt2));
                sink(i, std::pow(color, 1.0f - std::clamp(feature, 0.0f, 1.0f)));
            }
        });
    }

private:
    SpatialFilter spatial_;
    FeatureKernels features_;
};

/// Applies `displayFromPixel` to each pixel, clamps it to the display and takes it to the opponent space.
template <class Function>
Planes opponentPlanes(const ImageView& image, Function&& displayFromPixel) {
    Planes result{Plane(image.extent), Plane(image.extent), Plane(image.extent)};
    const auto* pixels = static_cast<const glm::vec4*>(image.data);
    const auto [width, height] = image.extent;
    parallelFor(height, 0, [&, w = std::size_t(width)](int y) {
        for (std::size_t i = std::size_t(y) * w; i < (std::size_t(y) + 1) * w; ++i) {
            const glm::vec3 display = glm::clamp(displayFromPixel(glm::vec3(pixels[i])), 0.0f, 1.0f);
            const glm::vec3 opponent = opponentFromLinear(display);
            for (int c = 0; c < 3; ++c) result[std::size_t(c)].values[i] = opponent[c];
        }
    });
    return result;
}

void check(const ImageView& test, const ImageView& reference, double pixelsPerDegree) {
    if (test.format != PixelFormat::RGBA32F || reference.format != PixelFormat::RGBA32F)
        throw UsageError(fmt::format("FLIP: {} and {} pictures: both must be RGBA32F", formatName(test.format),
                                     formatName(reference.format)));
    if (test.extent != reference.extent)
        throw UsageError(fmt::format("FLIP: pictures of {}x{} and {}x{}: they must be of one size", test.extent.widthPx,
                                     test.extent.heightPx, reference.extent.widthPx, reference.extent.heightPx));
    if (!(pixelsPerDegree >= 1.0 && pixelsPerDegree <= 1000.0))
        throw UsageError(fmt::format("FLIP: {} pixels a degree: give 1 to 1000", pixelsPerDegree));
}

// The ACES curve as fitted by Narkowicz 2015, with the exposure of 0.6 that the paper folds into it.
constexpr double kAces[] = {0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};

float aces(float x) {
    const auto k = [](int i) { return float(kAces[i]); };
    return ((k(0) * x + k(1)) * x + k(2)) / ((k(3) * x + k(4)) * x + k(5));
}

/// Where the exposures begin and end (2021, section 3.2): the brightest pixel of the reference, and then its median, is
/// taken to 85 % of the display.
HdrFlip exposures(const ImageView& reference) {
    const std::size_t count = std::size_t(reference.extent.widthPx) * std::size_t(reference.extent.heightPx);
    const auto* pixels = static_cast<const glm::vec4*>(reference.data);
    std::vector<float> luminances(count);
    for (std::size_t i = 0; i < count; ++i)
        luminances[i] = glm::dot(glm::max(glm::vec3(pixels[i]), 0.0f), glm::vec3(0.2126f, 0.7152f, 0.0722f));
    std::sort(luminances.begin(), luminances.end());
    const double brightest = double(luminances.back());
    const double median = double(luminances[count / 2]);  // of an even count the upper one, as the authors' code does

    HdrFlip result;
    result.exposureCount = 1;
    if (brightest <= 0.0) return result;
    constexpr double kOnDisplay = 0.85;
    const double a = kAces[0] - kOnDisplay * kAces[3];
    const double b = kAces[1] - kOnDisplay * kAces[4];
    const double c = kAces[2] - kOnDisplay * kAces[5];
    const double toDisplay = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
    result.startExposureStops = std::log2(toDisplay / brightest);
    result.stopExposureStops = std::log2(toDisplay / std::max(median, double(std::numeric_limits<float>::epsilon())));
    result.exposureCount = std::max(2, int(std::ceil(result.stopExposureStops - result.startExposureStops)));
    return result;
}

}  // namespace

HostImage ldrFlip(const ImageView& test, const ImageView& reference, double pixelsPerDegree) {
    check(test, reference, pixelsPerDegree);
    HostImage errors(PixelFormat::R32F, test.extent);
    const auto same = [](const glm::vec3& display) { return display; };
    Flip(pixelsPerDegree)
        .evaluate(opponentPlanes(test, same), opponentPlanes(reference, same),
                  [out = errors.pixel(0, 0)](std::size_t i, float error) { out[i] = error; });
    return errors;
}

HdrFlip hdrFlip(const ImageView& test, const ImageView& reference, double pixelsPerDegree) {
    check(test, reference, pixelsPerDegree);
    HdrFlip result = exposures(reference);
    result.errors = HostImage(PixelFormat::R32F, test.extent);
    const Flip flip(pixelsPerDegree);
    for (int i = 0; i < result.exposureCount; ++i) {
        const double step =
            (result.stopExposureStops - result.startExposureStops) / std::max(result.exposureCount - 1, 1);
        const auto factor = float(std::exp2(result.startExposureStops + i * step));
        const auto display = [factor](const glm::vec3& radiance) {
            const glm::vec3 exposed = glm::min(factor * glm::max(radiance, 0.0f), 1e6f);  // its square is a float, too
            return glm::vec3(aces(exposed.x), aces(exposed.y), aces(exposed.z));
        };
        flip.evaluate(
            opponentPlanes(test, display), opponentPlanes(reference, display),
            [out = result.errors.pixel(0, 0)](std::size_t p, float error) { out[p] = std::max(out[p], error); });
    }
    return result;
}

}  // namespace earthshine
