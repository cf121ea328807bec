#include "stages/frame_params.hpp"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <numbers>

namespace earthshine {

namespace {

f32x4 toF32x4(const glm::dvec4& v) {
    return {float(v.x), float(v.y), float(v.z), float(v.w)};
}

bool isOrthographic(const glm::dmat4& clipFromView) {
    return clipFromView[2][3] == 0.0;
}

// A projection times any positive number is the same projection: the one whose w is the depth, or 1.
glm::dmat4 normalised(const glm::mat4& clipFromView) {
    const glm::dmat4 p(clipFromView);
    return p / (isOrthographic(p) ? p[3][3] : -p[2][3]);
}

}  // namespace

ViewRays makeViewRays(const Camera& camera, Extent extent) {
    const glm::dmat4 worldFromView = glm::inverse(glm::dmat4(camera.viewFromWorld));
    const glm::dmat4 p = normalised(camera.clipFromView);
    // NDC of texel px: x = stepX px + firstX, y likewise with rows downwards.
    const double stepX = 2.0 / extent.widthPx, firstX = 1.0 / extent.widthPx - 1.0;
    const double stepY = -2.0 / extent.heightPx, firstY = 1.0 - 1.0 / extent.heightPx;
    const auto world = [&](double x, double y, double z, double w) {
        return toF32x4(worldFromView * glm::dvec4(x, y, z, w));
    };
    ViewRays rays{};
    if (isOrthographic(p)) {
        // x_ndc = p00 x + p30: the ray starts at x and runs along -z.
        rays.origin = world((firstX - p[3][0]) / p[0][0], (firstY - p[3][1]) / p[1][1], 0.0, 1.0);
        rays.originDx = world(stepX / p[0][0], 0.0, 0.0, 0.0);
        rays.originDy = world(0.0, stepY / p[1][1], 0.0, 0.0);
        rays.ray = world(0.0, 0.0, -1.0, 0.0);
    } else {
        // x_ndc = (p00 x + p20 z) / -z: at depth 1, x = (x_ndc + p20) / p00.
        rays.origin = world(0.0, 0.0, 0.0, 1.0);
        rays.ray = world((firstX + p[2][0]) / p[0][0], (firstY + p[2][1]) / p[1][1], -1.0, 0.0);
        rays.rayDx = world(stepX / p[0][0], 0.0, 0.0, 0.0);
        rays.rayDy = world(0.0, stepY / p[1][1], 0.0, 0.0);
    }
    return rays;
}

LightParams makeLightParams(const Light& light, Extent rsmExtent, Extent shadowExtent) {
    const glm::dmat4 viewFromWorld(light.camera.viewFromWorld);
    const glm::dmat4 worldFromView = glm::inverse(viewFromWorld);
    const glm::dmat4 clipFromView = normalised(light.camera.clipFromView);
    const glm::dmat4 rows = glm::transpose(clipFromView * viewFromWorld);
    LightParams params{};
    params.uRow = toF32x4(0.5 * (rows[3] + rows[0]));  // u = (x_ndc + 1) / 2
    params.vRow = toF32x4(0.5 * (rows[3] - rows[1]));  // v = (1 - y_ndc) / 2
    params.wRow = toF32x4(rows[3]);
    params.depthRow = toF32x4(-glm::transpose(viewFromWorld)[2]);
    params.towardsLight = toF32x4(worldFromView[2]);
    params.positionWs = toF32x4(worldFromView[3]);
    params.intensity = {light.intensity.x, light.intensity.y, light.intensity.z, 0.0f};
    params.type = light.type == LightType::Spot ? LIGHT_SPOT : LIGHT_DIRECTIONAL;
    const double cosOuter = std::cos(double(light.outerConeAngle));
    const double scale = 1.0 / std::max(std::cos(double(light.innerConeAngle)) - cosOuter, 1e-3);
    params.coneScale = float(scale);
    params.coneOffset = float(-cosOuter * scale);
    params.inverseRange = light.rangeM > 0.0f ? 1.0f / light.rangeM : 0.0f;
    const double halfX = 1.0 / clipFromView[0][0];
    const double halfY = 1.0 / clipFromView[1][1];
    params.shadowTexelSize =
        float(std::max(std::fabs(2.0 * halfX / shadowExtent.widthPx), std::fabs(2.0 * halfY / shadowExtent.heightPx)));
    params.rsmTexelArea = texelPowerOnAxis(light, rsmExtent);
    params.indirectScale = light.indirectScale;
    params.gatherRadiusUv = light.gatherRadiusUv;
    params.rsmRays = makeViewRays(light.camera, rsmExtent);
    return params;
}

std::vector<f32x4> makeDiskPattern(int count, DiskPattern kind) {
    std::vector<f32x4> pattern(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        // The radical inverse in base 2: the bits of i mirrored about the point.
        double inverse = 0.0;
        for (unsigned bits = unsigned(i), place = 1; bits != 0; bits >>= 1, ++place)
            if (bits & 1u) inverse += std::ldexp(1.0, -int(place));
        const double angle = kind == DiskPattern::Line ? 0.0 : 2.0 * std::numbers::pi * inverse;
        pattern[std::size_t(i)] = {float(std::cos(angle)), float(std::sin(angle)), float(std::numbers::pi / count),
                                   float(double(i) / count)};
    }
    return pattern;
}

FrameMove makeFrameMove(int index, int sampleCount) {
    constexpr double kPlastic = 1.32471795724474602596;  // x^3 = x + 1
    const auto fraction = [](double x) { return x - std::floor(x); };
    // Within a ring, not over the disk: a step of some irrational number over it would be nearly a whole number of
    // rings for some sample counts (the golden ratio's at 8), and the rings' gaps would fill slowly.
    // The centre's step shares no pattern with the other two.
    return {fraction(index / kPlastic) / sampleCount, fraction(index / (kPlastic * kPlastic)),
            fraction(index * std::numbers::sqrt2)};
}

}  // namespace earthshine
