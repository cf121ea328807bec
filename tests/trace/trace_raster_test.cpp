// The path tracer and the real-time halves look at one scene: the same surfaces at the same pixels, and the same light
// where they compute the same thing.

#include <algorithm>

#include <gmock/gmock.h>

#include "earthshine/pipeline.hpp"
#include "image/metrics.hpp"
#include "raster/camera_fit.hpp"
#include "raster/light_fit.hpp"
#include "raster/scene_renderer.hpp"
#include "reference/device_variants.hpp"
#include "trace/trace_support.hpp"

namespace earthshine::trace::test {
namespace {

/// The share of surface pixels, seen by both, where `differs(x, y)`.
template <class Differs>
double shareOf(const raster::test::HostFrame& frame, const PathTracer& tracer, Differs&& differs) {
    const HostImage depth = tracer.depth();
    const auto [width, height] = depth.extent();
    int both = 0, differing = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (*depth.pixel(x, y) == 0.0f || *frame.depth.pixel(x, y) == 0.0f) continue;
            ++both;
            differing += differs(x, y);
        }
    return double(differing) / both;
}

void expectSameSurfaces(const std::string& file, const std::string& cameraName, Extent extent, double edges) {
    const raster::Scene scene = dataScene(file);
    const Camera camera = raster::cameraFor(scene, cameraName, extent);
    const raster::test::HostFrame frame = drawScene(scene, camera, {extent});
    const auto tracer = traced(scene, camera, {}, {.extent = extent, .bounceCount = 0}, 0);
    const HostImage depth = tracer.depth(), albedo = tracer.albedo(), normal = tracer.normalWs();
    int sky = 0;
    for (int i = 0; i < extent.widthPx * extent.heightPx; ++i)
        sky += (depth.pixel(0, 0)[i] == 0.0f) != (frame.depth.pixel(0, 0)[i] == 0.0f);
    EXPECT_LE(sky, edges * extent.widthPx * extent.heightPx) << file;
    const auto far = [](const glm::vec4& a, const glm::vec4& b, float tolerance) {
        return glm::length(glm::vec3(a) - glm::vec3(b)) > tolerance;
    };
    // What a driver that rounds vertices to its grid may see beside the centre of a pixel: the step to a neighbour, the
    // smaller of both, so that it is of the same surface, times the share of a pixel. On a floor seen from the side
    // that is more than 24 bits. (All of the picture moved by as much has 0.127 of the atrium's pixels at other depths
    // without this, 0.040 with it, and 0.023 unmoved.)
    const double shiftPx = raster::test::subpixelShiftPx(sharedContext());
    const auto depthAt = [&](int x, int y) {
        return double(*depth.pixel(std::clamp(x, 0, extent.widthPx - 1), std::clamp(y, 0, extent.heightPx - 1)));
    };
    const auto isAtAnotherDepth = [&](int x, int y) {
        const double here = depthAt(x, y);
        const auto step = [&](int dx, int dy) {
            return std::min(std::abs(depthAt(x - dx, y - dy) - here), std::abs(depthAt(x + dx, y + dy) - here));
        };
        const double moved = shiftPx * (step(1, 0) + step(0, 1));
        return std::abs(double(*frame.depth.pixel(x, y)) - here) > 1e-4 * here + moved;
    };
    // Pixels on edges may see either side; all others agree but for 24 bits of depth and 11 of colour. Mipmaps are
    // chosen from differences to neighbours, which GL takes over blocks of 2 x 2 pixels.
    EXPECT_LE(shareOf(frame, tracer, isAtAnotherDepth), edges) << file;
    EXPECT_LE(
        shareOf(frame, tracer, [&](int x, int y) { return far(rgba(albedo, x, y), rgba(frame.albedo, x, y), 0.02f); }),
        2 * edges)
        << file;
    EXPECT_LE(shareOf(frame, tracer,
                      [&](int x, int y) { return far(rgba(normal, x, y), rgba(frame.normalWs, x, y), 0.04f); }),
              2 * edges)
        << file;
}

TEST(TraceAndRaster, SeeTheSameSurfaces) {
    expectSameSurfaces("cornell.glb", "", {97, 83}, 0.002);
    expectSameSurfaces("plates.glb", "both", {160, 90}, 0.002);
}

TEST(TraceAndRaster, SeeTheSameTexturedSurfaces) {
    expectSameSurfaces("atrium.glb", "court", {160, 90}, 0.03);
}

/// The full sum over the RSM, on the first device that works.
HostImage rsmSum(const raster::Scene& scene, const Camera& camera, const std::vector<Light>& lights, Extent extent,
                 int rsmSizePx) {
    raster::GlContext& context = sharedContext();
    raster::SceneRenderer renderer(context, scene);
    raster::RasterSettings settings;
    settings.extent = extent;
    settings.rsmSizePx = rsmSizePx;
    settings.shadowSizePx = 512;
    const GlFrame textures = renderer.render(camera, camera, lights, settings);
    const FrameImages images = readBack(textures, camera, lights, context.getProcAddress());
    const reference::Variant variant = reference::defaultVariants().at(0);
    Pipeline pipeline(Device(variant.caps, variant.options));
    pipeline.setFrame(images.inputs());
    Settings sum;
    sum.estimator = Estimator::Sum;
    pipeline.run(sum);
    return pipeline.read(Output::IndirectIrradiance);
}

TEST(TraceAndRaster, FullSumIsTheReferenceWithoutIndirectVisibility) {
    const raster::Scene scene = dataScene("cornell.glb");
    const Extent extent{64, 64};
    const Camera camera = raster::cameraFor(scene, "", extent);
    const std::vector<Light> lights = raster::fitLights(scene);
    const HostImage sum = rsmSum(scene, camera, lights, extent, 256);
    const auto tracer = traced(scene, camera, lights, {.extent = extent, .indirectVisibility = false}, 512);
    const PictureErrors errors = measureErrors(sum.view(), tracer.read(Output::IndirectIrradiance).view());
    RecordProperty("meanErrorPercent", std::to_string(100 * errors.meanError));
    RecordProperty("relMse", std::to_string(errors.relMse));
    RecordProperty("referenceNoiseRelMse", std::to_string(tracer.noise().relMse));
    // 3 %: the bar. What is left is the RSM's: texels on edges, discs in corners.
    EXPECT_NEAR(errors.meanError, 0.0, 0.03) << "relMSE " << errors.relMse;
    EXPECT_LT(errors.relMse, 0.004);
    // And the truth is another thing: without visibility there is too much light.
    const auto truth = traced(scene, camera, lights, {.extent = extent}, 64);
    const PictureErrors leak = measureErrors(sum.view(), truth.read(Output::IndirectIrradiance).view());
    RecordProperty("leakMeanErrorPercent", std::to_string(100 * leak.meanError));
    EXPECT_GT(leak.meanError, 0.05);
}

}  // namespace
}  // namespace earthshine::trace::test
