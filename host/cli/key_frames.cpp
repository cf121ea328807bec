#include "cli/key_frames.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "earthshine/error.hpp"

namespace earthshine::cli {

namespace {

using Json = nlohmann::json;

constexpr std::uintmax_t kMaxFileBytes = 16u << 20;  // some 100 000 keys; more is some other file
constexpr double kMaxFrame = 1e7;
constexpr double kMinFovDeg = 1.0, kMaxFovDeg = 170.0;

/// A value and where it stands, for messages.
struct Place {
    const Json& value;
    std::string where;

    [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", where, what)); }

    bool has(const char* key) const { return value.contains(key); }
    Place at(const char* key) const { return {value[key], fmt::format("{}: {}", where, key)}; }

    void allowOnly(std::initializer_list<std::string_view> keys) const {
        if (!value.is_object()) fail(fmt::format("expected an object, found {}", value.type_name()));
        for (const auto& [key, item] : value.items())
            if (key != "comment" && std::find(keys.begin(), keys.end(), key) == keys.end())
                fail(fmt::format("unknown key \"{}\"; expected {}", key, fmt::join(keys, ", ")));
    }

    double number(double min, double max) const {
        if (!value.is_number()) fail(fmt::format("expected a number, found {}", value.type_name()));
        const double result = value.get<double>();
        if (!(result >= min && result <= max)) fail(fmt::format("{} is not in [{}; {}]", value.dump(), min, max));
        return result;
    }

    std::vector<double> numbers(std::size_t least, std::size_t most) const {
        if (!value.is_array() || value.size() < least || value.size() > most)
            fail(fmt::format("expected {}{} numbers, found {}", least, most > least ? fmt::format(" or {}", most) : "",
                             value.is_array() ? fmt::format("{}", value.size()) : value.type_name()));
        constexpr double kFar = 1e15;  // as far as the library takes numbers
        std::vector<double> result;
        for (std::size_t i = 0; i < value.size(); ++i)
            result.push_back(Place{value[i], fmt::format("{}[{}]", where, i)}.number(-kFar, kFar));
        return result;
    }

    glm::dvec3 point() const {
        const std::vector<double> xyz = numbers(3, 3);
        return {xyz[0], xyz[1], xyz[2]};
    }
};

CameraKey readCamera(const Place& place) {
    CameraKey key;
    if (!place.has("position")) place.fail("a camera needs a \"position\"");
    if (place.has("target") == place.has("rotation"))
        place.fail("a camera needs either a \"target\" or a \"rotation\"");
    key.position = place.at("position").point();
    if (place.has("target")) {
        key.target = place.at("target").point();
        if (*key.target == key.position) place.fail("the camera stands on its target");
    } else {
        const Place rotation = place.at("rotation");
        const std::vector<double> xyzw = rotation.numbers(4, 4);
        key.rotation = {xyzw[0], xyzw[1], xyzw[2], xyzw[3]};
        constexpr double kRounding = 1e-3;  // of four digits
        if (std::abs(glm::length(key.rotation) - 1.0) > kRounding) rotation.fail("is no rotation: its length is not 1");
        key.rotation = glm::normalize(key.rotation);
    }
    if (place.has("fov")) key.fovDeg = place.at("fov").number(kMinFovDeg, kMaxFovDeg);
    return key;
}

SunKey readSun(const Place& place) {
    const std::vector<double> numbers = place.numbers(2, 3);
    SunKey key;
    key.azimuthDeg = numbers[0];
    key.elevationDeg = numbers[1];
    if (std::abs(key.elevationDeg) > 90.0) place.fail(fmt::format("{} is not in [-90; 90] degrees", numbers[1]));
    if (numbers.size() > 2) key.lux = numbers[2];
    if (key.lux && !(*key.lux >= 0.0 && *key.lux <= 1e6))
        place.fail(fmt::format("{} is not in [0; 1e6] lux", *key.lux));
    return key;
}

Json parse(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(fmt::format("{}: no such file", file.string()));
    if (std::filesystem::file_size(file, error) > kMaxFileBytes)
        throw InputError(
            fmt::format("{}: larger than {} MiB; no file of key frames", file.string(), kMaxFileBytes >> 20));
    std::ifstream stream(file, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    if (!stream) throw InputError(fmt::format("{}: cannot be read", file.string()));
    try {
        return Json::parse(text.str());
    } catch (const Json::parse_error& e) {
        throw InputError(fmt::format("{}: is no JSON: byte {} makes no sense", file.string(), e.byte));
    } catch (const Json::exception&) {  // out_of_range: 1e999
        throw InputError(fmt::format("{}: is no JSON: a number is too large", file.string()));
    }
}

/// The last key at or before `frame`; the first one if there is none.
template <class Key>
std::size_t keyBefore(const std::vector<Key>& keys, double frame) {
    const auto after =
        std::upper_bound(keys.begin(), keys.end(), frame, [](double f, const Key& key) { return f < key.frame; });
    return after == keys.begin() ? 0 : std::size_t(after - keys.begin()) - 1;
}

/// Whether something moves from the key on to the next at `frame`.
template <class Key>
bool isBetween(const std::vector<Key>& keys, std::size_t key, double frame) {
    return key + 1 < keys.size() && !keys[key + 1].jumps && frame > keys[key].frame;
}

using Value = glm::dvec4 (*)(const CameraKey&);

/// The slope of the spline at a key: that of the parabola through it and its neighbours; at the end of a run of keys
/// that no jump parts, that of the straight line.
glm::dvec4 slopeAt(const std::vector<CameraKey>& keys, std::size_t key, Value value) {
    const auto slope = [&](std::size_t from) {
        return (value(keys[from + 1]) - value(keys[from])) / (keys[from + 1].frame - keys[from].frame);
    };
    const bool hasBefore = key > 0 && !keys[key].jumps;
    const bool hasAfter = key + 1 < keys.size() && !keys[key + 1].jumps;
    if (!hasBefore) return slope(key);
    if (!hasAfter) return slope(key - 1);
    const double before = keys[key].frame - keys[key - 1].frame, after = keys[key + 1].frame - keys[key].frame;
    return (slope(key - 1) * after + slope(key) * before) / (before + after);
}

glm::dvec4 splineAt(const std::vector<CameraKey>& keys, double frame, Value value) {
    const std::size_t key = keyBefore(keys, frame);
    if (!isBetween(keys, key, frame)) return value(keys[key]);
    const double span = keys[key + 1].frame - keys[key].frame;
    const double t = (frame - keys[key].frame) / span, t2 = t * t, t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * value(keys[key]) + span * (t3 - 2.0 * t2 + t) * slopeAt(keys, key, value) +
           (3.0 * t2 - 2.0 * t3) * value(keys[key + 1]) + span * (t3 - t2) * slopeAt(keys, key + 1, value);
}

/// World from view of a camera that looks along `forward`; where that is straight up or down, +y of the world gives no
/// up, and -z does.
glm::dmat3 lookAlong(const glm::dvec3& forward) {
    const glm::dvec3 z = -glm::normalize(forward);
    constexpr double kUpright = 1e-6;
    const glm::dvec3 level = glm::cross(glm::dvec3(0, 1, 0), z);
    const glm::dvec3 x = glm::normalize(glm::length(level) > kUpright ? level : glm::cross(glm::dvec3(0, 0, -1), z));
    return {x, glm::cross(z, x), z};
}

}  // namespace

KeyFrames readKeyFrames(const std::filesystem::path& file, double framesPerSecond) {
    const Json json = parse(file);
    const Place root{json, file.string()};
    root.allowOnly({"keys"});
    if (!root.has("keys") || !json["keys"].is_array() || json["keys"].empty()) root.fail("needs a list \"keys\"");
    KeyFrames result;
    double lastFrame = -1.0;
    for (std::size_t i = 0; i < json["keys"].size(); ++i) {
        const Place key{json["keys"][i], fmt::format("{}: keys[{}]", file.string(), i)};
        key.allowOnly({"frame", "time", "position", "target", "rotation", "fov", "sun", "step"});
        if (key.has("frame") == key.has("time")) key.fail("needs either a \"frame\" or a \"time\"");
        const double frame = key.has("frame") ? key.at("frame").number(0.0, kMaxFrame)
                                              : key.at("time").number(0.0, kMaxFrame) * framesPerSecond;
        if (!(frame > lastFrame)) key.fail("is not later than the key before it");
        lastFrame = frame;
        const bool hasStep = key.has("step");
        if (hasStep && !key.value["step"].is_boolean()) key.fail("\"step\" must be true or false");
        const bool jumps = hasStep && key.value["step"].get<bool>();
        const bool isCamera = key.has("position") || key.has("target") || key.has("rotation") || key.has("fov");
        if (!isCamera && !key.has("sun")) key.fail("holds neither a camera (\"position\") nor a \"sun\"");
        if (isCamera) {
            CameraKey camera = readCamera(key);
            camera.frame = frame;
            camera.jumps = jumps;
            if (!result.camera.empty()) {
                const CameraKey& before = result.camera.back();
                if (before.target.has_value() != camera.target.has_value())
                    key.fail("all cameras must have a \"target\", or all a \"rotation\"");
                if (before.fovDeg.has_value() != camera.fovDeg.has_value())
                    key.fail("all cameras must have a \"fov\", or none");
                if (glm::dot(before.rotation, camera.rotation) < 0.0) camera.rotation = -camera.rotation;
            }
            result.camera.push_back(camera);
        }
        if (key.has("sun")) {
            SunKey sun = readSun(key.at("sun"));
            sun.frame = frame;
            sun.jumps = jumps;
            if (!result.sun.empty() && result.sun.back().lux.has_value() != sun.lux.has_value())
                key.fail("all suns must have a lux, or none");
            result.sun.push_back(sun);
        }
    }
    return result;
}

Camera cameraAt(const std::vector<CameraKey>& keys, double frame, const Camera& start) {
    const glm::dvec3 position(
        splineAt(keys, frame, [](const CameraKey& key) { return glm::dvec4(key.position, 0.0); }));
    glm::dmat3 worldFromView;
    if (keys.front().target) {
        const glm::dvec3 target(
            splineAt(keys, frame, [](const CameraKey& key) { return glm::dvec4(*key.target, 0.0); }));
        if (!(glm::length(target - position) > 0.0))
            throw InputError(fmt::format("--path: at frame {} the camera stands on its target", frame));
        worldFromView = lookAlong(target - position);
    } else {
        const glm::dvec4 q = splineAt(keys, frame, [](const CameraKey& key) { return key.rotation; });
        // Neighbours are less than half a turn apart, but a spline swings: it might pass through zero.
        if (!(glm::length(q) > 1e-9))
            throw InputError(fmt::format("--path: at frame {} the rotations around it cancel each other", frame));
        worldFromView = glm::mat3_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
    }
    glm::dmat4 viewFromWorld(glm::transpose(worldFromView));
    viewFromWorld[3] = glm::dvec4(-(glm::transpose(worldFromView) * position), 1.0);
    Camera camera{glm::mat4(viewFromWorld), start.clipFromView};
    if (keys.front().fovDeg) {
        if (start.clipFromView[2][3] == 0.0f)
            throw InputError("--path: its cameras have a field of view, the scene's camera is orthographic");
        // A spline may overshoot its keys.
        const double fovDeg =
            glm::clamp(splineAt(keys, frame, [](const CameraKey& key) { return glm::dvec4(*key.fovDeg); }).x,
                       kMinFovDeg, kMaxFovDeg);
        const double scale = 1.0 / (std::tan(0.5 * glm::radians(fovDeg)) * double(start.clipFromView[1][1]));
        camera.clipFromView[0][0] = float(scale * double(start.clipFromView[0][0]));
        camera.clipFromView[1][1] = float(scale * double(start.clipFromView[1][1]));
    }
    return camera;
}

raster::Sun sunAt(const std::vector<SunKey>& keys, double frame, const raster::Sun& start) {
    const std::size_t key = keyBefore(keys, frame);
    const SunKey& from = keys[key];
    const SunKey& to = isBetween(keys, key, frame) ? keys[key + 1] : from;
    const double part = &to == &from ? 0.0 : (frame - from.frame) / (to.frame - from.frame);
    raster::Sun sun = start;
    sun.azimuthDeg = float(glm::mix(from.azimuthDeg, to.azimuthDeg, part));
    sun.elevationDeg = float(glm::mix(from.elevationDeg, to.elevationDeg, part));
    if (from.lux) sun.lux = float(glm::mix(*from.lux, *to.lux, part));
    return sun;
}

}  // namespace earthshine::cli
