// Motion vectors against projections in double precision.

#include <gtest/gtest.h>

#include "earthshine/error.hpp"
#include "raster/raster_support.hpp"

namespace earthshine::raster::test {
namespace {

constexpr Extent kExtent{191, 347};

// What halves can hold (Mesa truncates: one unit of 11 bits), and what a temporal filter can see: 1e-3 px.
double tolerancePx(double motionPx) {
    return 1e-3 + 0x1p-10 * std::abs(motionPx);
}

struct Moves {
    Camera camera, previousCamera;
    glm::mat4 worldFromObject{1}, previousWorldFromObject{1};
};

// Every pixel of a quad: back onto the surface by the drawn depth, then to where that point was.
void expectMotion(const Moves& moves, Extent extent) {
    SceneRenderer renderer(sharedContext(), quadScene(diffuse(glm::vec3(0.5f)), moves.previousWorldFromObject));
    renderer.render(moves.previousCamera, moves.previousCamera, {}, {extent});
    renderer.setWorldFromObject(0, moves.worldFromObject);
    const HostFrame frame =
        readFrame(sharedContext(), renderer.render(moves.camera, moves.previousCamera, {}, {extent}));
    const glm::dmat4 previousFromNow =
        glm::dmat4(moves.previousWorldFromObject) * glm::inverse(glm::dmat4(moves.worldFromObject));
    const glm::dmat4 worldFromView = glm::inverse(glm::dmat4(moves.camera.viewFromWorld));
    const glm::dmat4 viewFromObject = glm::dmat4(moves.camera.viewFromWorld) * glm::dmat4(moves.worldFromObject);
    const glm::dvec3 planePoint(viewFromObject[3]);
    const glm::dvec3 planeNormal = glm::cross(glm::dvec3(viewFromObject[0]), glm::dvec3(viewFromObject[1]));
    int seen = 0;
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            if (*frame.depth.pixel(x, y) == 0.0f) continue;
            ++seen;
            const glm::dvec3 ray = pixelRayVs(moves.camera, extent, x + 0.5, y + 0.5);
            const double depth = glm::dot(planePoint, planeNormal) / glm::dot(ray, planeNormal);
            const glm::dvec4 previousWs = previousFromNow * (worldFromView * glm::dvec4(ray * depth, 1.0));
            const glm::dvec2 expected =
                projectPx(moves.previousCamera, extent, glm::dvec3(previousWs)) - glm::dvec2(x + 0.5, y + 0.5);
            const double previousDepth = -(glm::dmat4(moves.previousCamera.viewFromWorld) * previousWs).z;
            const glm::vec4 motion = rgba(frame.motion, x, y);
            ASSERT_NEAR(double(motion.x), expected.x, tolerancePx(expected.x)) << x << ", " << y;
            ASSERT_NEAR(double(motion.y), expected.y, tolerancePx(expected.y)) << x << ", " << y;
            // Depths are good to 1e-5 of themselves, their difference to halves.
            ASSERT_NEAR(double(motion.z), previousDepth - depth,
                        1e-5 * depth + 0x1p-10 * std::abs(previousDepth - depth))
                << x << ", " << y;
        }
    }
    EXPECT_GT(seen, extent.widthPx * extent.heightPx / 3);
}

const glm::mat4 kPlaced =
    glm::scale(glm::rotate(glm::translate(glm::mat4(1), {0.2f, 0.1f, -1}), -0.9f, {1, 0.2f, 0}), glm::vec3(4, 6, 2));

TEST(RasterMotion, OfAMovedCamera) {
    for (const Extent extent : {Extent{7, 3}, kExtent}) {
        const Camera camera = lookAtCamera({1, 2, 6}, {0, 0, 0}, extent);
        for (const glm::dvec3& from : {glm::dvec3(1.001, 2, 6), glm::dvec3(1.1, 1.8, 6.3), glm::dvec3(-1, 2, 7)})
            expectMotion({camera, lookAtCamera(from, {0.1, 0, 0}, extent), kPlaced, kPlaced}, extent);
        expectMotion({camera, lookAtCamera({1, 2, 6}, {0, 0, 0}, extent, 0.8), kPlaced, kPlaced}, extent);  // zoomed
    }
}

TEST(RasterMotion, OfAMovedInstance) {
    const Camera camera = lookAtCamera({1, 2, 6}, {0, 0, 0}, kExtent);
    const glm::mat4 turned = glm::rotate(kPlaced, 0.05f, {0.1f, 0.2f, 1});
    const glm::mat4 grown = glm::scale(glm::translate(kPlaced, {0.01f, 0.02f, 0.1f}), {1.1f, 0.9f, 1});
    for (const glm::mat4& before : {turned, grown}) expectMotion({camera, camera, kPlaced, before}, kExtent);
}

TEST(RasterMotion, OfBothTogether) {
    const Camera camera = lookAtCamera({1, 2, 6}, {0, 0, 0}, kExtent);
    const Camera previous = lookAtCamera({1.2, 2.1, 6}, {0, 0.1, 0}, kExtent);
    expectMotion({camera, previous, kPlaced, glm::rotate(kPlaced, 0.05f, {0.1f, 0.2f, 1})}, kExtent);
}

// Far from the origin floats are 0.06 m apart, and products of float matrices no better; the motion must not know. The
// reference takes the matrices as they are, rounded to floats.
TEST(RasterMotion, FarFromTheOriginIsAsGood) {
    const glm::dvec3 far(524288, 0, -524288);
    const Camera camera = lookAtCamera(far + glm::dvec3(1, 2, 6), far, kExtent);
    const Camera previous = lookAtCamera(far + glm::dvec3(1.25, 2, 6), far, kExtent);
    const glm::mat4 placed = glm::translate(glm::mat4(1), glm::vec3(far)) * kPlaced;
    expectMotion({camera, previous, placed, placed}, kExtent);
}

TEST(RasterMotion, StandingStillIsExactlyZero) {
    const Camera camera = lookAtCamera({1, 2, 6}, {0, 0, 0}, kExtent);
    SceneRenderer renderer(sharedContext(), quadScene(diffuse(glm::vec3(0.5f)), kPlaced));
    for (int step = 0; step < 3; ++step) {
        // It moves before the second frame, and stands in the third.
        if (step == 1) renderer.setWorldFromObject(0, glm::rotate(kPlaced, 0.05f, {0, 0, 1}));
        const HostFrame frame = readFrame(sharedContext(), renderer.render(camera, camera, {}, {kExtent}));
        float most = 0.0f;
        for (int y = 0; y < kExtent.heightPx; ++y)
            for (int x = 0; x < kExtent.widthPx; ++x)
                for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(rgba(frame.motion, x, y)[c]));
        if (step == 1)
            EXPECT_GT(most, 1.0f);
        else
            EXPECT_EQ(most, 0.0f);
    }
}

TEST(RasterMotion, FromBehindTheCameraLeavesThePicture) {
    const Extent extent{3, 3};
    const Camera camera = lookAtCamera({0, 0, 3}, {0, 0, 0}, extent);
    const Camera previous = lookAtCamera({0, 0, -3}, {0, 0, -9}, extent);
    SceneRenderer renderer(sharedContext(), quadScene(diffuse(glm::vec3(0.5f))));
    const HostFrame frame = readFrame(sharedContext(), renderer.render(camera, previous, {}, {extent}));
    const glm::vec4 motion = rgba(frame.motion, 1, 1);
    EXPECT_TRUE(std::isfinite(motion.x) && std::isfinite(motion.y));
    EXPECT_GT(std::abs(motion.x), 1e4f);
    EXPECT_LT(*frame.depth.pixel(1, 1) + motion.z, 0.0f);
}

TEST(RasterMotion, NoSuchInstanceIsAUsageError) {
    SceneRenderer renderer(sharedContext(), quadScene(diffuse(glm::vec3(0.5f))));
    EXPECT_THROW(renderer.setWorldFromObject(1, glm::mat4(1)), UsageError);
    EXPECT_THROW(renderer.setWorldFromObject(-1, glm::mat4(1)), UsageError);
}

}  // namespace
}  // namespace earthshine::raster::test
