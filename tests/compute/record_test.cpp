// Packed RSM texels: the transposition that gathers LANES records at once gives each lane its own, bit for bit.

#include <gtest/gtest.h>

#include <random>

#include "compute/probe.hpp"
#include "kernels/probe_params.h"
#include "rsm_pack_params.h"

namespace earthshine {
namespace {

class Records : public testing::TestWithParam<reference::Variant> {};

// The ten numbers of a texel as kernels/common/rsm.clh unpacks them.
std::array<float, 10> unpacked(const RsmRecord& r) {
    const auto snorm = [](u32 bits) { return float(std::int16_t(bits & 0xffffu)) * (1.0f / 32767.0f); };
    return {r.positionX,
            r.positionY,
            r.positionZ,
            r.fluxR,
            r.fluxG,
            r.fluxB,
            snorm(r.normalXy),
            snorm(r.normalXy >> 16),
            snorm(r.normalZRadius),
            floatFromHalf(std::uint16_t(r.normalZRadius >> 16))};
}

TEST_P(Records, EachLaneGetsItsOwnTexel) {
    constexpr int kSize = 13;
    constexpr std::size_t kCount = 16 * 11;
    std::mt19937 random(11);
    const auto number = [&] { return float(random() % 100000) / 7.0f - 5000.0f; };
    std::vector<RsmRecord> records(kSize * kSize);
    for (RsmRecord& r : records) {
        r = {number(), number(), number(), number(), number(), number(), u32(random()), 0};
        r.normalZRadius = u32(random() & 0xffffu) | u32(random() % 0x7c00u) << 16;  // halves from 0, denormals too
    }
    std::vector<int> x(kCount), y(kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        x[i] = int(random() % kSize);
        y[i] = int(random() % kSize);
    }
    const Device device = test::openWithProbes(GetParam());
    Kernel kernel(device, "record_probe");
    const cl::Buffer out = device.impl().makeBuffer(20 * kCount * sizeof(float));
    const cl::Buffer rsm = test::upload(device, records);
    const cl::Buffer inX = test::upload(device, x), inY = test::upload(device, y);
    kernel.set("rsm", rsm).set("inX", inX).set("inY", inY).set("outRows", out);
    kernel.setParams("params", ProbeParams{0, int(kCount), kSize, 0});
    kernel.enqueue({int(kCount), 1});
    const std::vector<float> rows = test::download<float>(device, out, 20 * kCount);

    const auto lanes = std::size_t(GetParam().options.lanes);
    const auto texelAt = [&](std::size_t i) { return unpacked(records[std::size_t(y[i] * kSize + x[i])]); };
    for (std::size_t i = 0; i < kCount; ++i) {
        for (std::size_t field = 0; field < 10; ++field) {
            ASSERT_EQ(rows[field * kCount + i], texelAt(i)[field]) << "item " << i << ", number " << field;
            ASSERT_EQ(rows[(10 + field) * kCount + i], texelAt(i / lanes * lanes)[field])
                << "uniform, item " << i << ", number " << field;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Records, testing::ValuesIn(test::laneVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
