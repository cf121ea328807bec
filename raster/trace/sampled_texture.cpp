#include "raster/trace/sampled_texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/glm.hpp>

namespace earthshine::trace {

namespace {

float decoded(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

std::array<float, 256> valuesOfBytes(bool isSrgb) {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < 256; ++i) values[i] = isSrgb ? decoded(float(i) / 255.0f) : float(i) / 255.0f;
    return values;
}

// Of a texture's bytes. Divisions are slow.
const std::array<float, 256> kLinearBytes = valuesOfBytes(false), kSrgbBytes = valuesOfBytes(true);

int wrapped(int x, int size, raster::Wrap wrap) {
    switch (wrap) {
        case raster::Wrap::Repeat:
            if ((size & (size - 1)) == 0) return x & (size - 1);  // divisions are slow
            return ((x % size) + size) % size;
        case raster::Wrap::MirroredRepeat: {
            const int at = ((x % (2 * size)) + 2 * size) % (2 * size);
            return at < size ? at : 2 * size - 1 - at;
        }
        case raster::Wrap::ClampToEdge:
            break;
    }
    return std::clamp(x, 0, size - 1);
}

/// Texel coordinates beyond what an int holds mean nothing any more; NaN becomes 0.
float tame(float texels) {
    constexpr float kMost = 1e9f;
    return texels > -kMost ? std::min(texels, kMost) : (texels < 0.0f ? -kMost : 0.0f);
}

}  // namespace

SampledTexture::SampledTexture(const raster::Texture& texture)
    : isSrgb_(texture.isSrgb), linearFilter_(texture.linearFilter), wrapU_(texture.wrapU), wrapV_(texture.wrapV) {
    if (texture.mipmaps) smaller_ = raster::smallerLevels(texture);
    const auto add = [this](const auto& from) {
        levels_.push_back({from.widthPx, from.heightPx, from.rgba16.empty() ? from.rgba8.data() : nullptr,
                           from.rgba16.empty() ? nullptr : from.rgba16.data()});
    };
    add(texture);
    for (const raster::MipLevel& level : smaller_) add(level);
}

inline glm::vec4 SampledTexture::texel(const Level& level, int x, int y) const {
    const std::size_t at = 4 * (std::size_t(y) * std::size_t(level.widthPx) + std::size_t(x));
    if (level.rgba8) {
        const std::uint8_t* t = level.rgba8 + at;
        const auto& color = isSrgb_ ? kSrgbBytes : kLinearBytes;
        return {color[t[0]], color[t[1]], color[t[2]], kLinearBytes[t[3]]};
    }
    const std::uint16_t* t = level.rgba16 + at;
    const glm::vec4 value = glm::vec4(t[0], t[1], t[2], t[3]) / 65535.0f;
    return isSrgb_ ? glm::vec4(decoded(value.x), decoded(value.y), decoded(value.z), value.w) : value;
}

/// Bilinear, or the nearest, of texelAt(x, y).
template <class Texel>
auto SampledTexture::filtered(const glm::vec2& uv, const Level& level, Texel&& texelAt) const {
    const auto at = [&](int x, int y) {
        return texelAt(wrapped(x, level.widthPx, wrapU_), wrapped(y, level.heightPx, wrapV_));
    };
    const float x = tame(uv.x * float(level.widthPx)), y = tame(uv.y * float(level.heightPx));
    if (!linearFilter_) return at(int(std::floor(x)), int(std::floor(y)));
    const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
    const float fx = x - 0.5f - left, fy = y - 0.5f - top;
    const int x0 = int(left), y0 = int(top);
    return glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), fx), glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), fx), fy);
}

glm::vec4 SampledTexture::sampleLevel(const glm::vec2& uv, int index) const {
    const Level& level = levels_[std::size_t(index)];
    return filtered(uv, level, [&](int x, int y) { return texel(level, x, y); });
}

float SampledTexture::alpha(const glm::vec2& uv) const {
    const Level& level = levels_[0];
    return filtered(uv, level, [&](int x, int y) {
        return float(alpha_[std::size_t(y) * std::size_t(level.widthPx) + std::size_t(x)]) / 65535.0f;
    });
}

void SampledTexture::prepareAlpha() {
    const Level& level = levels_[0];
    if (!alpha_.empty()) return;
    for (int y = 0; y < level.heightPx; ++y)
        for (int x = 0; x < level.widthPx; ++x)
            alpha_.push_back(std::uint16_t(std::lround(texel(level, x, y).a * 65535.0f)));
}

glm::vec4 SampledTexture::sample(const glm::vec2& uv, const glm::vec2& dx, const glm::vec2& dy) const {
    const glm::vec2 size(levels_[0].widthPx, levels_[0].heightPx);
    const float texels2 = std::max(glm::dot(dx * size, dx * size), glm::dot(dy * size, dy * size));
    const float level = 0.5f * std::log2(std::max(texels2, 1.0f));
    const float last = float(levels_.size() - 1);
    if (!(level > 0.0f) || last == 0.0f) return sampleLevel(uv, 0);
    const float clamped = std::min(level, last);
    const int lower = std::min(int(clamped), int(levels_.size()) - 2);
    return glm::mix(sampleLevel(uv, lower), sampleLevel(uv, lower + 1), clamped - float(lower));
}

}  // namespace earthshine::trace
