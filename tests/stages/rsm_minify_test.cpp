// rsm_minify's records against the reference, one by one; the flux of a map stays what it was.

#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "compute/device_impl.hpp"
#include "interop/host_transport.hpp"
#include "reference/device_variants.hpp"
#include "reference/frame_reference.hpp"
#include "reference/synthetic_frame.hpp"
#include "stages/rsm_minify_stage.hpp"

namespace earthshine {
namespace {

class RsmMinify : public testing::TestWithParam<reference::Variant> {};

TEST_P(RsmMinify, RecordsAreThoseOfTheReference) {
    if (GetParam().options.rsmRecords == 0) return;  // the pipeline refuses (FrameStages)
    Device device(GetParam().caps, GetParam().options);
    RsmMinifyStage stage(device);
    HostTransport transport(device);
    for (const int sizePx : {1, 12, 13}) {
        reference::SyntheticOptions options;
        options.extent = {1, 1};
        options.rsmSizePx = sizePx;
        const FrameImages images = reference::makeSyntheticFrame(options);
        const FrameInputs frame = images.inputs();
        FrameSurfaces inputs;
        transport.enqueue(frame, inputs);
        for (const int factor : {1, 2, 4, 8}) {
            SCOPED_TRACE(testing::Message() << sizePx << " px by " << factor);
            const std::uint32_t seed = std::uint32_t(7 * factor);
            stage.enqueue(inputs.rsm, inputs.lights, {sizePx, options.lightCount, factor, seed});
            const std::size_t blocks = std::size_t(minifiedSizePx(sizePx, factor)), count = blocks * blocks;
            std::vector<RsmRecord> records(count * std::size_t(options.lightCount));
            device.impl().queue.enqueueReadBuffer(inputs.rsm.records, CL_TRUE, 0, records.size() * sizeof(RsmRecord),
                                                  records.data());
            for (std::size_t l = 0; l < frame.lights.size(); ++l) {
                const auto texels = reference::vpls(frame.lights[l], frame.lightMaps[l]);
                const auto expected = reference::minified(texels, sizePx, factor, int(l), seed);
                ASSERT_EQ(expected.size(), count);
                glm::dvec3 before(0.0), after(0.0);
                const double error = 1e-5 + reference::surfaceRounding(GetParam());
                for (const reference::Vpl& texel : texels) before += texel.flux;
                for (std::size_t i = 0; i < count; ++i) {
                    SCOPED_TRACE(testing::Message() << "light " << l << ", block " << i);
                    const RsmRecord& r = records[l * count + i];
                    const glm::dvec3 flux(r.fluxR, r.fluxG, r.fluxB);
                    after += flux;
                    // 64 sums of floats; that of another texel would be off by a good part of it.
                    ASSERT_LE(glm::length(flux - expected[i].flux), error * glm::length(expected[i].flux));
                    if (expected[i].radius == 0.0) continue;  // nothing lit: nobody sees where
                    const glm::dvec3 position(r.positionX, r.positionY, r.positionZ);
                    // Coordinates of some 10 m in floats.
                    ASSERT_LT(glm::length(position - expected[i].position), 1e-4);
                    const auto snorm = [](u32 bits) { return double(std::int16_t(std::uint16_t(bits))) / 32767.0; };
                    const glm::dvec3 normal(snorm(r.normalXy), snorm(r.normalXy >> 16), snorm(r.normalZRadius));
                    ASSERT_LT(glm::length(normal - expected[i].normal), 1e-4);  // 16 bits
                    // A half of 11 bits.
                    ASSERT_NEAR(double(floatFromHalf(std::uint16_t(r.normalZRadius >> 16))), expected[i].radius,
                                1e-3 * expected[i].radius);
                }
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], error * before[c]);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, RsmMinify, testing::ValuesIn(reference::allVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
