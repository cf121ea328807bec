#include "reference/denoiser_reference.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "reference/frame_reference.hpp"
#include "reference/synthetic_frame.hpp"

namespace earthshine::reference {

namespace {

constexpr float kMotionX = 1.3f, kMotionY = -0.6f;  // px

/// history_confidence.cl of one tile, from the previous frame's changes.
double confidenceOfTile(const std::vector<double>& change, Extent e, int column, int row, double droppedAbove) {
    double confidence = 1.0;
    for (const int around : {0, 1}) {
        double sum = 0.0, squares = 0.0;
        for (int y = std::max((row - around) * 16, 0); y < std::min((row + 1 + around) * 16, e.heightPx); ++y)
            for (int x = std::max((column - around) * 16, 0); x < std::min((column + 1 + around) * 16, e.widthPx);
                 ++x) {
                const double d = change[std::size_t(y * e.widthPx + x)];
                sum += d;
                squares += d * d;
            }
        const double ratio = squares > 0.0 ? sum * sum / squares : 0.0;
        confidence = std::min(confidence, std::clamp((droppedAbove - ratio) / (0.5 * droppedAbove), 0.0, 1.0));
    }
    return confidence;
}

/// The same between the centres of tiles.
double confidenceAt(const std::vector<double>& change, Extent e, double x, double y, double droppedAbove) {
    const double u = (x + 0.5) / 16.0 - 0.5, v = (y + 0.5) / 16.0 - 0.5;
    const int columns = (e.widthPx + 15) / 16, rows = (e.heightPx + 15) / 16;
    double sum = 0.0;
    for (const int i : {0, 1})
        for (const int j : {0, 1}) {
            const double left = std::floor(u), top = std::floor(v);
            const double weight = (i ? u - left : 1.0 - u + left) * (j ? v - top : 1.0 - v + top);
            sum += weight * confidenceOfTile(change, e, std::clamp(int(left) + i, 0, columns - 1),
                                             std::clamp(int(top) + j, 0, rows - 1), droppedAbove);
        }
    return sum;
}

}  // namespace

double luminanceOf(const glm::dvec3& c) {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

FrameImages wallsFrame(const Walls& walls) {
    const Extent extent = walls.extent;
    SyntheticOptions options;
    options.extent = extent;
    FrameImages f = makeSyntheticFrame(options);
    f.camera.viewFromWorld = glm::mat4(glm::inverse(walls.now) * glm::dmat4(f.camera.viewFromWorld));
    const glm::dmat3 worldFromView(glm::inverse(glm::dmat4(f.camera.viewFromWorld)));
    const glm::dmat4& clip = glm::dmat4(f.camera.clipFromView);
    HostImage normal(PixelFormat::RGBA32F, extent), motion(PixelFormat::RGBA32F, extent);
    // The view ray at depth 1: x_ndc = p00 x - p20, with -z = 1.
    const auto rayAt = [&](double x, double y) {
        const double xNdc = 2.0 * (x + 0.5) / extent.widthPx - 1.0, yNdc = 1.0 - 2.0 * (y + 0.5) / extent.heightPx;
        return glm::dvec3((xNdc + clip[2][0]) / clip[0][0], (yNdc + clip[2][1]) / clip[1][1], -1.0);
    };
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            float* z = f.depth.pixel(x, y);
            *z = 0.0f;
            if ((x * 7 + y * 13) % 29 == 1) continue;  // sky, here and there
            const bool isLeft = 2 * x < extent.widthPx, isBehind = 4 * y + 1 < extent.heightPx;
            const glm::dvec3 first = glm::normalize(isLeft ? glm::dvec3(0.5, 0.2, 1.0) : glm::dvec3(-0.6, 0.1, 1.0));
            // The plane n.p = -distance of the first place's view space, in this view's.
            const glm::dvec3 n = glm::inverse(glm::dmat3(walls.now)) * first;
            const double distance = (isBehind ? 9.0 : 5.0) + glm::dot(first, glm::dvec3(walls.now[3]));
            const auto depthAt = [&](double px, double py) { return -distance / glm::dot(n, rayAt(px, py)); };
            const double depth = depthAt(x, y);
            *z = float(depth);
            const auto roughness = [&](int i) {
                return (walls.isRough ? 0.6 : 0.0) * std::sin(x * 12.9 + y * 78.2 + i);
            };
            const glm::dvec3 turned = glm::normalize(n + glm::dvec3(roughness(0), roughness(2), roughness(4)));
            const glm::dvec3 world = worldFromView * turned;
            for (int c = 0; c < 3; ++c) normal.pixel(x, y)[c] = float(world[c]);
            normal.pixel(x, y)[3] = 1.0f;
            float* m = motion.pixel(x, y);
            const bool isStanding = walls.hasStandingBlock && x % 24 >= 9 && y % 16 >= 4;
            if (walls.slides && !isStanding) {
                m[0] = kMotionX;
                m[1] = kMotionY;
                m[2] = float(depthAt(x + double(kMotionX), y + double(kMotionY))) - *z;
            } else if (!walls.slides) {
                const glm::dvec3 then(glm::inverse(walls.before) * walls.now * glm::dvec4(depth * rayAt(x, y), 1.0));
                const double xNdc = clip[0][0] * then.x / -then.z - clip[2][0];
                const double yNdc = clip[1][1] * then.y / -then.z - clip[2][1];
                m[0] = float(0.5 * (xNdc + 1.0) * extent.widthPx - 0.5 - x);
                m[1] = float(0.5 * (1.0 - yNdc) * extent.heightPx - 0.5 - y);
                m[2] = float(-then.z) - *z;
            }
        }
    }
    f.normalWs = toHalf(normal.view());
    f.motion = toHalf(motion.view());
    return f;
}

Memory accumulate(const FrameImages& f, const FrameImages& before, const Memory& past,
                  const std::vector<glm::dvec3>& now, const Temporal& t) {
    const Extent e = f.depth.extent();
    const FrameInputs inputs = f.inputs(), inputsBefore = before.inputs();
    const auto points = surfacePoints(f.camera, inputs.gbuffer.normalWs, inputs.gbuffer.depth);
    const auto pointsBefore = surfacePoints(before.camera, inputsBefore.gbuffer.normalWs, inputsBefore.gbuffer.depth);
    const HostImage motion = toFloat(inputs.gbuffer.motion);
    const std::vector<double> none(now.size(), 0.0);
    Memory next{std::vector<glm::dvec3>(now.size(), glm::dvec3(0.0)), none, none, none};
    const auto limited = [&](int x, int y, const glm::dvec3& remembered) {
        const glm::dvec3& sample = now[std::size_t(y * e.widthPx + x)];
        if (t.fireflyFactor == 0.0) return sample;
        double brightest = luminanceOf(remembered);
        for (int ty = std::max(y - 1, 0); ty <= std::min(y + 1, e.heightPx - 1); ++ty)
            for (int tx = std::max(x - 1, 0); tx <= std::min(x + 1, e.widthPx - 1); ++tx)
                if (tx != x || ty != y)
                    brightest = std::max(brightest, luminanceOf(now[std::size_t(ty * e.widthPx + tx)]));
        const double l = luminanceOf(sample);
        return l > 0.0 && brightest > 0.0 ? std::min(t.fireflyFactor * brightest / l, 1.0) * sample : sample;
    };
    for (int y = 0; y < e.heightPx; ++y) {
        for (int x = 0; x < e.widthPx; ++x) {
            const auto at = std::size_t(y * e.widthPx + x);
            if (!points[at].isValid) continue;
            const float* m = motion.pixel(x, y);
            const double px = x + double(m[0]), py = y + double(m[1]);
            const double depthThen = double(*f.depth.pixel(x, y)) + double(m[2]);
            const glm::dvec3 then =
                unproject(before.camera, {(px + 0.5) / e.widthPx, (py + 0.5) / e.heightPx}, depthThen);
            const auto sumTaps = [&](int firstX, int firstY, int side, double looseness, auto&& weightOf) {
                double weight = 0.0, length = 0.0, moment = 0.0;
                glm::dvec3 sum(0.0);
                for (int ty = firstY; ty < firstY + side; ++ty) {
                    for (int tx = firstX; tx < firstX + side; ++tx) {
                        if (tx < 0 || ty < 0 || tx >= e.widthPx || ty >= e.heightPx) continue;
                        const SurfacePoint& tap = pointsBefore[std::size_t(ty * e.widthPx + tx)];
                        const glm::dvec3 n = points[at].normal, turn = tap.normal - n;
                        double like = std::max(1.0 - glm::dot(turn, turn) / (t.weighsTurn ? 0.2 : 0.4), 0.0);
                        if (!t.weighsTurn && like > 0.0) like = 1.0;
                        if (!tap.isValid || std::fabs(glm::dot(n, tap.position - then)) > looseness * 0.01 * depthThen)
                            continue;
                        const double w = weightOf(tx, ty) * like;
                        weight += w;
                        sum += w * past.irradiance[std::size_t(ty * e.widthPx + tx)];
                        length += w * like * like * past.length[std::size_t(ty * e.widthPx + tx)];
                        moment += w * past.moment[std::size_t(ty * e.widthPx + tx)];
                    }
                }
                if (weight < 0.01) return false;
                double confidence = 1.0;
                if (t.antiLag > 0.0)
                    confidence = confidenceAt(past.change, e, std::floor(px), std::floor(py), t.antiLag);
                const double frames = std::min(confidence * length / weight + 1.0, t.maxFrames);
                next.length[at] = frames;
                const glm::dvec3 sample = limited(x, y, sum / weight);
                next.irradiance[at] = glm::mix(sum / weight, sample, 1.0 / frames);
                next.moment[at] = glm::mix(moment / weight, std::pow(luminanceOf(sample), 2.0), 1.0 / frames);
                next.change[at] = luminanceOf(sample) - luminanceOf(next.irradiance[at]);
                return true;
            };
            next.length[at] = 1.0;
            next.irradiance[at] = limited(x, y, glm::dvec3(0.0));
            next.moment[at] = std::pow(luminanceOf(next.irradiance[at]), 2.0);
            if (past.length.empty()) continue;
            const bool isFound = sumTaps(int(std::floor(px)), int(std::floor(py)), 2, 1.0, [&](int tx, int ty) {
                return (1.0 - std::fabs(tx - px)) * (1.0 - std::fabs(ty - py));
            });
            if (!isFound)
                sumTaps(int(std::floor(px + 0.5)) - 1, int(std::floor(py + 0.5)) - 1, 3, 2.0,
                        [&](int tx, int ty) { return 1.0 / (1.0 + (tx - px) * (tx - px) + (ty - py) * (ty - py)); });
        }
    }
    return next;
}

std::vector<glm::dvec3> filterPass(const FrameImages& f, const std::vector<glm::dvec3>& in, const Settings& settings,
                                   int radiusX, int radiusY, int step, const Memory* memory) {
    const Extent e = f.depth.extent();
    const FrameInputs inputs = f.inputs();
    const auto points = surfacePoints(f.camera, inputs.gbuffer.normalWs, inputs.gbuffer.depth);
    const glm::dvec3 eye(glm::inverse(glm::dmat4(f.camera.viewFromWorld))[3]);
    const double footprint = 2.0 / double(f.camera.clipFromView[0][0]) / e.widthPx;  // m a pixel at 1 m
    const bool isSmall = settings.filterKernel == FilterKernel::Square3x3;
    const auto kernel = [&](int i) {
        return isSmall ? (i == 0 ? 0.5 : 0.25) : (i == 0 ? 0.375 : std::abs(i) == 1 ? 0.25 : 0.0625);
    };
    std::vector<glm::dvec3> out(in.size(), glm::dvec3(0.0));
    for (int y = 0; y < e.heightPx; ++y) {
        for (int x = 0; x < e.widthPx; ++x) {
            const SurfacePoint& p = points[std::size_t(y * e.widthPx + x)];
            if (!p.isValid) continue;
            const double z = double(*f.depth.pixel(x, y));
            const auto at = std::size_t(y * e.widthPx + x);
            const double length = memory ? memory->length[at] : 1.0, l = luminanceOf(in[at]);
            // Half at a step of two; from four pixels on a fourth of what halving would leave.
            const double fullFrames = std::max(double(settings.filterFade) / (step < 4 ? step : 4 * step), 0.5);
            double fade = settings.filterFade < 1024.0f ? std::min(fullFrames / length, 1.0) : 1.0;
            if (fade < 0.0999) fade = 0.0;
            const double variance = memory ? std::max(memory->moment[at] - l * l, 0.0) / length : 0.0;
            const double deviations = double(settings.filterLuminance) / step;  // an iteration has twice the step
            const double guidance = deviations > 0.0 ? std::clamp(length - 3.0, 0.0, 1.0) : 0.0;
            double weights = 0.0, ownWeights = 0.0, shares = 0.0, luminances = 0.0, taps = 0.0;
            glm::dvec3 sum(0.0);
            for (int j = -radiusY; j <= radiusY; ++j) {
                for (int i = -radiusX; i <= radiusX; ++i) {
                    if (i == 0 && j == 0) continue;
                    const int tx = x + i * step, ty = y + j * step;
                    if (tx < 0 || ty < 0 || tx >= e.widthPx || ty >= e.heightPx) continue;
                    const auto tap = std::size_t(ty * e.widthPx + tx);
                    const double share = (radiusX > 0 ? kernel(i) : 1.0) * (radiusY > 0 ? kernel(j) : 1.0);
                    shares += share;
                    if (!points[tap].isValid) continue;
                    double w = 0.0;
                    const double steps = std::hypot(i, j), turned = 2.0 *
                                                                    (1.0 - glm::dot(points[tap].normal, p.normal)) /
                                                                    double(settings.filterNormal);
                    if (settings.filterWeights == FilterWeights::Plane) {
                        const double reach =
                            double(settings.filterDepth) * std::max(8.0 / length, 1.0) * footprint * z * steps * step;
                        const double plane = glm::dot(p.normal, points[tap].position - p.position) / reach;
                        const double dl = luminanceOf(in[tap]) - l;
                        const double brighter =
                            guidance * dl * dl / (deviations * deviations * variance + 1e-4 * l * l + 1e-30);
                        w = std::pow(std::max(1.0 - plane * plane - turned - brighter, 0.0), 2.0);
                    } else {
                        const double cosine = std::max(glm::dot(p.normal, glm::normalize(eye - p.position)), 0.25);
                        const double dz = std::fabs(double(*f.depth.pixel(tx, ty)) - z);
                        w = std::exp(-dz * cosine / (double(settings.filterDepth) * steps) - turned);
                    }
                    w *= share;
                    ownWeights += w;
                    luminances += luminanceOf(in[tap]);
                    taps += 1.0;
                    weights += fade * w;
                    sum += fade * w * in[tap];
                }
            }
            // Among few of its own, a young pixel is about as bright as what is around it.
            glm::dvec3 own = in[at];
            const bool isLimited = fade > 0.0 && settings.accumulates && settings.feedback == 0 && step == 1 &&
                                   settings.filterWeights == FilterWeights::Plane;
            if (isLimited && luminances > 0.0 && l > 0.0) {
                const double limit = (2.5 + length * length / 16.0) * luminances / taps;
                own *= 1.0 - std::max(1.0 - ownWeights / (0.64 * shares), 0.0) * std::max(1.0 - limit / l, 0.0);
            }
            const double centre = (radiusX > 0 ? kernel(0) : 1.0) * (radiusY > 0 ? kernel(0) : 1.0);
            out[at] = (sum + centre * own) / (weights + centre);
        }
    }
    return out;
}

}  // namespace earthshine::reference
