#pragma once
// Where the camera of a sequence goes, and what --path and --sun-path mean.

#include <filesystem>
#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "earthshine/frame.hpp"
#include "raster/light_fit.hpp"
#include "raster/scene/scene.hpp"

namespace earthshine::cli {

enum class PathKind { Still, Orbit, Keys, Animation };

struct PathChoice {
    PathKind kind = PathKind::Still;
    double degreesPerFrame = 1.0;  ///< orbit
    std::string animation;         ///< name or number; "" = all
    std::filesystem::path file;    ///< keys
};

/// "orbit[:DEGREES_PER_FRAME]", "animation[:NAME]" or "FILE.json". Throws UsageError.
PathChoice parsePath(const std::string& text);

struct SunPathChoice {
    double azimuthDegPerFrame = 0.0, elevationDegPerFrame = 0.0;
    std::filesystem::path file;  ///< of key frames; "" = the degrees count
};

/// "AZIMUTH,ELEVATION" (degrees a frame) or "FILE.json". Throws UsageError.
SunPathChoice parseSunPath(const std::string& text);

/// The point that an orbit goes around, on the view axis: where it comes nearest to the middle of the scene's bounds,
/// or, if that is behind the camera or close, a quarter of their diagonal ahead.
glm::dvec3 orbitPivot(const Camera& camera, const raster::Scene& scene);

/// The camera turned about the vertical axis through `pivotWs`, counter-clockwise as seen from above (+y).
Camera orbited(const Camera& start, const glm::dvec3& pivotWs, double degrees);

/// The sun after some frames of a steady motion. Beyond the zenith it goes down on the other side.
raster::Sun movedSun(const raster::Sun& start, const SunPathChoice& path, double frames);

}  // namespace earthshine::cli
