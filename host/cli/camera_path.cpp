#include "cli/camera_path.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "cli/options.hpp"
#include "earthshine/error.hpp"

namespace earthshine::cli {

namespace {

bool isJsonFile(const std::string& text) {
    return std::filesystem::path(text).extension() == ".json";
}

}  // namespace

PathChoice parsePath(const std::string& text) {
    PathChoice choice;
    const auto colon = text.find(':');
    const std::string word = text.substr(0, colon), rest = colon == std::string::npos ? "" : text.substr(colon + 1);
    const bool hasRest = colon != std::string::npos;
    if (word == "orbit") {
        choice.kind = PathKind::Orbit;
        if (hasRest) choice.degreesPerFrame = double(parseFloat(rest, -360, 360, "degrees a frame"));
    } else if (word == "animation") {
        choice.kind = PathKind::Animation;
        if (hasRest && rest.empty()) throw UsageError("'animation:' lacks the animation's name or number");
        choice.animation = rest;
    } else if (isJsonFile(text)) {
        choice.kind = PathKind::Keys;
        choice.file = text;
    } else {
        throw UsageError(
            fmt::format("'{}' is none of orbit[:DEGREES_PER_FRAME], animation[:NAME], a file of key frames that ends "
                        "in .json",
                        text));
    }
    return choice;
}

SunPathChoice parseSunPath(const std::string& text) {
    SunPathChoice choice;
    if (isJsonFile(text)) {
        choice.file = text;
        return choice;
    }
    const std::vector<std::string> numbers = splitCommas(text);
    if (numbers.size() != 2)
        throw UsageError(
            fmt::format("'{}' is neither AZIMUTH,ELEVATION (degrees a frame), as in 0.25,-0.1, nor a file "
                        "of key frames that ends in .json",
                        text));
    choice.azimuthDegPerFrame = double(parseFloat(numbers[0], -360, 360, "degrees a frame"));
    choice.elevationDegPerFrame = double(parseFloat(numbers[1], -360, 360, "degrees a frame"));
    return choice;
}

glm::dvec3 orbitPivot(const Camera& camera, const raster::Scene& scene) {
    constexpr double kLeastOfDiagonal = 0.05, kOtherwiseOfDiagonal = 0.25;
    constexpr double kLeastM = 1e-3;  // a scene without extent
    const glm::dmat4 worldFromView = glm::inverse(glm::dmat4(camera.viewFromWorld));
    const glm::dvec3 eye(worldFromView[3]);
    const glm::dvec3 forward = -glm::normalize(glm::dvec3(worldFromView[2]));
    const glm::dvec3 boundsMin(scene.boundsMin), boundsMax(scene.boundsMax);
    const double diagonal = std::max(glm::length(boundsMax - boundsMin), kLeastM);
    double distance = glm::dot(0.5 * (boundsMin + boundsMax) - eye, forward);
    if (distance < kLeastOfDiagonal * diagonal) distance = kOtherwiseOfDiagonal * diagonal;
    return eye + distance * forward;
}

Camera orbited(const Camera& start, const glm::dvec3& pivotWs, double degrees) {
    const glm::dmat4 toPivot = glm::translate(glm::dmat4(1.0), pivotWs);
    const glm::dmat4 fromPivot = glm::translate(glm::dmat4(1.0), -pivotWs);
    // View from the world as it was, from the world turned back.
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), -glm::radians(degrees), glm::dvec3(0.0, 1.0, 0.0));
    return {glm::mat4(glm::dmat4(start.viewFromWorld) * (toPivot * turn * fromPivot)), start.clipFromView};
}

raster::Sun movedSun(const raster::Sun& start, const SunPathChoice& path, double frames) {
    double azimuthDeg = double(start.azimuthDeg) + frames * path.azimuthDegPerFrame;
    double elevationDeg = std::remainder(double(start.elevationDeg) + frames * path.elevationDegPerFrame, 360.0);
    if (std::abs(elevationDeg) > 90.0) {
        elevationDeg = std::copysign(180.0, elevationDeg) - elevationDeg;
        azimuthDeg += 180.0;
    }
    raster::Sun sun = start;
    sun.azimuthDeg = float(azimuthDeg);
    sun.elevationDeg = float(elevationDeg);
    return sun;
}

}  // namespace earthshine::cli
