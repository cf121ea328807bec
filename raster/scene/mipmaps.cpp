#include "raster/scene/mipmaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/glm.hpp>

namespace earthshine::raster {

namespace {

float decoded(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float encodedFrom(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// A level in linear light: nothing is lost on the way from level to level.
struct LinearLevel {
    int widthPx, heightPx;
    std::vector<glm::vec4> texels;

    const glm::vec4& at(int x, int y) const { return texels[std::size_t(y) * std::size_t(widthPx) + std::size_t(x)]; }
};

template <class Integer>
LinearLevel linearLevel(const Texture& texture, const std::vector<Integer>& rgba, float most) {
    std::vector<float> colors(std::size_t(most) + 1);
    for (std::size_t i = 0; i < colors.size(); ++i)
        colors[i] = texture.isSrgb ? decoded(float(i) / most) : float(i) / most;
    LinearLevel level{texture.widthPx, texture.heightPx, {}};
    level.texels.reserve(rgba.size() / 4);
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4)
        level.texels.emplace_back(colors[rgba[i]], colors[rgba[i + 1]], colors[rgba[i + 2]], float(rgba[i + 3]) / most);
    return level;
}

/// Where the centre of texel i of `size` lies between two texels of the larger level.
struct Between {
    int low, high;
    float share;  ///< of `high`

    Between(int i, int size, int largerSize) {
        const float at = (float(i) + 0.5f) * float(largerSize) / float(size) - 0.5f;
        const float below = std::floor(at);
        low = std::clamp(int(below), 0, largerSize - 1);
        high = std::clamp(int(below) + 1, 0, largerSize - 1);
        share = at - below;
    }
};

LinearLevel halved(const LinearLevel& from) {
    LinearLevel to{std::max(from.widthPx / 2, 1), std::max(from.heightPx / 2, 1), {}};
    to.texels.reserve(std::size_t(to.widthPx) * std::size_t(to.heightPx));
    for (int y = 0; y < to.heightPx; ++y) {
        const Between v(y, to.heightPx, from.heightPx);
        for (int x = 0; x < to.widthPx; ++x) {
            const Between u(x, to.widthPx, from.widthPx);
            to.texels.push_back(glm::mix(glm::mix(from.at(u.low, v.low), from.at(u.high, v.low), u.share),
                                         glm::mix(from.at(u.low, v.high), from.at(u.high, v.high), u.share), v.share));
        }
    }
    return to;
}

template <class Integer>
std::vector<Integer> stored(const LinearLevel& level, bool isSrgb, float most) {
    std::vector<Integer> rgba;
    rgba.reserve(4 * level.texels.size());
    for (const glm::vec4& texel : level.texels)
        for (int c = 0; c < 4; ++c)
            rgba.push_back(Integer(std::lround((isSrgb && c < 3 ? encodedFrom(texel[c]) : texel[c]) * most)));
    return rgba;
}

}  // namespace

std::vector<MipLevel> smallerLevels(const Texture& texture) {
    const bool is16 = !texture.rgba16.empty();
    LinearLevel linear =
        is16 ? linearLevel(texture, texture.rgba16, 65535.0f) : linearLevel(texture, texture.rgba8, 255.0f);
    std::vector<MipLevel> levels;
    while (linear.widthPx > 1 || linear.heightPx > 1) {
        linear = halved(linear);
        MipLevel& level = levels.emplace_back();
        level.widthPx = linear.widthPx;
        level.heightPx = linear.heightPx;
        if (is16)
            level.rgba16 = stored<std::uint16_t>(linear, texture.isSrgb, 65535.0f);
        else
            level.rgba8 = stored<std::uint8_t>(linear, texture.isSrgb, 255.0f);
    }
    return levels;
}

}  // namespace earthshine::raster
