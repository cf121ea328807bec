#include "raster/trace/light_source.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace earthshine::trace {

namespace {

/// spotAttenuation is ((cos - cosOuter) / width)^2 up to 1: its integral over the cone in two parts, along the cosine.
struct Cone {
    double cosOuter, width, falling, full;

    explicit Cone(const Light& light) : cosOuter(std::cos(double(light.outerConeAngle))) {
        width = std::max(std::cos(double(light.innerConeAngle)) - cosOuter, 1e-3);
        const double top = std::min((1.0 - cosOuter) / width, 1.0);
        falling = width / 3.0 * top * top * top;
        full = std::max(1.0 - cosOuter - width, 0.0);
    }
    double solidAngle() const { return 2.0 * std::numbers::pi * (falling + full); }
    double cosine(double random) const {
        const double at = random * (falling + full);
        if (at < falling) return cosOuter + width * std::cbrt(3.0 * at / width);
        return cosOuter + width + (at - falling);
    }
};

glm::dvec3 unprojected(const glm::dmat4& traceFromClip, const glm::dvec3& ndc) {
    const glm::dvec4 p = traceFromClip * glm::dvec4(ndc, 1.0);
    return glm::dvec3(p) / p.w;
}

}  // namespace

LightSource::LightSource(const Light& light, const glm::dvec3& originWs) : light_(light) {
    const glm::dmat4 viewFromTrace = glm::dmat4(light.camera.viewFromWorld) * glm::translate(glm::dmat4(1.0), originWs);
    const glm::dmat4 traceFromView = glm::inverse(viewFromTrace);
    towards_ = glm::normalize(glm::dvec3(traceFromView[2]));
    position_ = glm::vec3(traceFromView[3]);
    clipFromTrace_ = glm::dmat4(light.camera.clipFromView) * viewFromTrace;
    traceFromClip_ = glm::inverse(clipFromTrace_);
    raysMeasure_ =
        light.type == LightType::Directional ? texelPowerOnAxis(light, {1, 1}) : float(Cone(light).solidAngle());
    power_ = raysMeasure_ * glm::dot(light.intensity, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

Incident LightSource::incident(const glm::vec3& position) const {
    Incident result;
    if (light_.type == LightType::Directional) {
        result.towards = result.direction = glm::vec3(towards_);
        result.tFar = std::numeric_limits<float>::infinity();
        result.illuminance = light_.intensity;
        return result;
    }
    result.towards = position_ - position;
    result.tFar = 1.0f;
    const float distanceM = glm::length(result.towards);
    if (distanceM <= 0.0f) return result;
    result.direction = result.towards / distanceM;
    const float cosAxis = glm::dot(result.direction, glm::vec3(towards_));
    result.illuminance = light_.intensity * (spotAttenuation(light_, cosAxis) * rangeAttenuation(light_, distanceM) /
                                             (distanceM * distanceM));
    return result;
}

bool LightSource::isInMap(const glm::vec3& position) const {
    const glm::dvec4 clip = clipFromTrace_ * glm::dvec4(position, 1.0f);
    return std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && std::abs(clip.z) <= clip.w;
}

bool LightSource::sampleRay(const glm::vec2& random, Ray& ray) const {
    glm::dvec2 ndc = 2.0 * glm::dvec2(random) - 1.0;
    if (light_.type == LightType::Spot) {
        const double cosine = Cone(light_).cosine(double(random.x));
        const double tangent = std::sqrt(std::max(1.0 - cosine * cosine, 0.0)) / cosine;
        const double angle = 2.0 * std::numbers::pi * double(random.y);
        ndc = {tangent * std::cos(angle) * double(light_.camera.clipFromView[0][0]),
               tangent * std::sin(angle) * double(light_.camera.clipFromView[1][1])};
        if (std::abs(ndc.x) > 1.0 || std::abs(ndc.y) > 1.0) return false;
    }
    const glm::dvec3 near = unprojected(traceFromClip_, {ndc, -1.0}), far = unprojected(traceFromClip_, {ndc, 1.0});
    ray.origin = glm::vec3(near);
    ray.direction = glm::vec3(far - near);
    ray.tNear = 0.0f;
    ray.tFar = 1.0f;
    return true;
}

float LightSource::raysPerArea(const glm::vec3& position, const glm::vec3& geometricNormal) const {
    if (!isInMap(position)) return 0.0f;
    if (light_.type == LightType::Directional)
        return std::abs(glm::dot(geometricNormal, glm::vec3(towards_))) / raysMeasure_;
    const glm::vec3 towards = position_ - position;
    const float distance2 = glm::dot(towards, towards);
    if (distance2 <= 0.0f) return 0.0f;
    const glm::vec3 direction = towards / std::sqrt(distance2);
    return spotAttenuation(light_, glm::dot(direction, glm::vec3(towards_))) *
           std::abs(glm::dot(geometricNormal, direction)) / (distance2 * raysMeasure_);
}

LightSources::LightSources(std::span<const Light> lights, const glm::dvec3& originWs) {
    float total = 0.0f;
    for (const Light& light : lights) {
        sources_.emplace_back(light, originWs);
        total += sources_.back().power();
    }
    for (const LightSource& source : sources_)
        chances_.push_back(total > 0.0f ? source.power() / total : 1.0f / float(sources_.size()));
}

std::size_t LightSources::draw(float random) const {
    std::size_t light = 0;
    for (; light + 1 < chances_.size() && random >= chances_[light]; ++light) random -= chances_[light];
    return light;
}

}  // namespace earthshine::trace
