#include "raster/trace/sampled_texture.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <glm/glm.hpp>

namespace earthshine::trace {

namespace {

float decoded(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float encodedFrom(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

const std::array<float, 256>& decodedBytes() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < 256; ++i) values[i] = decoded(float(i) / 255.0f);
        return values;
    }();
    return table;
}

int wrapped(int x, int size, raster::Wrap wrap) {
    switch (wrap) {
        case raster::Wrap::Repeat:
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
    Level first;
    first.widthPx = texture.widthPx;
    first.heightPx = texture.heightPx;
    if (texture.rgba16.empty())
        first.rgba8 = texture.rgba8.data();
    else
        first.rgba16 = texture.rgba16.data();
    levels_.push_back(std::move(first));
    if (texture.mipmaps)
        while (levels_.back().widthPx > 1 || levels_.back().heightPx > 1) addSmallerLevel();
}

/// Each texel is what a linear filter reads at its centre in the larger level, as Mesa makes mipmaps; for even sizes
/// that is the mean of four.
void SampledTexture::addSmallerLevel() {
    const Level& from = levels_.back();
    Level to;
    to.widthPx = std::max(from.widthPx / 2, 1);
    to.heightPx = std::max(from.heightPx / 2, 1);
    const std::size_t count = 4 * std::size_t(to.widthPx) * std::size_t(to.heightPx);
    if (from.rgba8)
        to.owned8.resize(count);
    else
        to.owned16.resize(count);
    const auto along = [](int i, int toSize, int fromSize) {
        const float at = (float(i) + 0.5f) * float(fromSize) / float(toSize) - 0.5f;
        const int low = int(std::floor(at));
        return std::tuple(std::clamp(low, 0, fromSize - 1), std::clamp(low + 1, 0, fromSize - 1), at - float(low));
    };
    for (int y = 0; y < to.heightPx; ++y)
        for (int x = 0; x < to.widthPx; ++x) {
            const auto [x0, x1, fx] = along(x, to.widthPx, from.widthPx);
            const auto [y0, y1, fy] = along(y, to.heightPx, from.heightPx);
            glm::vec4 value = glm::mix(glm::mix(texel(from, x0, y0), texel(from, x1, y0), fx),
                                       glm::mix(texel(from, x0, y1), texel(from, x1, y1), fx), fy);
            if (isSrgb_) value = {encodedFrom(value.x), encodedFrom(value.y), encodedFrom(value.z), value.w};
            const std::size_t at = 4 * (std::size_t(y) * std::size_t(to.widthPx) + std::size_t(x));
            for (std::size_t c = 0; c < 4; ++c) {
                if (from.rgba8)
                    to.owned8[at + c] = std::uint8_t(std::lround(value[int(c)] * 255.0f));
                else
                    to.owned16[at + c] = std::uint16_t(std::lround(value[int(c)] * 65535.0f));
            }
        }
    levels_.push_back(std::move(to));
    Level& added = levels_.back();
    if (added.owned16.empty())
        added.rgba8 = added.owned8.data();
    else
        added.rgba16 = added.owned16.data();
}

glm::vec4 SampledTexture::texel(const Level& level, int x, int y) const {
    const std::size_t at = 4 * (std::size_t(y) * std::size_t(level.widthPx) + std::size_t(x));
    if (level.rgba8) {
        const std::uint8_t* t = level.rgba8 + at;
        if (isSrgb_) {
            const auto& table = decodedBytes();
            return {table[t[0]], table[t[1]], table[t[2]], float(t[3]) / 255.0f};
        }
        return glm::vec4(t[0], t[1], t[2], t[3]) / 255.0f;
    }
    const std::uint16_t* t = level.rgba16 + at;
    const glm::vec4 value = glm::vec4(t[0], t[1], t[2], t[3]) / 65535.0f;
    return isSrgb_ ? glm::vec4(decoded(value.x), decoded(value.y), decoded(value.z), value.w) : value;
}

glm::vec4 SampledTexture::sampleLevel(const glm::vec2& uv, int index) const {
    const Level& level = levels_[std::size_t(index)];
    const auto at = [&](int x, int y) {
        return texel(level, wrapped(x, level.widthPx, wrapU_), wrapped(y, level.heightPx, wrapV_));
    };
    const float x = tame(uv.x * float(level.widthPx)), y = tame(uv.y * float(level.heightPx));
    if (!linearFilter_) return at(int(std::floor(x)), int(std::floor(y)));
    const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
    const float fx = x - 0.5f - left, fy = y - 0.5f - top;
    const int x0 = int(left), y0 = int(top);
    return glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), fx), glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), fx), fy);
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
