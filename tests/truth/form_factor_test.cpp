// The truths themselves: closed form, quadrature of the definition and the literature's number agree.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

#include "truth/form_factor.hpp"

namespace earthshine::truth {
namespace {

// The literature gives six digits, quadrature is good to some 1e-7.
constexpr double kSame = 1e-6;

const Rectangle kSquare{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};  // front towards +z

TEST(FormFactor, ParallelUnitSquaresAtDistanceOne) {
    EXPECT_NEAR(parallelRectangles(1, 1), 0.199825, kSame);
    EXPECT_NEAR(meanByQuadrature({{0, 1, 1}, {1, 0, 0}, {0, -1, 0}}, kSquare), 0.199825, kSame);
}

TEST(FormFactor, UnitSquaresWithACommonEdgeAtRightAngles) {
    EXPECT_NEAR(perpendicularRectangles(1, 1), 0.200044, kSame);
    EXPECT_NEAR(meanByQuadrature({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, kSquare), 0.200044, kSame);
}

TEST(FormFactor, PointUnderTheCornerOfAParallelSquare) {
    EXPECT_NEAR(pointUnderCorner(1, 1), 0.138532, kSame);
    EXPECT_NEAR(pointByQuadrature({0, 0, 1}, {0, 0, -1}, kSquare), 0.138532, kSame);
}

TEST(FormFactor, PointAcrossTheEndOfACommonEdge) {
    EXPECT_NEAR(pointAcrossEdge(1, 1), 0.055734, kSame);
    EXPECT_NEAR(pointByQuadrature({0, 0, 1}, {1, 0, 0}, kSquare), 0.055734, kSame);
}

TEST(FormFactor, ClosedFormsHoldForOtherProportions) {
    const Rectangle oblong{{0, 0, 0}, {2, 0, 0}, {0, 0.5, 0}};
    EXPECT_NEAR(meanByQuadrature({{0, 0.5, 0.8}, {2, 0, 0}, {0, -0.5, 0}}, oblong),
                parallelRectangles(2 / 0.8, 0.5 / 0.8), kSame);
    EXPECT_NEAR(pointByQuadrature({0, 0, 0.8}, {0, 0, -1}, oblong), pointUnderCorner(2 / 0.8, 0.5 / 0.8), kSame);
    // The common edge is the side of 0.5: from a rectangle that stands 1.5 high.
    EXPECT_NEAR(meanByQuadrature({{0, 0, 0}, {0, 0.5, 0}, {0, 0, 1.5}}, oblong),
                perpendicularRectangles(2 / 0.5, 1.5 / 0.5), kSame);
    EXPECT_NEAR(pointByQuadrature({0, 0, 1.5}, {1, 0, 0}, oblong), pointAcrossEdge(2 / 0.5, 1.5 / 0.5), kSame);
}

// cos cos / (pi d^2) between any two points inside a sphere is 1 / (4 pi R^2): a lit patch lights all of it alike.
TEST(FormFactor, InsideASphereAllPairsAreAlike) {
    std::mt19937 random(7);
    const auto direction = [&] {
        glm::dvec3 v;
        do {
            for (int c = 0; c < 3; ++c) v[c] = 2.0 * double(random()) / 4294967296.0 - 1.0;
        } while (glm::length(v) > 1.0 || glm::length(v) < 0.1);
        return glm::normalize(v);
    };
    const double radius = 1.7;
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 a = direction(), b = direction(), d = radius * (b - a);
        const double d2 = glm::dot(d, d);
        const double value = glm::dot(-a, d) * glm::dot(b, d) / (std::numbers::pi * d2 * d2);
        EXPECT_NEAR(value * 4.0 * std::numbers::pi * radius * radius, 1.0, 1e-9);
    }
}

}  // namespace
}  // namespace earthshine::truth
