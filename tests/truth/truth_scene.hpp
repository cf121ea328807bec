#pragma once
// Scenes made of a few rectangles or a sphere, seen squarely, and what the whole path makes of them: OpenGL draws the
// G-buffer and the reflective shadow maps, transport `host` carries them over, the pipeline gathers.

#include <string>

#include "earthshine/pipeline.hpp"
#include "raster/scene_renderer.hpp"
#include "truth/form_factor.hpp"

namespace earthshine::truth {

/// Adds a Lambertian rectangle; a ray that meets its back goes through, unless it is double-sided.
void addRectangle(raster::Scene& scene, const Rectangle& rectangle, double albedo, bool isDoubleSided = false);

/// Adds a Lambertian sphere around the origin, seen from inside, so fine that its flatness can be neglected.
void addSphere(raster::Scene& scene, double radiusM, double albedo);

/// Sees just the rectangle, squarely from its front.
Camera squareView(const Rectangle& rectangle);

/// Sees a square millimetre around a point, from where `normal` points: every pixel is that point.
Camera pointView(const glm::dvec3& point, const glm::dvec3& normal);

/// A beam squarely onto the rectangle's front; its map is a square of `mapSideM` around the rectangle's centre.
Light beamOnto(const Rectangle& rectangle, double lux, double mapSideM);

/// A spot whose map has the full angle `mapAngle` (rad).
Light spot(const glm::dvec3& position, const glm::dvec3& target, double candela, double innerConeAngle,
           double outerConeAngle, double mapAngle);

/// Integral of the cone's falloff over all directions, sr: the spot's luminous flux for one candela.
double coneIntegral(const Light& spot);

/// A scene in OpenGL, in the context createContext("auto") that all of these share.
class DrawnScene {
public:
    explicit DrawnScene(const raster::Scene& scene);
    /// Draws a frame and reads it back.
    FrameImages draw(const Camera& camera, Extent extent, const Light& light, int rsmSizePx);

private:
    raster::SceneRenderer renderer_;
};

/// An output of a frame.
HostImage compute(Pipeline& pipeline, const FrameImages& frame, const Settings& settings,
                  Output output = Output::IndirectIrradiance);

/// Settings of the full sum, and of the disk with a radius that covers the map from any point, the same every frame.
Settings fullSum();
Settings wholeDisk(int sampleCount, double radiusUv = 1.4142136);

/// First channel of all pixels, none of which may be sky: smallest, mean, largest.
struct Statistics {
    double min, mean, max;
};
Statistics statisticsOf(const HostImage& image);
double meanOf(const HostImage& image);

/// Sum of the RSM's flux (first channel), lm.
double totalFlux(const FrameImages& frame);

/// Expects measured / truth - 1 within the bar, and leaves it in the test's report (--gtest_output=xml) as `what`.
void expectTruth(const std::string& what, double measured, double truth, double bar);

}  // namespace earthshine::truth
