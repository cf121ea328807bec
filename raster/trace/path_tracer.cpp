#include "raster/trace/path_tracer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <mutex>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include "earthshine/error.hpp"
#include "parallel.hpp"
#include "raster/trace/camera_rays.hpp"
#include "raster/trace/directions.hpp"
#include "raster/trace/light_source.hpp"
#include "raster/trace/sobol.hpp"
#include "raster/trace/trace_scene.hpp"
#include "raster/trace/trace_state.hpp"

namespace earthshine::trace {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kBouncesBeforeRoulette = 3;
constexpr float kMostSurvival = 0.95f;  // so that paths end even among perfect reflectors

// Pixels a side, and samples at once, of a block whose rays are traced in the order of their directions.
constexpr int kBlockPx = 16;
constexpr int kBlockSamples = 16;
constexpr std::size_t kPathsAtOnce = 64;  // few enough to stay in the first cache

/// One of a pixel.
struct Sample {
    std::uint32_t cell;  ///< of its first direction
    int half;
    std::size_t pixel;
    glm::vec3 direction;  ///< first, unit
    Sampler sampler;
    glm::vec3 irradiance;
};

/// Where a sample has come to.
struct Path {
    Surface surface;
    Hit hit;
    bool isShaded = false;
    glm::vec3 direction{0.0f};  ///< where it goes on, unit
    Sampler sampler{0, 0};
    glm::vec3 throughput{1.0f}, arriving{0.0f}, irradiance{0.0f};
};

/// What one thread needs while it traces.
struct Work {
    struct Shadowed {
        Path* path;
        glm::vec3 direction, illuminance;
    };
    RayCount rays;
    std::vector<Sample> samples;
    std::vector<Sample*> ordered;
    std::vector<Path*> active;
    std::vector<Ray> gatherRays, shadowRays;
    std::vector<Shadowed> shadowed;
    std::vector<Hit> hits;
    bool blocked[kPathsAtOnce];
};

void check(const TraceSettings& s) {
    if (s.extent.widthPx < 1 || s.extent.heightPx < 1)
        throw UsageError(fmt::format("a picture of {}x{} has no pixels", s.extent.widthPx, s.extent.heightPx));
    if (s.bounceCount != kAllBounces && (s.bounceCount < 0 || s.bounceCount > 1000))
        throw UsageError(fmt::format("{} bounces: give 0 to 1000, or all", s.bounceCount));
    if (!s.indirectVisibility && s.bounceCount != 1)
        throw UsageError("without indirect visibility there is one bounce, as in a reflective shadow map: ask for 1");
}

}  // namespace

struct PathTracer::Impl {
    TraceSettings settings;
    std::uint64_t fingerprint;
    TraceScene scene;
    LightSources lights;
    CameraRays camera;
    std::vector<std::optional<Surface>> surfaces;  ///< one a pixel; none: sky
    std::vector<glm::vec3> direct;                 ///< lux
    TraceSums sums;
    RayCount rays;
    std::size_t surfacePixels = 0;

    Impl(const raster::Scene& from, const Camera& cameraIn, std::span<const Light> lightsIn, const TraceSettings& s)
        : settings(s),
          fingerprint(fingerprintOf(from, cameraIn, lightsIn, s)),
          scene(from),
          lights(lightsIn, scene.originWs()),
          camera(cameraIn, s.extent, scene.originWs()) {
        const std::size_t count = std::size_t(s.extent.widthPx) * std::size_t(s.extent.heightPx);
        surfaces.resize(count);
        direct.resize(count);
        for (auto& half : sums.halves) half.assign(count, glm::dvec3(0.0));
        forEachBlock(s.extent.heightPx, [&](int y, Work& work) {
            for (int x = 0; x < s.extent.widthPx; ++x) lookThrough(pixelAt(x, y), x, y, work);
        });
        for (const auto& surface : surfaces) surfacePixels += surface.has_value();
    }

    /// Calls body(block, work) for `count` blocks in parallel, and adds up the rays.
    template <class Body>
    void forEachBlock(int count, Body&& body) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t cpuStart = std::clock();
        std::mutex mutex;
        parallelFor(count, settings.threads, [&](int block) {
            thread_local Work work;  // its memory serves block after block
            work.rays = {};
            body(block, work);
            const std::lock_guard lock(mutex);
            rays.camera += work.rays.camera;
            rays.gather += work.rays.gather;
            rays.shadow += work.rays.shadow;
            rays.light += work.rays.light;
        });
        rays.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        rays.cpuSeconds += double(std::clock() - cpuStart) / CLOCKS_PER_SEC;
    }

    std::size_t pixelAt(int x, int y) const {
        return std::size_t(y) * std::size_t(settings.extent.widthPx) + std::size_t(x);
    }

    void lookThrough(std::size_t pixel, int x, int y, Work& work) {
        const Ray ray = camera.through(x, y);
        Hit hit;
        ++work.rays.camera;
        if (!scene.closest(ray, hit)) return;
        Surface surface = scene.surface(ray, hit);
        surface.turnTowards(-ray.direction);
        scene.shade(hit, camera.through(x + 1, y), camera.through(x, y + 1), surface);
        surfaces[pixel] = surface;
        direct[pixel] = directIrradiance(surface, work, [] {});
    }

    bool isLit(const Surface& surface, const Incident& incident, Work& work) const {
        ++work.rays.shadow;
        return !scene.blocksLight({surface.leave(incident.towards), incident.towards, 0.0f, incident.tFar});
    }

    /// Lux at the side of the surface that it is turned to. `shade` is called before its normal is looked at, which is
    /// not at all if it lies in shadow.
    template <class Shade>
    glm::vec3 directIrradiance(const Surface& surface, Work& work, Shade&& shade) const {
        glm::vec3 sum(0.0f);
        for (const LightSource& light : lights.all()) {
            const Incident incident = light.incident(surface.position);
            if (!(glm::dot(surface.geometricNormal, incident.direction) > 0.0f)) continue;
            if (incident.illuminance == glm::vec3(0.0f) || !isLit(surface, incident, work)) continue;
            shade();
            sum += incident.illuminance * std::max(glm::dot(surface.normal, incident.direction), 0.0f);
        }
        return sum;
    }

    /// Fills in the irradiance that each path brings to where it starts. Their rays are traced together, bounce by
    /// bounce.
    void tracePaths(std::span<Path> paths, Work& work) const {
        work.active.clear();
        for (Path& path : paths) work.active.push_back(&path);
        for (int bounce = 1;
             !work.active.empty() && (settings.bounceCount == kAllBounces || bounce <= settings.bounceCount);
             ++bounce) {
            gather(work);
            light(work);
            if (bounce != settings.bounceCount) goOn(bounce, work);
        }
    }

    /// Sends every active path on to the surface that it meets next; those that meet none end.
    void gather(Work& work) const {
        work.gatherRays.clear();
        std::size_t kept = 0;
        for (Path* path : work.active) {
            const glm::vec3& direction = path->direction;
            if (!(glm::dot(direction, path->surface.geometricNormal) > 0.0f)) continue;
            work.gatherRays.push_back({path->surface.leave(direction), direction});
            work.active[kept++] = path;
        }
        work.active.resize(kept);
        work.rays.gather += kept;
        work.hits.resize(kept);
        scene.closest(work.gatherRays, work.hits);
        std::size_t met = 0;
        for (std::size_t i = 0; i < kept; ++i) {
            if (!work.hits[i].isFound()) continue;
            Path& path = *work.active[i];
            const Ray& ray = work.gatherRays[i];
            path.hit = work.hits[i];
            path.surface = scene.surface(ray, path.hit);
            path.surface.turnTowards(-ray.direction);
            path.isShaded = false;
            work.active[met++] = &path;
        }
        work.active.resize(met);
    }

    /// Adds the direct light at every active path's surface. Shading is slow: only where light arrives.
    void light(Work& work) const {
        for (Path* path : work.active) path->arriving = glm::vec3(0.0f);
        for (const LightSource& source : lights.all()) {
            work.shadowRays.clear();
            work.shadowed.clear();
            for (Path* path : work.active) {
                const Incident incident = source.incident(path->surface.position);
                if (!(glm::dot(path->surface.geometricNormal, incident.direction) > 0.0f)) continue;
                if (incident.illuminance == glm::vec3(0.0f)) continue;
                work.shadowRays.push_back(
                    {path->surface.leave(incident.towards), incident.towards, 0.0f, incident.tFar});
                work.shadowed.push_back({path, incident.direction, incident.illuminance});
            }
            work.rays.shadow += work.shadowRays.size();
            scene.blocksLight(work.shadowRays, std::span(work.blocked, work.shadowRays.size()));
            for (std::size_t i = 0; i < work.shadowed.size(); ++i) {
                if (work.blocked[i]) continue;
                const auto& [path, direction, illuminance] = work.shadowed[i];
                shade(*path);
                path->arriving += illuminance * std::max(glm::dot(path->surface.normal, direction), 0.0f);
            }
        }
        for (Path* path : work.active)
            if (path->isShaded) path->irradiance += path->throughput * path->surface.albedo * path->arriving;
    }

    void shade(Path& path) const {
        if (!std::exchange(path.isShaded, true)) scene.shade(path.hit, path.surface);
    }

    /// Turns what arrives at a surface into what leaves it, and ends paths that carry little.
    void goOn(int bounce, Work& work) const {
        std::size_t kept = 0;
        for (Path* path : work.active) {
            shade(*path);
            if (path->surface.normal == glm::vec3(0.0f)) continue;
            // pi from the cosine's density, and 1 / pi from the diffuse surface.
            glm::vec3& throughput = path->throughput;
            throughput *= path->surface.albedo;
            if (settings.bounceCount == kAllBounces && bounce >= kBouncesBeforeRoulette) {
                const float survival = std::min(std::max({throughput.r, throughput.g, throughput.b}), kMostSurvival);
                if (!(path->sampler.next1() < survival)) continue;
                throughput /= survival;
            }
            path->direction = cosineDirection(path->surface.normal, path->sampler.next2());
            work.active[kept++] = path;
        }
        work.active.resize(kept);
    }

    /// What the light `index` sends to x by way of y, divided by the density with which y was found.
    glm::vec3 unoccludedTransfer(const Surface& x, const Hit& hit, Surface y, std::size_t index, bool isSeenByLight,
                                 Work& work) const {
        const LightSource& light = lights.all()[index];
        const Incident incident = light.incident(y.position);
        if (incident.illuminance == glm::vec3(0.0f) || !y.turnTowards(incident.direction)) return glm::vec3(0.0f);
        const float raysPerArea = light.raysPerArea(y.position, y.geometricNormal);
        if (!(raysPerArea > 0.0f)) return glm::vec3(0.0f);
        scene.shade(hit, y);
        const glm::vec3 d = y.position - x.position;
        const float distance2 = glm::dot(d, d);
        if (!(distance2 > 0.0f)) return glm::vec3(0.0f);
        const glm::vec3 w = d / std::sqrt(distance2);
        const float cosX = glm::dot(x.normal, w), cosY = -glm::dot(y.normal, w);
        if (!(cosX > 0.0f) || !(cosY > 0.0f)) return glm::vec3(0.0f);
        float density = 0.0f;
        if (settings.strategy != Strategy::FromLight)
            density += cosX / kPi * std::abs(glm::dot(y.geometricNormal, w)) / distance2;
        if (settings.strategy != Strategy::FromSurface) density += lights.chance(index) * raysPerArea;
        if (!(density > 0.0f) || (!isSeenByLight && !isLit(y, incident, work))) return glm::vec3(0.0f);
        const float arriving = std::abs(glm::dot(y.geometricNormal, incident.direction));
        return y.albedo * incident.illuminance * (arriving / kPi * cosX * cosY / (distance2 * density));
    }

    /// One sample of the indirect irradiance with nothing in the way.
    glm::vec3 unoccludedSample(const Surface& x, const glm::vec3& direction, Sampler& sampler, Work& work) const {
        glm::vec3 irradiance(0.0f);
        if (lights.empty()) return irradiance;
        const std::size_t drawn = lights.draw(sampler.next1());
        const glm::vec2 onLight = sampler.next2();
        if (settings.strategy != Strategy::FromSurface) {
            Ray ray;
            Hit hit;
            if (lights.all()[drawn].sampleRay(onLight, ray)) {
                ++work.rays.light;
                if (scene.closest(ray, hit))
                    irradiance += unoccludedTransfer(x, hit, scene.surface(ray, hit), drawn, true, work);
            }
        }
        if (settings.strategy != Strategy::FromLight) {
            ++work.rays.gather;
            const Ray ray{x.leave(direction), direction};
            scene.allHits(ray, work.hits);
            for (const Hit& hit : work.hits) {
                const Surface y = scene.surface(ray, hit);
                for (std::size_t light = 0; light < lights.all().size(); ++light)
                    irradiance += unoccludedTransfer(x, hit, y, light, false, work);
            }
        }
        return irradiance;
    }

    /// Samples of a square of pixels, traced in the order of their directions: rays that fly together find what they
    /// need in the caches. The sums are made in the order of the samples, so that nothing depends on how many are
    /// traced at once.
    void sampleBlock(int left, int top, int first, int count, Work& work) {
        work.samples.clear();
        const auto [width, height] = settings.extent;
        for (int y = top; y < std::min(top + kBlockPx, height); ++y)
            for (int x = left; x < std::min(left + kBlockPx, width); ++x) {
                const std::size_t pixel = pixelAt(x, y);
                if (!surfaces[pixel] || surfaces[pixel]->normal == glm::vec3(0.0f)) continue;
                for (int i = first; i < first + count; ++i) {
                    const auto sequence = hashed(std::uint32_t(2 * pixel) + std::uint32_t(i & 1), settings.seed);
                    Sampler sampler(sequence, std::uint32_t(i / 2));
                    const glm::vec3 direction = cosineDirection(surfaces[pixel]->normal, sampler.next2());
                    work.samples.push_back({cellOf(direction), i & 1, pixel, direction, sampler, glm::vec3(0.0f)});
                }
            }
        sortByDirection(work);
        for (std::size_t done = 0; done < work.ordered.size(); done += kPathsAtOnce) {
            const std::size_t end = std::min(done + kPathsAtOnce, work.ordered.size());
            traceSamples(std::span(work.ordered).subspan(done, end - done), work);
        }
        for (const Sample& sample : work.samples)
            sums.halves[sample.half][sample.pixel] += glm::dvec3(sample.irradiance);
    }

    /// Fills `ordered`, by counting: there are not many cells.
    static void sortByDirection(Work& work) {
        std::uint32_t starts[kCells + 1] = {};
        for (const Sample& sample : work.samples) ++starts[sample.cell + 1];
        for (std::uint32_t cell = 0; cell < kCells; ++cell) starts[cell + 1] += starts[cell];
        work.ordered.resize(work.samples.size());
        for (Sample& sample : work.samples) work.ordered[starts[sample.cell]++] = &sample;
    }

    void traceSamples(std::span<Sample* const> samples, Work& work) const {
        if (!settings.indirectVisibility) {
            for (Sample* sample : samples)
                sample->irradiance =
                    unoccludedSample(*surfaces[sample->pixel], sample->direction, sample->sampler, work);
            return;
        }
        Path paths[kPathsAtOnce];
        for (std::size_t i = 0; i < samples.size(); ++i) {
            paths[i].surface = *surfaces[samples[i]->pixel];
            paths[i].direction = samples[i]->direction;
            paths[i].sampler = samples[i]->sampler;
        }
        tracePaths(std::span(paths, samples.size()), work);
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i]->irradiance = paths[i].irradiance;
    }

    void addSamples(int perPixel) {
        const int columns = (settings.extent.widthPx + kBlockPx - 1) / kBlockPx;
        const int rows = (settings.extent.heightPx + kBlockPx - 1) / kBlockPx;
        forEachBlock(columns * rows, [&](int block, Work& work) {
            for (int done = 0; done < perPixel; done += kBlockSamples)
                sampleBlock(block % columns * kBlockPx, block / columns * kBlockPx, sums.sampleCount + done,
                            std::min(kBlockSamples, perPixel - done), work);
        });
        sums.sampleCount += perPixel;
    }

    glm::vec3 indirect(std::size_t pixel) const {
        if (sums.sampleCount == 0) return glm::vec3(0.0f);
        return glm::vec3((sums.halves[0][pixel] + sums.halves[1][pixel]) / double(sums.sampleCount));
    }

    /// An image whose surface pixels are value(pixel, surface), and whose sky is `sky`.
    template <class Value>
    HostImage image(const glm::vec3& sky, Value&& value) const {
        HostImage result(PixelFormat::RGBA32F, settings.extent);
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            const glm::vec3 color = surfaces[i] ? value(i, *surfaces[i]) : sky;
            float* p = result.pixel(0, 0) + 4 * i;
            p[0] = color.r, p[1] = color.g, p[2] = color.b;
            p[3] = surfaces[i] ? 1.0f : 0.0f;
        }
        return result;
    }
};

PathTracer::PathTracer(const raster::Scene& scene, const Camera& camera, std::span<const Light> lights,
                       const TraceSettings& settings) {
    check(settings);
    impl_ = std::make_unique<Impl>(scene, camera, lights, settings);
}

PathTracer::~PathTracer() = default;
PathTracer::PathTracer(PathTracer&&) noexcept = default;
PathTracer& PathTracer::operator=(PathTracer&&) noexcept = default;

void PathTracer::addSamples(int perPixel) {
    if (impl_->settings.bounceCount == 0) return;  // direct light is exact
    impl_->addSamples(perPixel);
}

int PathTracer::sampleCount() const {
    return impl_->sums.sampleCount;
}

TraceNoise PathTracer::noise() const {
    const TraceSums& sums = impl_->sums;
    TraceNoise noise;
    const double even = (sums.sampleCount + 1) / 2, odd = sums.sampleCount / 2;
    const auto values = double(3 * impl_->surfacePixels);
    if (odd < 1.0 || values == 0.0) return noise;
    double mean = 0.0;
    for (const auto& half : sums.halves)
        for (const glm::dvec3& sum : half) mean += (sum.x + sum.y + sum.z) / (sums.sampleCount * values);
    // The difference of the halves' means has the variance v (1 / even + 1 / odd), the mean of all v / (even + odd).
    const double scale = even * odd / (double(sums.sampleCount) * double(sums.sampleCount));
    double variance = 0.0;
    for (std::size_t i = 0; i < impl_->surfaces.size(); ++i) {
        const glm::dvec3 difference = sums.halves[0][i] / even - sums.halves[1][i] / odd;
        const glm::dvec3 value(impl_->indirect(i));
        for (int c = 0; c < 3; ++c) {
            const double square = scale * difference[c] * difference[c];
            if (square > 0.0) noise.relMse += square / (value[c] * value[c] + 0.01 * mean * mean) / values;
        }
        const double sum = difference.x + difference.y + difference.z;  // channels share their rays
        variance += scale * sum * sum;
    }
    if (mean > 0.0) noise.meanError = std::sqrt(variance) / values / mean;
    return noise;
}

RayCount PathTracer::rays() const {
    return impl_->rays;
}

std::size_t PathTracer::surfacePixels() const {
    return impl_->surfacePixels;
}

HostImage PathTracer::read(Output output) const {
    const Impl& impl = *impl_;
    const glm::vec3 none(0.0f);
    const auto emission = [&](const Surface& s) { return impl.settings.emission ? s.emission : glm::vec3(0.0f); };
    const auto direct = [&](std::size_t i, const Surface& s) { return s.albedo / kPi * impl.direct[i] + emission(s); };
    const auto indirect = [&](std::size_t i, const Surface& s) { return s.albedo / kPi * impl.indirect(i); };
    switch (output) {
        case Output::DirectIrradiance:
            return impl.image(none, [&](std::size_t i, const Surface&) { return impl.direct[i]; });
        case Output::IndirectIrradiance:
            return impl.image(none, [&](std::size_t i, const Surface&) { return impl.indirect(i); });
        case Output::Direct:
            return impl.image(impl.settings.background, direct);
        case Output::Indirect:
            return impl.image(none, indirect);
        case Output::Color:
            return impl.image(impl.settings.background,
                              [&](std::size_t i, const Surface& s) { return direct(i, s) + indirect(i, s); });
        case Output::Display:
            break;
    }
    throw UsageError("the path tracer has no display picture");
}

HostImage PathTracer::albedo() const {
    return impl_->image(glm::vec3(0.0f), [](std::size_t, const Surface& s) { return s.albedo; });
}

HostImage PathTracer::normalWs() const {
    return impl_->image(glm::vec3(0.0f), [](std::size_t, const Surface& s) { return s.normal; });
}

HostImage PathTracer::depth() const {
    HostImage result(PixelFormat::R32F, impl_->settings.extent);
    for (std::size_t i = 0; i < impl_->surfaces.size(); ++i)
        if (impl_->surfaces[i]) result.pixel(0, 0)[i] = impl_->camera.depth(impl_->surfaces[i]->position);
    return result;
}

void PathTracer::saveState(const std::string& path) const {
    writeSums(path, impl_->fingerprint, impl_->settings.extent, impl_->sums);
}

void PathTracer::loadState(const std::string& path) {
    impl_->sums = readSums(path, impl_->fingerprint, impl_->settings.extent);
}

}  // namespace earthshine::trace
