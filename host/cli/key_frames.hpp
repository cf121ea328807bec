#pragma once
// Where a camera and a sun are over a sequence, from a JSON file of key frames:
//
//   {"keys": [{"frame": 0,  "position": [0, 1, 4], "target": [0, 1, 0], "fov": 40, "sun": [135, 50, 50000]},
//             {"frame": 32, "position": [2, 1, 4], "target": [0, 1, 0], "fov": 50},
//             {"time": 2.0, "sun": [225, 30], "step": true}]}
//
// frame     which frame, counted from 0; need not be whole. Or time: seconds, which --fps turns into frames. Each key
// is
//           later than the one before.
// position  of the camera, m, world space; with target (the point it looks at; +y is up), or with rotation (quaternion
// x,
//           y, z, w that turns the view axis -z and the view's up +y into the world). All cameras of a file have the
//           one or the other.
// fov       the camera's vertical field of view, degrees in [1; 170]; in all of them or in none: then the scene's
// camera
//           keeps its own.
// sun       azimuth, elevation (degrees; as for --sun, but any azimuth: 350 to 370 goes by north), and lux, which may
// be
//           left out: then it is that of the sun at the start.
// step      true: what this key holds jumps there, and stands still from the key before it until then.
//
// A key holds a camera, a sun or both; cameras and suns are interpolated apart. Cameras move on a Catmull-Rom spline
// (for keys at unequal distances as Barry and Goldman have it, 1988), rotations with each key's sign chosen the nearer
// to the key before, and then normalised; suns change linearly. Before the first key and after the last nothing moves.
// "comment" may stand in any object; any other key is an error.

#include <filesystem>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "earthshine/frame.hpp"
#include "raster/light_fit.hpp"

namespace earthshine::cli {

struct CameraKey {
    double frame = 0.0;
    bool jumps = false;
    glm::dvec3 position{0.0};
    std::optional<glm::dvec3> target;         ///< else rotation counts
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  ///< x, y, z, w; unit
    std::optional<double> fovDeg;
};

struct SunKey {
    double frame = 0.0;
    bool jumps = false;
    double azimuthDeg = 0.0, elevationDeg = 0.0;
    std::optional<double> lux;
};

struct KeyFrames {
    std::vector<CameraKey> camera;
    std::vector<SunKey> sun;
};

/// Throws InputError naming the file and the key for whatever is not as described above.
KeyFrames readKeyFrames(const std::filesystem::path& file, double framesPerSecond);

/// The camera at a frame; `keys` are not empty. The lens is `start`'s but for a field of view that the keys give.
/// Throws InputError if it stands on its target, or if there is a field of view and `start` is orthographic.
Camera cameraAt(const std::vector<CameraKey>& keys, double frame, const Camera& start);

/// The sun at a frame; `keys` are not empty. Colour, and lux if the keys have none, are `start`'s.
raster::Sun sunAt(const std::vector<SunKey>& keys, double frame, const raster::Sun& start);

}  // namespace earthshine::cli
