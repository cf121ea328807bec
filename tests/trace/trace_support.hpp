#pragma once
// Scenes whose light is known, and what tests ask of pictures.

#include "raster/raster_support.hpp"
#include "raster/trace/path_tracer.hpp"

namespace earthshine::trace::test {

using namespace raster::test;

/// A scene of data/, by its file name.
raster::Scene dataScene(const std::string& file);

/// A sphere around `centre`, fronts inside, smooth normals, `segments` around and half as many up; with a spot at its
/// centre that looks down (intensity 100 cd, cone 30 to 50 degrees). Its one bounce is the same everywhere:
///   E1 = sum Phi / (4 pi R^2),  sum Phi = albedo x 100 cd x (the cone's solid angle weighed by its falloff).
struct Furnace {
    raster::Scene scene;
    std::vector<Light> lights;
    Camera camera;  ///< looks up and sideways from inside, at lit and unlit parts
    double firstBounceLux = 0;
};
Furnace furnace(float albedo, double radiusM, const glm::dvec3& centre, Extent extent, int segments = 256);

/// Of an RGBA32F picture over the pixels with w = 1, all three channels.
double meanOf(const HostImage& image);

/// The smallest and the largest value of the first channel over the pixels with w = 1.
glm::dvec2 rangeOf(const HostImage& image);

/// A tracer with samples in it.
PathTracer traced(const raster::Scene& scene, const Camera& camera, const std::vector<Light>& lights,
                  const TraceSettings& settings, int samples);

}  // namespace earthshine::trace::test
