// history_check and history_confidence, alone: against plain doubles, at sizes of less and of more than a work-group.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "interop/host_transport.hpp"
#include "reference/device_variants.hpp"
#include "stages/history_check_stage.hpp"

namespace earthshine {
namespace {

class HistoryCheck : public testing::TestWithParam<reference::Variant> {};

TEST_P(HistoryCheck, JudgesEveryTile) {
    const Device device(GetParam().caps, GetParam().options);
    HostTransport transport(device);
    HistoryCheckStage stage(device);
    // 128 items a group: 128 px of one lane, 2048 of 16.
    for (const Extent extent :
         {Extent{1, 1}, Extent{16, 16}, Extent{17, 33}, Extent{129, 5}, Extent{513, 40}, Extent{2081, 18}}) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        std::mt19937 random(5);
        const Extent tiles = HistoryCheckStage::tiles(extent);
        HostImage change(PixelFormat::R32F, extent);
        std::vector<std::array<double, 2>> sums(std::size_t(tiles.widthPx * tiles.heightPx));
        for (int y = 0; y < extent.heightPx; ++y) {
            for (int x = 0; x < extent.widthPx; ++x) {
                // Every third tile has changed by about as much as its noise.
                const int tile = y / CONFIDENCE_TILE_PX * tiles.widthPx + x / CONFIDENCE_TILE_PX;
                const double d = double(random()) / 4294967296.0 - (tile % 3 == 0 ? 0.25 : 0.5);
                *change.pixel(x, y) = float(d);
                sums[std::size_t(tile)][0] += d;
                sums[std::size_t(tile)][1] += d * d;
            }
        }
        const HistoryCheckParams params{2.0f, 60.0f, 0, 0};
        const auto confidenceOf = [&](const std::array<double, 2>& s) {
            const double ratio = s[1] > 0.0 ? s[0] * s[0] / s[1] : 0.0;
            return std::clamp((60.0 - ratio) / 58.0, 0.0, 1.0);
        };
        const Surface surface(device, PixelFormat::R32F, extent);
        transport.enqueueImage(change.view(), surface, 0);
        std::vector<float> actual(sums.size());
        const cl::Buffer confidence = device.impl().makeBuffer(sizeof(float) * actual.size());
        stage.enqueue({surface, confidence}, params);
        device.impl().queue.enqueueReadBuffer(confidence, CL_TRUE, 0, sizeof(float) * actual.size(), actual.data());
        transport.release();
        for (int j = 0; j < tiles.heightPx; ++j) {
            for (int i = 0; i < tiles.widthPx; ++i) {
                std::array<double, 2> around{};
                for (int y = std::max(j - 1, 0); y <= std::min(j + 1, tiles.heightPx - 1); ++y)
                    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, tiles.widthPx - 1); ++x)
                        for (std::size_t k = 0; k < 2; ++k) around[k] += sums[std::size_t(y * tiles.widthPx + x)][k];
                const auto at = std::size_t(j * tiles.widthPx + i);
                // Sums of 2304 floats of either sign, whose own are some 1e-5 exact.
                ASSERT_NEAR(double(actual[at]), std::min(confidenceOf(sums[at]), confidenceOf(around)), 1e-4)
                    << i << ", " << j;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, HistoryCheck, testing::ValuesIn(reference::quickVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
