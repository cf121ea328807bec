#include "raster/camera_fit.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "earthshine/error.hpp"

namespace earthshine::raster {

namespace {

double aspectOf(Extent extent) {
    if (extent.widthPx < 1 || extent.heightPx < 1)
        throw UsageError(fmt::format("a picture of {}x{} has no pixels", extent.widthPx, extent.heightPx));
    return double(extent.widthPx) / extent.heightPx;
}

}  // namespace

const SceneCamera* findCamera(const Scene& scene, std::string_view which) {
    if (which.empty()) return scene.cameras.empty() ? nullptr : &scene.cameras.front();
    for (const SceneCamera& camera : scene.cameras)
        if (camera.name == which) return &camera;
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), index);
    if (error == std::errc() && end == which.data() + which.size() && index < scene.cameras.size())
        return &scene.cameras[index];
    std::string names;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        names += fmt::format("{}{} \"{}\"", i ? ", " : "", i, scene.cameras[i].name);
    throw UsageError(fmt::format("{}: there is no camera \"{}\"; there is {}", scene.name, which,
                                 names.empty() ? "none, leave it out for a view of everything" : names));
}

Camera cameraFor(const Scene& scene, std::string_view which, Extent extent) {
    const double aspect = aspectOf(extent);
    const SceneCamera* found = findCamera(scene, which);
    if (!found) return defaultView(scene, extent);
    const SceneCamera& source = *found;
    const double near = double(source.nearM);
    const double far = double(source.farM);
    glm::dmat4 clipFromView;
    if (!source.perspective) {
        const double halfHeight = double(source.halfHeightM);
        const double halfWidth = halfHeight * aspect;
        clipFromView = glm::ortho(-halfWidth, halfWidth, -halfHeight, halfHeight, near, far);
    } else if (far > 0.0) {
        clipFromView = glm::perspective(double(source.verticalFov), aspect, near, far);
    } else {
        clipFromView = glm::infinitePerspective(double(source.verticalFov), aspect, near);
    }
    return {glm::mat4(glm::inverse(glm::dmat4(source.worldFromView))), glm::mat4(clipFromView)};
}

Camera defaultView(const Scene& scene, Extent extent) {
    constexpr double kVerticalFov = 0.75;  // about a 50 mm lens on 35 mm film, upright
    constexpr double kRoom = 1.05;         // around the scene
    const double tanY = std::tan(0.5 * kVerticalFov);
    const double tanX = tanY * aspectOf(extent);
    const glm::dvec3 toCamera = glm::normalize(glm::dvec3(0.5, 0.4, 1.0));
    const glm::dvec3 boundsMin(scene.boundsMin);
    const glm::dvec3 boundsMax(scene.boundsMax);
    const glm::dvec3 centre = 0.5 * (boundsMin + boundsMax);
    const glm::dvec3 half = glm::max(0.5 * (boundsMax - boundsMin), 1e-3);

    // The least distance at which each corner of the bounds is within the picture.
    const glm::dmat4 viewFromCentred = glm::lookAt(glm::dvec3(0.0), -toCamera, glm::dvec3(0, 1, 0));
    double distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const glm::dvec3 p(viewFromCentred * glm::dvec4(sign * half, 1.0));
        distance = std::max({distance, p.z + std::abs(p.x) / tanX, p.z + std::abs(p.y) / tanY});
    }
    distance *= kRoom;
    const double radius = glm::length(half);
    const double near = std::max(distance - 1.01 * radius, 1e-3 * distance);
    return {glm::mat4(glm::lookAt(centre + distance * toCamera, centre, glm::dvec3(0, 1, 0))),
            glm::mat4(glm::perspective(kVerticalFov, aspectOf(extent), near, distance + 1.01 * radius))};
}

}  // namespace earthshine::raster
