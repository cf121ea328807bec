#include "reference/lower_resolution.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

namespace earthshine::reference {

namespace {

// Positions are floats, of which the kernel keeps 1e-7 of a depth of some hundred texel widths.
constexpr double kClear = 1e-3;

struct Tap {
    int x = 0, y = 0;  ///< texel
    double bilinear = 0.0;
    bool isSurface = false;
    double planeTexels = 0.0, cosine = 0.0;
};

class Neighbourhood {
public:
    Neighbourhood(const Camera& camera, const std::vector<SurfacePoint>& points, const HostImage& depth,
                  const Picks& picks, int x, int y)
        : points_(points), picks_(picks), x_(x), y_(y), here_(at(x, y)) {
        const Extent e = picks.full;
        const auto shifted = [&](double dx, double dy) {
            return unproject(camera, {(x + dx) / e.widthPx, (y + dy) / e.heightPx}, *depth.pixel(x, y));
        };
        const glm::dvec3 middle = shifted(0.0, 0.0);
        texelM_ =
            picks.stride * std::max(glm::length(shifted(1.0, 0.0) - middle), glm::length(shifted(0.0, 1.0) - middle));
    }

    Tap tap(int texelX, int texelY) const {
        Tap t;
        t.x = std::clamp(texelX, 0, picks_.low.widthPx - 1);
        t.y = std::clamp(texelY, 0, picks_.low.heightPx - 1);
        const SurfacePoint& there = at(picks_.x(t.x), picks_.y(t.y));
        t.isSurface = there.isValid;
        if (!t.isSurface) return t;
        t.planeTexels = std::fabs(glm::dot(here_.normal, there.position - here_.position)) / texelM_;
        t.cosine = std::clamp(glm::dot(here_.normal, there.normal), 0.0, 1.0);
        return t;
    }

    std::vector<Tap> four() const {
        const double u = double(x_ - picks_.offsetX) / picks_.stride, v = double(y_ - picks_.offsetY) / picks_.stride;
        std::vector<Tap> taps;
        for (int dy = 0; dy < 2; ++dy) {
            for (int dx = 0; dx < 2; ++dx) {
                Tap t = tap(int(std::floor(u)) + dx, int(std::floor(v)) + dy);
                const double fu = u - std::floor(u), fv = v - std::floor(v);
                t.bilinear = (dx ? fu : 1.0 - fu) * (dy ? fv : 1.0 - fv);
                taps.push_back(t);
            }
        }
        return taps;
    }

    // The 3 x 3 around the nearest, nearer first.
    std::vector<Tap> nine() const {
        const auto nearest = [&](int px, int offset, int size) {
            return std::clamp(int(std::floor(double(px - offset) / picks_.stride + 0.5)), 0, size - 1);
        };
        const int nearX = nearest(x_, picks_.offsetX, picks_.low.widthPx);
        const int nearY = nearest(y_, picks_.offsetY, picks_.low.heightPx);
        std::vector<Tap> taps;
        for (const auto& [dx, dy] :
             {std::pair{0, 0}, {0, -1}, {-1, 0}, {1, 0}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}})
            taps.push_back(tap(nearX + dx, nearY + dy));
        return taps;
    }

private:
    const SurfacePoint& at(int x, int y) const {
        return points_[std::size_t(y) * std::size_t(picks_.full.widthPx) + std::size_t(x)];
    }

    const std::vector<SurfacePoint>& points_;
    const Picks& picks_;
    int x_, y_;
    const SurfacePoint& here_;
    double texelM_ = 0.0;
};

template <class Rule>
std::vector<Answer> eachPixel(const Camera& camera, const std::vector<SurfacePoint>& points, const HostImage& depth,
                              const Picks& picks, Rule rule) {
    std::vector<Answer> answers(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!points[i].isValid) continue;
        const int x = int(i) % picks.full.widthPx, y = int(i) / picks.full.widthPx;
        answers[i] = rule(Neighbourhood(camera, points, depth, picks, x, y));
    }
    return answers;
}

}  // namespace

Picks::Picks(Extent extent, int s) : stride(s), full(extent) {
    low = {int(std::ceil(double(full.widthPx) / s)), int(std::ceil(double(full.heightPx) / s))};
    offsetX = (full.widthPx - 1 - (low.widthPx - 1) * s) / 2;
    offsetY = (full.heightPx - 1 - (low.heightPx - 1) * s) / 2;
}

Still makeStill(Extent extent, bool isOrthographic) {
    Still still;
    const float aspect = float(extent.widthPx) / float(extent.heightPx);
    still.camera.viewFromWorld =
        glm::lookAt(glm::vec3(0.7f, 1.5f, 4.0f), glm::vec3(0.1f, 1.1f, 0.0f), glm::vec3(0.1f, 1.0f, 0.0f));
    still.camera.clipFromView = isOrthographic ? glm::ortho(-2.5f, 2.0f, -1.5f, 1.7f, 0.1f, 30.0f)
                                               : glm::perspective(0.8f, aspect, 0.1f, 50.0f);
    HostImage normal(PixelFormat::RGBA32F, extent), motion(PixelFormat::RGBA32F, extent);
    still.depth = HostImage(PixelFormat::R32F, extent);
    std::mt19937 random(7);
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            const glm::dvec2 uv((x + 0.5) / extent.widthPx, (y + 0.5) / extent.heightPx);
            // Both in depth, so that the ray's parameter is the depth: origin + depth x direction.
            const glm::dvec3 one = unproject(still.camera, uv, 1.0), direction = unproject(still.camera, uv, 2.0) - one;
            const glm::dvec3 origin = one - direction;
            double nearest = 1e9;
            glm::dvec3 normalWs(0.0);
            const auto plane = [&](glm::dvec3 n, double distance, auto&& isThere) {
                const double t = (distance - glm::dot(n, origin)) / glm::dot(n, direction);
                if (t > 0.1 && t < nearest && isThere(origin + t * direction)) {
                    nearest = t;
                    normalWs = n;
                }
            };
            plane({0, 1, 0}, 0.0, [](glm::dvec3 p) { return p.z > -6.0; });                                 // floor
            plane({0, 0, 1}, -3.0, [](glm::dvec3 p) { return p.y > 0.0 && p.y < 1.9 && p.x < 1.4; });       // wall
            plane({0, 0, 1}, -1.0, [](glm::dvec3 p) { return p.y < 1.3 && std::fabs(p.x + 0.8) < 0.45; });  // board
            plane({0.6, 0, 0.8}, 1.9, [](glm::dvec3 p) { return std::fabs(p.x - 0.55) < 0.012; });          // pole
            const glm::dvec3 centre(0.5, 0.9, -1.2), m = origin - centre;                                   // ball
            const double a = glm::dot(direction, direction), b = glm::dot(m, direction), c = glm::dot(m, m) - 0.7 * 0.7;
            if (b * b > a * c) {
                const double t = (-b - std::sqrt(b * b - a * c)) / a;
                if (t > 0.1 && t < nearest) {
                    nearest = t;
                    normalWs = glm::normalize(origin + t * direction - centre);
                }
            }
            for (int channel = 0; channel < 3; ++channel)
                motion.pixel(x, y)[channel] = float(random() % 4096) / 64.0f - 32.0f;  // exact in half, also a quarter
            if (random() % 40 == 0) {                                                  // dust: a pixel of its own
                nearest = 2.0 + 0.001 * double(random() % 4096);
                normalWs = glm::normalize(glm::dvec3(double(random() % 64) - 31.5, double(random() % 64) - 31.5, 20.0));
            }
            if (nearest >= 1e9) continue;
            *still.depth.pixel(x, y) = float(nearest);
            for (int channel = 0; channel < 3; ++channel) normal.pixel(x, y)[channel] = float(normalWs[channel]);
            normal.pixel(x, y)[3] = 1.0f;
        }
    }
    still.normalWs = toHalf(normal.view());
    still.motion = toHalf(motion.view());
    return still;
}

std::vector<Answer> upsample(const Camera& camera, const std::vector<SurfacePoint>& points, const HostImage& depth,
                             const Picks& picks, const std::vector<glm::dvec3>& low) {
    const auto irradianceOf = [&](const Tap& t) { return low[std::size_t(t.y * picks.low.widthPx + t.x)]; };
    return eachPixel(camera, points, depth, picks, [&](const Neighbourhood& around) {
        Answer answer;
        double sum = 0.0;
        for (const Tap& t : around.four()) {
            const double weight =
                t.isSurface ? t.bilinear * std::max(0.0, 1.0 - t.planeTexels * t.planeTexels) * std::pow(t.cosine, 8.0)
                            : 0.0;
            sum += weight;
            answer.irradiance += weight * irradianceOf(t);
        }
        constexpr double kMinWeight = 6e-4;
        answer.isClear = std::fabs(sum / kMinWeight - 1.0) > 0.1;
        if (sum >= kMinWeight) {
            answer.irradiance /= sum;
            return answer;
        }
        answer.isLost = true;
        answer.irradiance = glm::dvec3(0.0);
        double best = 1e9;
        const Tap* chosen = nullptr;
        const std::vector<Tap> nine = around.nine();
        const auto costOf = [&](std::size_t i) {
            const Tap& t = nine[i];
            return t.isSurface ? t.planeTexels / (1.0 + t.planeTexels) + 1.0 - t.cosine + 0.005 * double(i) : 1e9;
        };
        for (std::size_t i = 0; i < nine.size(); ++i) {
            if (costOf(i) >= best) continue;
            best = costOf(i);
            chosen = &nine[i];
        }
        if (!chosen) return answer;
        answer.irradiance = irradianceOf(*chosen);
        for (std::size_t i = 0; i < nine.size(); ++i)
            if ((nine[i].x != chosen->x || nine[i].y != chosen->y) && costOf(i) < best + 0.1 * kClear)
                answer.isClear = false;
        return answer;
    });
}

std::vector<Answer> interpolate(const Camera& camera, const std::vector<SurfacePoint>& points, const HostImage& depth,
                                const Picks& picks, const std::vector<glm::dvec3>& low, double minCosine,
                                double maxPlaneTexels) {
    return eachPixel(camera, points, depth, picks, [&](const Neighbourhood& around) {
        Answer answer;
        double sum = 0.0;
        int asked = 0, suitable = 0;
        for (const Tap& t : around.four()) {
            if (t.bilinear == 0.0) continue;
            ++asked;
            if (!t.isSurface) continue;
            if (std::fabs(t.planeTexels - maxPlaneTexels) < kClear || std::fabs(t.cosine - minCosine) < kClear)
                answer.isClear = false;
            if (t.planeTexels > maxPlaneTexels || t.cosine < minCosine) continue;
            ++suitable;
            sum += t.bilinear;
            answer.irradiance += t.bilinear * low[std::size_t(t.y * picks.low.widthPx + t.x)];
        }
        answer.isListed = 4 * suitable < 3 * asked;
        answer.irradiance = answer.isListed ? glm::dvec3(0.0) : answer.irradiance / sum;
        return answer;
    });
}

}  // namespace earthshine::reference
