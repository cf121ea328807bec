#pragma once
// The stages again, in plain scalar doubles and straight from the equations: nothing here is shared with the kernels or
// with the host code that feeds them (positions come from inverse matrices, not from ViewRays).

#include <cstdint>
#include <vector>

#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "earthshine/frame.hpp"

namespace earthshine::reference {

/// A point of a surface: of the camera's G-buffer or of an RSM.
struct SurfacePoint {
    bool isValid = false;
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};
};

/// One RSM texel: a small Lambertian disc.
struct Vpl {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};
    glm::dvec3 flux{0.0};  ///< lm
    double radius = 0.0;   ///< m, sqrt(area / pi)
};

/// Where uv and linear depth of a camera's map lie in the world.
glm::dvec3 unproject(const Camera& camera, glm::dvec2 uv, double linearDepth);

/// The texels of a G-buffer (normal RGBA16F, depth R32F), row by row.
std::vector<SurfacePoint> surfacePoints(const Camera& camera, const ImageView& normalWs, const ImageView& depth);

/// The texels of one light's RSM, row by row; flux 0 where the light meets nothing.
std::vector<Vpl> vpls(const Light& light, const LightMaps& maps);

/// Blocks of factor x factor texels as one texel each, of light number `lightIndex` of a frame (rsm_minify.cl).
std::vector<Vpl> minified(const std::vector<Vpl>& texels, int size, int factor, int lightIndex, std::uint32_t seed);

/// G(p, x) of rsm_gather.cl: max(0, n_p.d) max(0, n.d) / (d^2 (d^2 + r^2)).
double texelGeometry(const SurfacePoint& x, const Vpl& p);

/// sum_p Phi_p / pi G(p, x).
glm::dvec3 rsmSum(const SurfacePoint& x, const std::vector<Vpl>& texels);

/// How a pixel moves the disk's pattern: r^2, which goes from 0 in equal steps, by `shift` (of the unit disk,
/// wrapping), the whole by `turn` of a circle. Without noise: half a step, no turn.
struct PatternMove {
    double shift = 0.0;
    double turn = 0.0;
};

/// The move of pixel (x, y) by the two tiles of data/noise/blue_noise.pgm.
PatternMove patternMove(int x, int y);

/// The move of pixel (x, y) by a tile of 4 x 4: half a step of `sampleCount`, and a turn.
PatternMove tileMove(int x, int y, int sampleCount);

/// tile_average.cl over a picture of the given camera.
struct TileAverage {
    std::vector<glm::dvec3> irradiance;
    int taps = 0, accepted = 0;  ///< surfaces around surfaces, and those that counted
    double clearance = 1.0;      ///< no tap was nearer to the other decision: a cosine, or a part of the reach
};
TileAverage tileAverage(const Camera& camera, Extent extent, const std::vector<SurfacePoint>& points,
                        const std::vector<glm::dvec3>& irradiance);

/// The further move of frame `index`: r^2 by a fraction of a sample's step, by the R2 sequence.
PatternMove frameMove(int index, int sampleCount);

/// Points before their move: Hammersley's or along a line; density over radii: r = u^power.
struct DiskShape {
    bool isLine = false;
    double power = 0.5;
};

/// The disk estimator with `count` points around the projection of x, for an RSM of side `size` of which
/// the light's projection fills `mapScale` a side.
glm::dvec3 rsmDisk(const SurfacePoint& x, const std::vector<Vpl>& texels, const Light& light, int size, int count,
                   double radiusUv, PatternMove move, double mapScale = 1.0, DiskShape shape = {});

/// The same where sets of pixels, every fourth of 64 of a row, share texels: of the picture's pixels, from one light.
std::vector<glm::dvec3> rsmCoherent(const std::vector<SurfacePoint>& points, Extent extent,
                                    const std::vector<Vpl>& texels, const Light& light, int size, int count,
                                    double radiusUv, int frameIndex, double mapScale = 1.0, DiskShape shape = {});

/// Direct irradiance of one light behind its shadow map.
glm::dvec3 directLight(const SurfacePoint& x, const Light& light, const ImageView& shadowDepth, double biasTexels,
                       double slopeBiasTexels);

/// 2^stops x 0.18 / exp(mean ln L) over the pixels given that are brighter than 1e-12.
double automaticExposure(const std::vector<glm::dvec3>& radiance, double stops);

/// The byte that tone_map.cl writes for a display-linear value.
int displayByte(double value, bool filmic);

}  // namespace earthshine::reference
