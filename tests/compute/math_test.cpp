// kernels/common/math.clh against the standard library in doubles, at every width: the errors that it states.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "compute/probe.hpp"
#include "kernels/probe_params.h"

namespace earthshine {
namespace {

using reference::Variant;

enum Function { kExp2, kLog2, kExp, kPow, kSinTau, kCosTau };

class Math : public testing::TestWithParam<Variant> {
protected:
    // Computes function(x, y) for all x on the device.
    std::vector<float> evaluate(Function function, std::vector<float> x, std::vector<float> y = {}) {
        const std::size_t count = x.size();
        x.resize((count + 15) / 16 * 16, 1.0f);
        y.resize(x.size(), 1.0f);
        const cl::Buffer out = device_.impl().makeBuffer(x.size() * sizeof(float));
        const cl::Buffer inX = test::upload(device_, x), inY = test::upload(device_, y);
        kernel_.set("inX", inX).set("inY", inY).set("outValues", out);
        kernel_.setParams("params", ProbeParams{function, int(x.size()), 0, 0});
        kernel_.enqueue({int(x.size()), 1});
        return test::download<float>(device_, out, count);
    }

    // Expects |function(x) - reference(x)| <= bound(x, reference(x)) everywhere.
    void expectWithin(Function function, const std::vector<float>& x, const std::function<double(double)>& reference,
                      const std::function<double(double, double)>& bound) {
        const std::vector<float> actual = evaluate(function, x);
        double worst = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double expected = reference(double(x[i])), limit = bound(double(x[i]), expected);
            const double error = std::fabs(double(actual[i]) - expected);
            worst = std::max(worst, error / limit);
            ASSERT_LE(error, limit) << "x = " << x[i] << ": " << actual[i] << ", not " << expected;
        }
        RecordProperty("share_of_the_bound", std::to_string(worst));
    }

    Device device_ = test::openWithProbes(GetParam());
    Kernel kernel_{device_, "math_probe"};
};

// The range's ends, and 2^16 numbers spread evenly between them.
std::vector<float> sweep(double low, double high) {
    constexpr int kSteps = 1 << 16;
    std::vector<float> x;
    for (int i = 0; i <= kSteps; ++i) x.push_back(float(low + (high - low) * i / kSteps));
    return x;
}

// Floats with random bits, of the exponents from 2^low to below 2^high.
std::vector<float> randomPositive(int low, int high) {
    std::mt19937 random(3);
    std::vector<float> x;
    for (int i = 0; i < 1 << 16; ++i)
        x.push_back(std::ldexp(1.0f + float(random() >> 9) * 0x1p-23f, low + int(random() % unsigned(high - low))));
    return x;
}

TEST_P(Math, Exp2) {
    const auto relative = [](double, double value) { return 2e-7 * value; };
    expectWithin(
        kExp2, sweep(-126, 127), [](double x) { return std::exp2(x); }, relative);
    expectWithin(
        kExp2, sweep(-0.51, 0.51), [](double x) { return std::exp2(x); }, relative);
    const std::vector<float> ends = evaluate(kExp2, {-126.001f, -1e30f, 128.0f, 1e30f, 0.0f, 1.0f, -1.0f});
    EXPECT_EQ(ends[0], 0.0f);
    EXPECT_EQ(ends[1], 0.0f);
    EXPECT_GT(ends[2], 3.4e38f);  // within 1e-5 of the largest float, and finite
    EXPECT_LE(ends[2], std::numeric_limits<float>::max());
    EXPECT_EQ(ends[3], ends[2]);
    EXPECT_EQ(ends[4], 1.0f);
    EXPECT_EQ(ends[5], 2.0f);
    EXPECT_EQ(ends[6], 0.5f);
}

TEST_P(Math, Log2) {
    const auto bound = [](double, double value) { return 3e-7 + 2e-7 * std::fabs(value); };
    expectWithin(
        kLog2, randomPositive(-126, 128), [](double x) { return std::log2(x); }, bound);
    expectWithin(
        kLog2, sweep(0.5, 2.0), [](double x) { return std::log2(x); }, bound);
    const std::vector<float> exact = evaluate(kLog2, {1.0f, 2.0f, 0x1p-126f, 0x1p127f});
    EXPECT_EQ(exact, (std::vector<float>{0.0f, 1.0f, -126.0f, 127.0f}));
}

TEST_P(Math, Exp) {
    // x log2(e) is rounded to 24 bits twice, as a constant and as a product: |x| 2^-23 of the result beside exp2's own.
    expectWithin(
        kExp, sweep(-87, 88), [](double x) { return std::exp(x); },
        [](double x, double value) { return (2e-7 + std::fabs(x) * 0x1p-23) * value; });
}

TEST_P(Math, Pow) {
    for (const float exponent : {1.0f / 2.4f, 2.4f, 0.5f, -1.0f, 16.0f}) {
        const std::vector<float> x = randomPositive(-6, 6);
        const std::vector<float> actual = evaluate(kPow, x, std::vector<float>(x.size(), exponent));
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double expected = std::pow(double(x[i]), double(exponent));
            // log2's error and the rounding of the product, in the exponent of 2: times ln 2, beside exp2's own.
            const double logarithm = std::fabs(std::log2(double(x[i])));
            const double inExponent = std::fabs(double(exponent)) * (3e-7 + (2e-7 + 0x1p-24) * logarithm);
            ASSERT_NEAR(double(actual[i]), expected, (2e-7 + std::numbers::ln2 * inExponent) * expected)
                << x[i] << "^" << exponent;
        }
    }
    EXPECT_EQ(evaluate(kPow, {0.0f, 0.0f, 1.0f}, {1.0f / 2.4f, 3.0f, 7.0f}), (std::vector<float>{0.0f, 0.0f, 1.0f}));
}

TEST_P(Math, SinAndCosOfTurns) {
    const auto sinTau = [](double x) { return std::sin(2.0 * std::numbers::pi * std::remainder(x, 1.0)); };
    const auto cosTau = [](double x) { return std::cos(2.0 * std::numbers::pi * std::remainder(x, 1.0)); };
    const auto sinBound = [](double, double) { return 3e-7; };
    // The quarter turn that makes a cosine of a sine is added in 32 bits: half a unit in the last place of x.
    const auto cosBound = [](double x, double) {
        return 3e-7 + 2.0 * std::numbers::pi * 0x1p-24 * std::max(1.0, std::fabs(x) + 0.25);
    };
    for (const double range : {1.0, 1024.0}) {
        expectWithin(kSinTau, sweep(-range, range), sinTau, sinBound);
        expectWithin(kCosTau, sweep(-range, range), cosTau, cosBound);
    }
    EXPECT_EQ(evaluate(kSinTau, {0.0f, 0.25f, -0.25f, 0.75f}), (std::vector<float>{0.0f, 1.0f, -1.0f, -1.0f}));
}

INSTANTIATE_TEST_SUITE_P(All, Math, testing::ValuesIn(test::laneVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
