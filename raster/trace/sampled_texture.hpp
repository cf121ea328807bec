#pragma once
// Textures as GL filters them, on the CPU.

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "raster/scene/mipmaps.hpp"
#include "raster/scene/scene.hpp"

namespace earthshine::trace {

/// A texture of the scene with its mipmaps. Level 0 is borrowed from the scene, which must outlive this.
class SampledTexture {
public:
    explicit SampledTexture(const raster::Texture& texture);

    /// Linear RGBA at uv (v down), bilinear on level 0 (or the nearest texel, if the texture says so).
    glm::vec4 sample(const glm::vec2& uv) const { return sampleLevel(uv, 0); }

    /// The alpha of sample(), from texels of its own that stay in a cache.
    float alpha(const glm::vec2& uv) const;

    /// sample() with mipmaps, as GL_LINEAR_MIPMAP_LINEAR does: dx and dy are how uv changes from a pixel to the next.
    glm::vec4 sample(const glm::vec2& uv, const glm::vec2& dx, const glm::vec2& dy) const;

    /// Must be called before alpha().
    void prepareAlpha();

private:
    /// Borrowed texels, of the scene or of `smaller_`; one of the two pointers is null.
    struct Level {
        int widthPx, heightPx;
        const std::uint8_t* rgba8;
        const std::uint16_t* rgba16;
    };
    glm::vec4 texel(const Level& level, int x, int y) const;
    glm::vec4 sampleLevel(const glm::vec2& uv, int level) const;
    template <class Texel>
    auto filtered(const glm::vec2& uv, const Level& level, Texel&& texelAt) const;

    bool isSrgb_, linearFilter_;
    raster::Wrap wrapU_, wrapV_;
    std::vector<raster::MipLevel> smaller_;
    std::vector<Level> levels_;
    std::vector<std::uint16_t> alpha_;  ///< of level 0, 65535 = opaque
};

}  // namespace earthshine::trace
