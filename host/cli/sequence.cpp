#include "cli/sequence.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "earthshine/error.hpp"
#include "raster/camera_fit.hpp"

namespace earthshine::cli {

namespace {

constexpr int kMaxFrames = 100000;

}  // namespace

void addSequenceOptions(Options& options, SequenceArguments& arguments) {
    options.group("Sequence");
    options.option("--frames", "N", "1",
                   "frames of the sequence, numbered from 0; the same one over and over if nothing moves, to time it",
                   [&arguments](const std::string& text) { arguments.frameCount = parseInt(text, 1, kMaxFrames); });
    options.option("--first-frame", "K", "0",
                   "write and time from this frame on; those before are rendered all the same, because frames remember",
                   [&arguments](const std::string& text) { arguments.firstFrame = parseInt(text, 0, kMaxFrames); });
    options.option("--warmup", "N", "",
                   "render frame 0 this often ahead, neither written nor timed [1 for several frames, else 0]",
                   [&arguments](const std::string& text) { arguments.warmup = parseInt(text, 0, kMaxFrames); });
    options.option("--fps", "N", "30", "frames a second, of animations, keys that have times, and the film",
                   [&arguments](const std::string& text) {
                       arguments.framesPerSecond = parseFloat(text, 0.01, 1000, "frames a second");
                   });
    options.option(
        "--path", "PATH", "",
        "where the camera goes: orbit[:DEGREES_PER_FRAME], animation[:NAME] (the file's own), or a FILE.json "
        "of key frames (host/cli/key_frames.hpp) [it stands still]",
        [&arguments](const std::string& text) {
            parsePath(text);
            arguments.path = text;
        });
    options.option("--sun-path", "PATH", "",
                   "where the sun goes, from --sun or the scene's directional light: AZIMUTH,ELEVATION (degrees a "
                   "frame), or a FILE.json of key frames [it stands still]",
                   [&arguments](const std::string& text) {
                       parseSunPath(text);
                       arguments.sunPath = text;
                   });
    options.option("--animate", "on|off|NAME", "off",
                   "play the file's animations, all or one by name or number, with whatever camera",
                   [&arguments](const std::string& text) {
                       if (text.empty()) throw UsageError("must not be empty");
                       arguments.animate = text;
                   });
    options.text("--film", "FILE", arguments.film, "a film of the frames' PNGs (.mp4, .mkv, .mov or .webm), by ffmpeg");
}

nlohmann::ordered_json sequenceJson(const SequenceArguments& arguments) {
    return {{"frames", arguments.frameCount},
            {"firstFrame", arguments.firstFrame},
            {"warmup", arguments.warmupCount()},
            {"fps", arguments.framesPerSecond},
            {"path", arguments.path},
            {"sunPath", arguments.sunPath},
            {"animate", arguments.animate}};
}

Sequence::Sequence(const SequenceArguments& arguments) : arguments_(arguments) {
    if (arguments.firstFrame >= arguments.frameCount)
        throw UsageError(fmt::format("--first-frame: {} is beyond the last of {} frames, {}", arguments.firstFrame,
                                     arguments.frameCount, arguments.frameCount - 1));
    if (!arguments.path.empty()) path_ = parsePath(arguments.path);
    if (path_.kind == PathKind::Keys) keys_ = readKeyFrames(path_.file, double(arguments.framesPerSecond));
    movesSun_ = !keys_.sun.empty();
    if (!arguments.sunPath.empty()) {
        if (movesSun_)
            throw UsageError(fmt::format("--sun-path: the keys of {} move the sun already", path_.file.string()));
        sunPath_ = parseSunPath(arguments.sunPath);
        movesSun_ = true;
        if (!sunPath_.file.empty()) {
            keys_.sun = readKeyFrames(sunPath_.file, double(arguments.framesPerSecond)).sun;
            if (keys_.sun.empty())
                throw InputError(fmt::format("{}: none of its keys has a \"sun\"", sunPath_.file.string()));
        }
    }
    animates_ = arguments.animate != "off";
    if (animates_ && arguments.animate != "on") animation_ = arguments.animate;
    if (path_.kind == PathKind::Animation) {
        if (animates_ && animation_ != path_.animation)
            throw UsageError(
                fmt::format("--animate: '{}' is not what --path {} plays", arguments.animate, arguments.path));
        animates_ = true;
        animation_ = path_.animation;
    }
}

void Sequence::begin(raster::Scene& scene, const RasterSettings& settings) {
    scene_ = &scene;
    settings_ = settings;
    const raster::SceneCamera* source = raster::findCamera(scene, settings.camera);
    if (animates_) {
        animator_.emplace(scene, animation_);
        reach_ = animator_->sweptBounds(scene, double(arguments_.framesPerSecond));
        for (const raster::WorldBox& box : reach_) {
            scene.boundsMin = glm::min(scene.boundsMin, box.min);
            scene.boundsMax = glm::max(scene.boundsMax, box.max);
        }
        animator_->pose(scene, 0.0);
        if (path_.kind == PathKind::Animation && !(source && animator_->moves(source->node)))
            throw UsageError(fmt::format(
                "--path: the animation does not move the camera{}; --animate {} moves the "
                "rest without it",
                source ? fmt::format(" \"{}\"", source->name) : "", animation_.empty() ? "on" : animation_));
    }
    start_ = raster::cameraFor(scene, settings.camera, settings.size);
    pivotWs_ = orbitPivot(start_, scene);
    for (int i = 0; i < arguments_.frameCount; ++i) cameraOf(i);  // what throws throws now
    if (movesSun_) {
        chooseSun();
    } else {
        sun_ = settings.sun;
    }
    frame_.camera = start_;
    frame_.lights = raster::fitLights(scene, lightOptions(0));
}

void Sequence::chooseSun() {
    sun_ = settings_.sun;
    if (sun_) return;
    for (const raster::SceneLight& light : scene_->lights) {
        if (light.type != raster::SceneLightType::Directional) continue;
        if (sun_) throw UsageError("--sun-path: the scene has several directional lights; say with --sun where one is");
        sun_ = raster::sunOf(light);
    }
    if (!sun_) sun_.emplace();
}

Camera Sequence::cameraOf(int index) const {
    switch (path_.kind) {
        case PathKind::Orbit:
            return orbited(start_, pivotWs_, index * path_.degreesPerFrame);
        case PathKind::Keys:
            return keys_.camera.empty() ? start_ : cameraAt(keys_.camera, index, start_);
        case PathKind::Animation:
            return raster::cameraFor(*scene_, settings_.camera, settings_.size);
        case PathKind::Still:
            break;
    }
    return start_;
}

raster::LightOptions Sequence::lightOptions(int index) const {
    raster::LightOptions options{sun_, reach_, true};
    if (movesSun_) options.sun = keys_.sun.empty() ? movedSun(*sun_, sunPath_, index) : sunAt(keys_.sun, index, *sun_);
    return options;
}

const SequenceFrame& Sequence::frame(int index) {
    if (animator_) animator_->pose(*scene_, double(index) / double(arguments_.framesPerSecond));
    frame_.camera = cameraOf(index);
    if (movesSun_ || animator_) {
        raster::LightOptions options = lightOptions(index);
        options.logs = false;  // begin() said it all
        frame_.lights = raster::fitLights(*scene_, options);
    }
    return frame_;
}

std::vector<int> Sequence::movedInstances() const {
    return animator_ ? animator_->movedInstances() : std::vector<int>();
}

}  // namespace earthshine::cli
