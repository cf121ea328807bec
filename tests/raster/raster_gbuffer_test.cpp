// The camera's G-buffer against geometry and colours that are known exactly.

#include <gtest/gtest.h>

#include "raster/raster_support.hpp"

namespace earthshine::raster::test {
namespace {

Scene quadScene(const Material& material, const glm::mat4& worldFromObject = glm::mat4(1)) {
    Scene scene;
    scene.materials = {material};
    scene.meshes = {unitQuad(0)};
    scene.instances = {{0, worldFromObject}};
    return scene;
}

// An infinite plane, tilted, seen by a tilted camera: the depth of every pixel by intersecting its ray in doubles.
TEST(RasterGBuffer, LinearDepthIsThatOfThePlane) {
    for (const Extent extent : {Extent{1, 1}, Extent{7, 3}, Extent{191, 347}}) {
        const glm::mat4 worldFromObject =
            glm::scale(glm::rotate(glm::mat4(1), 0.4f, glm::vec3(1, 0.5f, 0.2f)), glm::vec3(40));
        const Camera camera = lookAtCamera({1, 3, 9}, {0.3, -0.2, 0.1}, extent);
        Material material = diffuse(glm::vec3(0.5f));
        material.doubleSided = true;
        const HostFrame frame = drawScene(quadScene(material, worldFromObject), camera, {extent});

        const glm::dmat4 viewFromObject = glm::dmat4(camera.viewFromWorld) * glm::dmat4(worldFromObject);
        const glm::dvec3 point(viewFromObject[3]);
        const glm::dvec3 normal = glm::cross(glm::dvec3(viewFromObject[0]), glm::dvec3(viewFromObject[1]));
        double worst = 0.0;
        int hits = 0;
        for (int y = 0; y < extent.heightPx; ++y) {
            for (int x = 0; x < extent.widthPx; ++x) {
                const double depth = double(*frame.depth.pixel(x, y));
                if (depth == 0.0) continue;
                const glm::dvec3 ray = pixelRayVs(camera, extent, x + 0.5, y + 0.5);
                const double expected = glm::dot(point, normal) / glm::dot(ray, normal);
                worst = std::max(worst, std::abs(depth / expected - 1.0));
                ++hits;
            }
        }
        EXPECT_EQ(hits, extent.widthPx * extent.heightPx);
        // 1e-5: what positions need to be good for self-shadowing rays; floats interpolated across a triangle reach it.
        EXPECT_LT(worst, 1e-5) << extent.widthPx << "x" << extent.heightPx;
    }
}

}  // namespace
}  // namespace earthshine::raster::test
