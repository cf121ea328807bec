#pragma once
// A sequence of frames: what moves from one to the next.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/camera_path.hpp"
#include "cli/key_frames.hpp"
#include "cli/options.hpp"
#include "cli/raster_settings.hpp"
#include "raster/scene/animator.hpp"

namespace earthshine::cli {

struct SequenceArguments {
    int frameCount = 1;
    std::optional<int> warmup;  ///< frames; see warmupCount()
    int firstFrame = 0;
    float framesPerSecond = 30.0f;
    std::string path;             ///< "" = the camera stands still
    std::string sunPath;          ///< "" = the sun stands still
    std::string animate = "off";  ///< "off", "on" or an animation's name or number
    std::string film;             ///< "" = none

    /// How often the first frame is rendered ahead of the sequence. One of several frames is, unless told otherwise:
    /// the first launch of a kernel compiles it.
    int warmupCount() const { return warmup.value_or(frameCount > 1 ? 1 : 0); }
};

void addSequenceOptions(Options& options, SequenceArguments& arguments);

/// As the report shows it.
nlohmann::ordered_json sequenceJson(const SequenceArguments& arguments);

/// What a frame is drawn with, besides where the scene's instances are.
struct SequenceFrame {
    Camera camera;
    std::vector<Light> lights;
};

class Sequence {
public:
    /// Reads what the arguments name. Throws UsageError for arguments that do not go together, InputError as
    /// readKeyFrames.
    explicit Sequence(const SequenceArguments& arguments);

    /// Poses the scene, which must outlive this, for frame 0. Throws UsageError if it has not what the arguments name,
    /// InputError if a frame has no camera (key_frames.hpp).
    void begin(raster::Scene& scene, const RasterSettings& settings);

    /// Poses the scene for a frame. What does not move keeps its bits from frame to frame. After begin().
    const SequenceFrame& frame(int index);

    /// The instances of the scene that frame() moves.
    std::vector<int> movedInstances() const;

private:
    Camera cameraOf(int index) const;
    raster::LightOptions lightOptions(int index) const;
    void chooseSun();

    SequenceArguments arguments_;
    RasterSettings settings_;
    PathChoice path_;
    SunPathChoice sunPath_;
    KeyFrames keys_;  ///< of --path; its suns are those of --sun-path if that is a file
    bool animates_ = false, movesSun_ = false;
    std::string animation_;  ///< name or number; "" = all

    raster::Scene* scene_ = nullptr;
    std::optional<raster::Animator> animator_;
    std::vector<raster::WorldBox> reach_;
    Camera start_;
    glm::dvec3 pivotWs_{0.0};
    std::optional<raster::Sun> sun_;  ///< at frame 0
    SequenceFrame frame_;
};

}  // namespace earthshine::cli
