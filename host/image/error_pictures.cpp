// The pictures that metrics.hpp promises: what the numbers look like.

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

#include "image/metrics.hpp"

namespace earthshine {

namespace {

constexpr float kNotCounted = 0.25f;  // grey, encoded

void put(HostImage& picture, std::size_t i, const glm::vec3& encoded) {
    auto* p = reinterpret_cast<std::uint8_t*>(picture.data()) + 4 * i;
    for (int c = 0; c < 3; ++c) p[c] = std::uint8_t(std::lround(std::clamp(encoded[c], 0.0f, 1.0f) * 255.0f));
    p[3] = 255;
}

std::size_t pixelCount(const ImageView& image) {
    return std::size_t(image.extent.widthPx) * std::size_t(image.extent.heightPx);
}

/// Black, violet, red-orange, pale yellow: lightness grows steadily along it.
glm::vec3 heat(float t) {
    constexpr glm::vec3 kStops[] = {
        {0, 0, 0}, {0.32f, 0.07f, 0.48f}, {0.72f, 0.21f, 0.47f}, {0.98f, 0.55f, 0.38f}, {0.99f, 0.99f, 0.75f}};
    constexpr int kLast = int(std::size(kStops)) - 1;
    const float at = std::clamp(t, 0.0f, 1.0f) * float(kLast);
    const int i = std::min(int(at), kLast - 1);
    return glm::mix(kStops[i], kStops[i + 1], at - float(i));
}

}  // namespace

float srgbFromLinear(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float linearFromSrgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

HostImage displayPicture(const ImageView& linear, double exposure) {
    HostImage picture(PixelFormat::RGBA8, linear.extent);
    const auto* pixels = static_cast<const glm::vec4*>(linear.data);
    for (std::size_t i = 0; i < pixelCount(linear); ++i) {
        const glm::vec3 shown = glm::clamp(glm::vec3(pixels[i]) * float(exposure), 0.0f, 1.0f);
        put(picture, i, {srgbFromLinear(shown.x), srgbFromLinear(shown.y), srgbFromLinear(shown.z)});
    }
    return picture;
}

HostImage heatPicture(const ImageView& map, const ImageView& counted, float white) {
    HostImage picture(PixelFormat::RGBA8, map.extent);
    for (std::size_t i = 0; i < pixelCount(map); ++i) {
        const bool counts = static_cast<const float*>(counted.data)[i] != 0.0f;
        put(picture, i, counts ? heat(static_cast<const float*>(map.data)[i] / white) : glm::vec3(kNotCounted));
    }
    return picture;
}

HostImage signedDifferencePicture(const ImageView& test, const ImageView& reference, const PictureErrors& errors,
                                  float fullScale) {
    constexpr glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);
    HostImage picture(PixelFormat::RGBA8, test.extent);
    const auto* t = static_cast<const glm::vec4*>(test.data);
    const auto* r = static_cast<const glm::vec4*>(reference.data);
    for (std::size_t i = 0; i < pixelCount(test); ++i) {
        if (errors.counted.pixel(0, 0)[i] == 0.0f) {
            put(picture, i, glm::vec3(kNotCounted));
            continue;
        }
        const float truth = glm::dot(glm::vec3(r[i]), kLuminance);
        const float difference = glm::dot(glm::vec3(t[i]), kLuminance) - truth;
        const float relative = difference / std::max(std::abs(truth) + 0.1f * float(errors.referenceMean), 1e-30f);
        const float strength = std::clamp(relative / fullScale, -1.0f, 1.0f);
        const float fade = 1.0f - std::abs(strength);
        put(picture, i, strength > 0.0f ? glm::vec3(1.0f, fade, fade) : glm::vec3(fade, fade, 1.0f));
    }
    return picture;
}

}  // namespace earthshine
