#include "raster/scene/animation.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace earthshine::raster {

namespace {

glm::dquat quaternion(const glm::dvec4& xyzw) {
    return {xyzw.w, xyzw.x, xyzw.y, xyzw.z};
}

glm::dvec4 slerp(const glm::dvec4& from, const glm::dvec4& to, double part) {
    const glm::dquat q =
        glm::slerp(glm::normalize(quaternion(from)), glm::normalize(quaternion(to)), part);  // the shorter way
    return {q.x, q.y, q.z, q.w};
}

/// The value of a key, not its tangents.
glm::dvec4 keyValue(const AnimationChannel& channel, std::size_t key) {
    const bool isSpline = channel.interpolation == Interpolation::CubicSpline;
    return glm::dvec4(channel.values[isSpline ? 3 * key + 1 : key]);
}

/// Cubic Hermite between key and key + 1; `part` in [0; 1] of their `spanS`.
glm::dvec4 hermite(const AnimationChannel& channel, std::size_t key, double part, double spanS) {
    const double t = part, t2 = t * t, t3 = t2 * t;
    const glm::dvec4 outTangent(channel.values[3 * key + 2]);
    const glm::dvec4 inTangent(channel.values[3 * (key + 1)]);
    return (2.0 * t3 - 3.0 * t2 + 1.0) * keyValue(channel, key) + spanS * (t3 - 2.0 * t2 + t) * outTangent +
           (3.0 * t2 - 2.0 * t3) * keyValue(channel, key + 1) + spanS * (t3 - t2) * inTangent;
}

glm::dvec4 interpolated(const AnimationChannel& channel, double timeS) {
    const std::vector<float>& times = channel.timesS;
    if (timeS <= double(times.front())) return keyValue(channel, 0);
    if (timeS >= double(times.back())) return keyValue(channel, times.size() - 1);
    const auto after =
        std::upper_bound(times.begin(), times.end(), timeS, [](double time, float key) { return time < double(key); });
    const auto key = std::size_t(after - times.begin()) - 1;
    const double spanS = double(times[key + 1]) - double(times[key]);
    const double part = (timeS - double(times[key])) / spanS;
    switch (channel.interpolation) {
        case Interpolation::Step:
            return keyValue(channel, key);
        case Interpolation::CubicSpline:
            return hermite(channel, key, part, spanS);
        case Interpolation::Linear:
            break;
    }
    const glm::dvec4 from = keyValue(channel, key), to = keyValue(channel, key + 1);
    return channel.part == AnimatedPart::Rotation ? slerp(from, to, part) : glm::mix(from, to, part);
}

}  // namespace

glm::dmat4 parentFromNode(const SceneNode& node) {
    if (node.matrix) return *node.matrix;
    glm::dmat4 result = glm::mat4_cast(glm::normalize(node.rotation));
    for (int axis = 0; axis < 3; ++axis) {
        result[axis] *= node.scale[axis];
        result[3][axis] = node.translation[axis];
    }
    return result;
}

glm::dvec4 valueAt(const AnimationChannel& channel, double timeS) {
    const glm::dvec4 value = interpolated(channel, timeS);
    if (channel.part != AnimatedPart::Rotation) return value;
    // A spline may pass through zero, where no direction is better than another.
    constexpr double kNoDirection = 1e-12;
    const double length = glm::length(value);
    return length > kNoDirection ? value / length : glm::dvec4(0.0, 0.0, 0.0, 1.0);
}

double lastKeyS(const Animation& animation) {
    double last = 0.0;
    for (const AnimationChannel& channel : animation.channels) last = std::max(last, double(channel.timesS.back()));
    return last;
}

}  // namespace earthshine::raster
