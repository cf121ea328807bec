// Sets of pixels that share texels, at the level of their two stages: a picture in bands of rows is the picture at
// once.

#include <gtest/gtest.h>

#include <algorithm>

#include "interop/host_transport.hpp"
#include "pipeline/make_params.hpp"
#include "reference/device_variants.hpp"
#include "reference/synthetic_frame.hpp"
#include "stages/blue_noise.hpp"
#include "stages/frame_params.hpp"
#include "stages/rsm_choose_stage.hpp"
#include "stages/rsm_gather_coherent_stage.hpp"
#include "stages/rsm_pack_stage.hpp"
#include "support/surface_pixels.hpp"

namespace earthshine {
namespace {

class Coherent : public testing::TestWithParam<reference::Variant> {};

TEST_P(Coherent, BandsOfRowsAreThePicture) {
    const Device device(GetParam().caps, GetParam().options);
    HostTransport transport(device);
    RsmChooseStage choose(device);
    RsmGatherCoherentStage gather(device);
    constexpr int kSamples = 3;
    const cl::Buffer pattern = device.impl().upload(makeDiskPattern(kSamples));
    const cl::Buffer noise = device.impl().upload(makeRotationNoise());
    reference::SyntheticOptions options;
    options.extent = {70, 11};
    const FrameImages images = reference::makeSyntheticFrame(options);
    const FrameInputs frame = images.inputs();
    FrameSurfaces inputs;
    transport.enqueue(frame, inputs);
    if (device.tuning().rsmRecords) RsmPackStage(device).enqueue(inputs.rsm, inputs.lights);
    Settings settings;
    settings.sampleCount = kSamples;
    settings.rotation = Rotation::Coherent;
    const RsmChooseParams params = makeParams(settings, {makeViewRays(frame.camera, options.extent), options.extent,
                                                         inputs.rsm.sizePx, inputs.rsm.lightCount, inputs.shadowExtent})
                                       .choose;
    const auto inBandsOf = [&](int rows) {
        const Surface out(device, PixelFormat::RGBA32F, options.extent);
        const std::size_t size =
            choicesInRow(options.extent.widthPx, kSamples) * std::size_t(rows) * std::size_t(inputs.rsm.lightCount);
        const cl::Buffer choices = device.impl().makeBuffer(sizeof(RsmChoice) * size);
        for (int first = 0; first < options.extent.heightPx; first += rows) {
            RsmChooseParams band = params;
            band.firstRowPx = first;
            band.rowCount = std::min(rows, options.extent.heightPx - first);
            choose.enqueue({inputs.depth, inputs.lights, pattern, noise, choices}, band);
            gather.enqueue({inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights, choices, out}, band);
        }
        return test::readSurface(device, out);
    };
    const HostImage expected = inBandsOf(11);
    for (const int rows : {1, 4, 10}) {
        SCOPED_TRACE(rows);
        const HostImage actual = inBandsOf(rows);
        for (int i = 0; i < 70 * 11; ++i)
            for (int c = 0; c < 3; ++c)
                ASSERT_EQ(actual.pixel(0, 0)[4 * i + c], expected.pixel(0, 0)[4 * i + c]) << i % 70 << ", " << i / 70;
    }
    transport.release();
}

INSTANTIATE_TEST_SUITE_P(All, Coherent, testing::ValuesIn(reference::allVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
