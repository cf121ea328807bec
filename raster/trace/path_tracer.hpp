#pragma once
// The truth: light gathered by tracing paths over the very scene that raster draws.
//
// At a pixel's surface point x (the pixel's centre; no anti-aliasing, as in a G-buffer) with the shading normal n:
//   direct    E0(x) = sum over lights of V E_perp max(0, n.l): exact, lights have no size
//   indirect  E(x)  = integral over the directions w above x of L(x, w) max(0, n.w) dw, in lux
//             L     = albedo_y / pi E0(y) + light of later bounces, at the surface y that is seen along w
// Light from below the geometric surface does not count, whatever the normal map says, neither at x nor at y.
//
// Without visibility (what a reflective shadow map without occlusion estimates):
//             E(x)  = integral over what the light meets first, y, of
//                     dPhi(y) / pi max(0, n_y.w') max(0, n.w) / |x - y|^2
//   with dPhi the albedo times the power that arrives, as in a texel of the map: normals shape where the light goes,
//   but not how much of it there is, and nothing is said of geometric normals. It is estimated in two ways at once:
//   from rays of the light whose first hits are connected to x, and from rays of x of which every hit, not just the
//   first, counts if the light meets it first. The balance heuristic (Veach and Guibas 1995) joins the two, so that
//   neither corners nor small patches of light are noisy.
//
// On surfaces without normal maps the two differ by visibility alone. With normal maps they also differ in which of the
// two normals has the cosine of the light at y and which that of x; the mean hardly moves.

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "earthshine/frame.hpp"
#include "earthshine/pipeline.hpp"
#include "raster/scene/scene.hpp"

namespace earthshine::trace {

/// Bounces until a path dies by itself (Russian roulette).
inline constexpr int kAllBounces = -1;

/// Which rays estimate light without visibility. One alone is for tests: the sum is the same.
enum class Strategy { Both, FromLight, FromSurface };

struct TraceSettings {
    Extent extent;
    int bounceCount = 1;             ///< [0; 1000] or kAllBounces
    bool indirectVisibility = true;  ///< false: at most one bounce, and nothing stands between it and x
    Strategy strategy = Strategy::Both;
    bool emission = false;       ///< add what surfaces emit to Direct (it lights nothing)
    glm::vec3 background{0.0f};  ///< cd/m^2 - Direct where the camera sees nothing (it lights nothing)
    std::uint32_t seed = 0;
    int threads = 0;  ///< 0 = one a core; does not change the picture
};

/// How much a picture may still change.
struct TraceNoise {
    double relMse = 0;     ///< of the mean indirect irradiance; as in metrics.hpp, from two independent halves
    double meanError = 0;  ///< standard error of the picture's mean, relative to it
};

/// How many rays were cast, and how long that took.
struct RayCount {
    std::size_t camera = 0, gather = 0, shadow = 0, light = 0;
    double seconds = 0;     ///< from the start of the work to its end, all threads at once
    double cpuSeconds = 0;  ///< of the processor, added up over the threads
    std::size_t total() const { return camera + gather + shadow + light; }
};

/// Samples of every pixel, added up in two halves that share nothing, so that their difference tells the noise.
class PathTracer {
public:
    /// Builds the acceleration structure, and traces what needs no samples: what the camera sees, and direct light.
    /// The scene must outlive this. Throws UsageError for settings out of range, Error if Embree fails.
    PathTracer(const raster::Scene& scene, const Camera& camera, std::span<const Light> lights,
               const TraceSettings& settings);
    ~PathTracer();
    PathTracer(PathTracer&&) noexcept;
    PathTracer& operator=(PathTracer&&) noexcept;

    /// Adds this many samples to every pixel, half of them to each half; an odd one goes to the half that has fewer.
    /// The picture depends on the total alone, not on how it was split into calls, nor on the threads.
    void addSamples(int perPixel);
    int sampleCount() const;

    /// Meaningful from two samples on.
    TraceNoise noise() const;
    RayCount rays() const;
    std::size_t surfacePixels() const;  ///< those that are not sky

    /// RGBA32F as Pipeline::read gives it; not Display.
    HostImage read(Output output) const;

    /// What the camera sees, float formats: the albedo and the normal as RGBA32F, the depth as R32F.
    HostImage albedo() const;
    HostImage normalWs() const;
    HostImage depth() const;

    /// Writes the sums so far, and what they are sums of, to a file; see trace_state.cpp for its format. Throws Error.
    void saveState(const std::string& path) const;
    /// Goes on from such a file. Throws InputError if it is damaged or of another scene, camera, light or setting.
    void loadState(const std::string& path);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace earthshine::trace
