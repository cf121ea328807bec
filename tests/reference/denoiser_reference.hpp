#pragma once
// The denoiser again in doubles: temporal.cl, history_confidence.cl, atrous.cl; and walls in motion to try it on.

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "earthshine/pipeline.hpp"

namespace earthshine::reference {

double luminanceOf(const glm::dvec3& c);

/// Where a camera went from its first place, in that place's view space.
using Move = glm::dmat4;

/// Two walls at an angle and another far behind, some sky: what a filter must keep apart. Lights and maps are the
/// synthetic frame's. The walls slide along themselves by a fraction of a pixel a frame (but for a block that stands,
/// if asked for), or stand while the camera has gone from where `before` puts it to `now`.
struct Walls {
    Extent extent;
    bool slides = true;
    bool hasStandingBlock = false;
    Move before{1.0}, now{1.0};
    bool isRough = false;  ///< normals turned by up to a radian, each pixel's own way
};

FrameImages wallsFrame(const Walls& walls);

struct Memory {
    std::vector<glm::dvec3> irradiance;
    std::vector<double> length;
    std::vector<double> moment;  ///< mean squared luminance
    std::vector<double> change;  ///< luminance: the sample, as limited, less the mean
};

struct Temporal {
    double maxFrames = 32.0;
    double fireflyFactor = 0.0;  ///< 0 = none
    double antiLag = 0.0;        ///< 0 = off
    bool weighsTurn = true;      ///< taps that are turned count for less
};

/// temporal.cl. `before` is the frame that left `past`.
Memory accumulate(const FrameImages& f, const FrameImages& before, const Memory& past,
                  const std::vector<glm::dvec3>& now, const Temporal& t);

/// One pass of atrous.cl; without `memory`, history is of one frame.
std::vector<glm::dvec3> filterPass(const FrameImages& f, const std::vector<glm::dvec3>& in, const Settings& settings,
                                   int radiusX, int radiusY, int step, const Memory* memory = nullptr);

}  // namespace earthshine::reference
