// kernels/common/lanes.clh and vec3.clh: every helper gives at every width what it gives a single number.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "compute/probe.hpp"
#include "kernels/probe_params.h"

namespace earthshine {
namespace {

class Lanes : public testing::TestWithParam<reference::Variant> {};

TEST_P(Lanes, HelpersAgreeWithScalars) {
    // 7 items of 16 lanes, an odd number for every width.
    constexpr std::size_t kCount = 112;
    std::mt19937 random(5);
    std::vector<float> a(kCount), b(kCount);
    const auto uniform = [&] { return float(random() >> 8) * 0x1p-23f - 1.0f; };
    for (std::size_t i = 0; i < kCount; ++i) {
        a[i] = uniform();
        b[i] = i % 9 == 0 ? a[i] : uniform();  // equal ones too
        // Some items hold no lane that anyLane() looks for.
        if (i / 16 % 2 == 1) a[i] = std::min(a[i], 0.7f);
    }
    const Device device = test::openWithProbes(GetParam());
    Kernel kernel(device, "lanes_probe");
    const cl::Buffer out = device.impl().makeBuffer(LANES_ROWS * kCount * sizeof(float));
    const cl::Buffer inA = test::upload(device, a), inB = test::upload(device, b);
    kernel.set("inA", inA).set("inB", inB).set("outRows", out);
    kernel.setParams("params", ProbeParams{0, int(kCount), 0, 0});
    kernel.enqueue({int(kCount), 1});
    const std::vector<float> rows = test::download<float>(device, out, LANES_ROWS * kCount);

    const auto lanes = std::size_t(GetParam().options.lanes);
    for (std::size_t i = 0; i < kCount; ++i) {
        SCOPED_TRACE(i);
        const auto row = [&](std::size_t r) { return rows[r * kCount + i]; };
        const auto begin = a.begin() + std::ptrdiff_t(i / lanes * lanes), end = begin + std::ptrdiff_t(lanes);
        const double x = double(a[i]), y = double(b[i]), z = double(a[i] - b[i]);
        EXPECT_EQ(row(LANES_SELECT), a[i] < b[i] ? a[i] : b[i]);
        EXPECT_EQ(row(LANES_SELECT_AND), (a[i] >= b[i] && a[i] > 0.0f) || a[i] < -0.5f ? a[i] : b[i]);
        EXPECT_EQ(row(LANES_ANY), std::any_of(begin, end, [](float v) { return v > 0.75f; }) ? 1.0f : 0.0f);
        float sum = 0.0f;  // lane by lane in order, as sumLanes does
        for (auto v = begin; v != end; ++v) sum += *v;
        EXPECT_EQ(row(LANES_SUM), sum);
        EXPECT_EQ(row(LANES_INDEX), float(i % lanes));
        EXPECT_EQ(row(LANES_BITS), -a[i]);
        EXPECT_EQ(row(LANES_TO_INT), float(int(a[i] * 100.0f)));
        EXPECT_EQ(row(LANES_SELECT_INT), a[i] < b[i] ? float(int(a[i] * 100.0f)) : 7.0f);
        EXPECT_EQ(row(LANES_MAD), a[i] * 2.0f + b[i]);  // doubling is exact: fused or not, one rounding
        EXPECT_EQ(row(LANES_SATURATE), a[i] > 0.6f ? 0.0f : std::clamp(2.0f * a[i], 0.0f, 1.0f));  // NaN is 0
        EXPECT_EQ(row(LANES_SATURATE_INFINITE), a[i] > 0.0f ? 1.0f : 0.0f);
        EXPECT_NEAR(double(row(LANES_RECIP)) * (x + 1.5), 1.0, 4e-7);  // 3 ulp and the sum's own
        // 1e-6: a handful of roundings of numbers below 4; whether they are fused is the compiler's choice.
        EXPECT_NEAR(double(row(LANES_DOT3)), x * y + y * y + z * x, 1e-6);
        EXPECT_EQ(row(LANES_SELECT3), a[i] < b[i] ? a[i] - b[i] : a[i]);
        EXPECT_NEAR(double(row(LANES_ROW)), x + 2.0 * y + 3.0 * z + 4.0, 2e-6);
        EXPECT_NEAR(double(row(LANES_LUMINANCE)), 0.2126 * x + 0.7152 * y + 0.0722 * z, 1e-6);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Lanes, testing::ValuesIn(test::laneVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
