#include "raster/light_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "earthshine/error.hpp"
#include "earthshine/log.hpp"

namespace earthshine::raster {

namespace {

constexpr double kMargin = 1e-4;         // of a map's side: far below half a texel of any map
constexpr double kFloatSlack = 2e-7;     // of the largest coordinate: the view matrix is rounded to floats
constexpr double kSmallestSideM = 1e-6;  // a scene seen edge-on still has a map
constexpr double kWidestConeDeg = 85.0;  // a perspective map of 170 degrees is 23 times as wide as it is deep
constexpr double kNearOfFar = 1e-3;      // keeps the depth buffer good to a ten-thousandth of the reach

struct Box {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};
    double largestCoordinate = 0.0;  ///< of world and box space
};

/// The bounds of all vertices and of `reach` in another space; a unit cube around the origin of the world if there are
/// none.
Box sceneBounds(const Scene& scene, std::span<const WorldBox> reach, const glm::dmat4& spaceFromWorld) {
    Box box;
    const auto add = [&](const glm::dvec3& position) {
        box.min = glm::min(box.min, position);
        box.max = glm::max(box.max, position);
    };
    for (const Instance& instance : scene.instances) {
        const glm::dmat4 spaceFromObject = spaceFromWorld * glm::dmat4(instance.worldFromObject);
        for (const Vertex& vertex : scene.meshes[std::size_t(instance.mesh)].vertices)
            add(glm::dvec3(spaceFromObject * glm::dvec4(vertex.position, 1.0)));
        box.largestCoordinate =
            std::max(box.largestCoordinate, double(glm::length(glm::vec3(instance.worldFromObject[3]))));
    }
    for (const WorldBox& place : reach) {
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 positionWs((corner & 1) ? place.max.x : place.min.x,
                                        (corner & 2) ? place.max.y : place.min.y,
                                        (corner & 4) ? place.max.z : place.min.z);
            add(glm::dvec3(spaceFromWorld * glm::dvec4(positionWs, 1.0)));
            box.largestCoordinate = std::max(box.largestCoordinate, glm::length(positionWs));
        }
    }
    if (!(box.min.x <= box.max.x)) {
        add(glm::dvec3(spaceFromWorld[3]) - 0.5);
        add(glm::dvec3(spaceFromWorld[3]) + 0.5);
    }
    for (const glm::dvec3& corner : {box.min, box.max})
        box.largestCoordinate = std::max(box.largestCoordinate, glm::length(corner));
    return box;
}

/// The rotation of a rigid matrix, free of what rounding to floats did to it.
glm::dmat3 rotationOf(const glm::mat4& worldFromLight) {
    const glm::dmat3 m(worldFromLight);
    const glm::dvec3 z = glm::normalize(m[2]);
    const glm::dvec3 x = glm::normalize(m[0] - z * glm::dot(z, m[0]));
    return {x, glm::cross(z, x), z};
}

Camera directionalCamera(const Scene& scene, std::span<const WorldBox> reach, const glm::dmat3& worldFromLight) {
    const glm::dmat4 lightFromWorld(glm::transpose(worldFromLight));
    const Box box = sceneBounds(scene, reach, lightFromWorld);
    const glm::dvec3 margin = kMargin * (box.max - box.min) + kFloatSlack * box.largestCoordinate + kSmallestSideM;
    const glm::dvec3 half = 0.5 * (box.max - box.min) + margin;
    // The camera stands above the middle of the box, far enough that every depth is positive.
    const glm::dvec3 centre = 0.5 * (box.min + box.max);
    const glm::dvec3 eye(centre.x, centre.y, centre.z + half.z + margin.z);
    return {glm::mat4(glm::translate(glm::dmat4(1.0), -eye) * lightFromWorld),
            glm::mat4(glm::ortho(-half.x, half.x, -half.y, half.y, margin.z, margin.z + 2.0 * half.z))};
}

Light directionalLight(const Scene& scene, std::span<const WorldBox> reach, const std::string& name,
                       const glm::vec3& lux, const glm::dmat3& worldFromLight) {
    Light light;
    light.name = name;
    light.type = LightType::Directional;
    light.intensity = lux;
    light.camera = directionalCamera(scene, reach, worldFromLight);
    return light;
}

Light spotLight(const Scene& scene, const LightOptions& options, const SceneLight& source) {
    Light light;
    light.name = source.name;
    light.type = LightType::Spot;
    light.intensity = source.intensity;
    light.innerConeAngle = source.innerConeAngle;
    light.outerConeAngle = source.outerConeAngle;
    light.rangeM = source.rangeM;

    const glm::dmat3 rotation = rotationOf(source.worldFromLight);
    const glm::dvec3 position(source.worldFromLight[3]);
    const glm::dmat4 lightFromWorld = glm::dmat4(glm::transpose(rotation)) * glm::translate(glm::dmat4(1.0), -position);
    const Box box = sceneBounds(scene, options.reach, lightFromWorld);
    double far = (1.0 + kMargin) * -box.min.z + kFloatSlack * box.largestCoordinate;
    if (source.rangeM > 0.0f) far = std::min(far, double(source.rangeM));
    far = std::max(far, kSmallestSideM);  // everything lies behind the light
    double halfAngle = double(source.outerConeAngle);
    if (halfAngle > glm::radians(kWidestConeDeg)) {
        if (options.logs)
            log(LogLevel::Warning,
                fmt::format("light \"{}\": its cone reaches {:.1f} degrees from the axis, its map only {:.0f}",
                            source.name, glm::degrees(halfAngle), kWidestConeDeg));
        halfAngle = glm::radians(kWidestConeDeg);
    }
    light.camera.viewFromWorld = glm::mat4(lightFromWorld);
    light.camera.clipFromView = glm::mat4(glm::perspective(2.0 * halfAngle, 1.0, kNearOfFar * far, far));
    return light;
}

}  // namespace

glm::vec3 directionToSun(const Sun& sun) {
    if (!std::isfinite(sun.azimuthDeg) || !(std::abs(sun.elevationDeg) <= 90.0f))
        throw UsageError(
            fmt::format("a sun at azimuth {} and elevation {}: give degrees, the elevation within -90 to 90",
                        sun.azimuthDeg, sun.elevationDeg));
    if (!(sun.lux >= 0.0f) || !std::isfinite(sun.lux))
        throw UsageError(fmt::format("a sun of {} lux: give a number that is not negative", sun.lux));
    const double azimuth = glm::radians(double(sun.azimuthDeg));
    const double elevation = glm::radians(double(sun.elevationDeg));
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), -std::cos(azimuth) * std::cos(elevation)};
}

Sun sunOf(const SceneLight& light) {
    const glm::dvec3 toSun = rotationOf(light.worldFromLight)[2];
    Sun sun;
    sun.azimuthDeg = float(glm::degrees(std::atan2(toSun.x, -toSun.z)));
    sun.elevationDeg = float(glm::degrees(std::asin(glm::clamp(toSun.y, -1.0, 1.0))));
    sun.lux = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
    if (sun.lux > 0.0f) sun.color = light.intensity / sun.lux;
    return sun;
}

Light sunLight(const Sun& sun, const Scene& scene, std::span<const WorldBox> reach) {
    const auto z = glm::normalize(glm::dvec3(directionToSun(sun)));
    // The map's x stays level, so that it turns with the azimuth, also for a sun in the zenith.
    const double azimuth = glm::radians(double(sun.azimuthDeg));
    const glm::dvec3 x(-std::cos(azimuth), 0.0, -std::sin(azimuth));
    return directionalLight(scene, reach, "sun", sun.lux * sun.color, {x, glm::cross(z, x), z});
}

std::vector<Light> fitLights(const Scene& scene, const LightOptions& options) {
    std::vector<Light> lights;
    if (options.sun) lights.push_back(sunLight(*options.sun, scene, options.reach));
    int pointLights = 0;
    for (const SceneLight& source : scene.lights) {
        switch (source.type) {
            case SceneLightType::Directional:
                if (!options.sun)
                    lights.push_back(directionalLight(scene, options.reach, source.name, source.intensity,
                                                      rotationOf(source.worldFromLight)));
                break;
            case SceneLightType::Spot:
                lights.push_back(spotLight(scene, options, source));
                break;
            case SceneLightType::Point:
                ++pointLights;
                break;
        }
    }
    if (pointLights > 0 && options.logs)
        log(LogLevel::Warning, fmt::format("{} point light{} not drawn: a light needs a direction to have a map, use "
                                           "spot lights",
                                           pointLights, pointLights == 1 ? " is" : "s are"));
    if (lights.empty()) {
        const Sun sun;
        if (options.logs)
            log(LogLevel::Info,
                fmt::format("the scene has no light that can be drawn: a sun of {:.0f} lx shines from azimuth {:.0f}, "
                            "elevation {:.0f} degrees",
                            sun.lux, sun.azimuthDeg, sun.elevationDeg));
        lights.push_back(sunLight(sun, scene, options.reach));
    }
    return lights;
}

}  // namespace earthshine::raster
