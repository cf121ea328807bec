#pragma once
// Lights as rays see them: what arrives at a point, and rays that carry the light away.

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "earthshine/frame.hpp"
#include "raster/trace/trace_scene.hpp"

namespace earthshine::trace {

/// What one light sends to a point, shadows aside.
struct Incident {
    glm::vec3 towards{0.0f};      ///< from the point to the light: unit for directional lights, else the whole way
    glm::vec3 direction{0.0f};    ///< the same, unit
    float tFar = 0.0f;            ///< of a ray along `towards` that ends at the light
    glm::vec3 illuminance{0.0f};  ///< lux across the beam
};

/// A light in trace space, with the falloffs of earthshine/frame.hpp.
class LightSource {
public:
    LightSource(const Light& light, const glm::dvec3& originWs);

    Incident incident(const glm::vec3& position) const;

    /// A ray of light within the light's map, and its share of the light. Rays are so distributed that each carries the
    /// same power but for the range's falloff: directional, evenly over the map; spot, over the cone as its intensity.
    /// False if it lies beyond the map.
    bool sampleRay(const glm::vec2& random, Ray& ray) const;

    /// How many of sampleRay's rays meet a surface at `position` for each m^2 of it. 0 beyond the map.
    float raysPerArea(const glm::vec3& position, const glm::vec3& geometricNormal) const;

    /// What all rays carry together for each unit of intensity, m^2 or sr, times the intensity's luminance.
    float power() const { return power_; }

private:
    bool isInMap(const glm::vec3& position) const;

    Light light_;
    glm::vec3 position_{0.0f};  ///< spot
    glm::dvec3 towards_{0.0f};  ///< unit, against the light's axis
    glm::dmat4 clipFromTrace_{1.0}, traceFromClip_{1.0};
    float raysMeasure_ = 0.0f;  ///< directional: m^2 of the map; spot: sr of the cone, weighed by its falloff
    float power_ = 0.0f;
};

/// All lights of a scene; one of them is drawn for each ray, the brighter the likelier.
class LightSources {
public:
    LightSources(std::span<const Light> lights, const glm::dvec3& originWs);

    std::span<const LightSource> all() const { return sources_; }
    float chance(std::size_t light) const { return chances_[light]; }
    /// The light that a number in [0; 1) draws.
    std::size_t draw(float random) const;
    bool empty() const { return sources_.empty(); }

private:
    std::vector<LightSource> sources_;
    std::vector<float> chances_;
};

}  // namespace earthshine::trace
