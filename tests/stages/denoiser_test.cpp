// The denoiser against plain doubles at every width and storage, on every device here: temporal accumulation along
// motion, the a-trous filter in each of its forms, and history that is dropped when the light changes.
// What the stages start from is the picture of a pipeline that does not denoise.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "earthshine/pipeline.hpp"
#include "reference/device_variants.hpp"
#include "reference/frame_reference.hpp"
#include "reference/synthetic_frame.hpp"

namespace earthshine {
namespace {

using reference::SurfacePoint;

// Sums of a few dozen floats whose weights hold a plane's distance, a difference of positions some 1e-6 exact.
constexpr double kRelative = 2e-3;
constexpr float kMotionX = 1.3f, kMotionY = -0.6f;  // px

/// Where a camera went from its first place, in that place's view space.
using Move = glm::dmat4;

/// Two walls at an angle and another far behind, some sky: what a filter must keep apart. Lights and maps are the
/// synthetic frame's. The walls slide along themselves by a fraction of a pixel a frame (but for a block that stands,
/// if asked for), or stand while the camera has gone from where `before` puts it to `now`.
struct Walls {
    Extent extent;
    bool slides = true;
    bool hasStandingBlock = false;
    Move before{1.0}, now{1.0};
};

FrameImages wallsFrame(const Walls& walls) {
    const Extent extent = walls.extent;
    reference::SyntheticOptions options;
    options.extent = extent;
    FrameImages f = reference::makeSyntheticFrame(options);
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
            const glm::dvec3 world = worldFromView * n;
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

FrameImages slidingWalls(Extent extent) {
    return wallsFrame({extent});
}

struct Memory {
    std::vector<glm::dvec3> irradiance;
    std::vector<double> length;
    std::vector<double> moment;  ///< mean squared luminance
    std::vector<double> change;  ///< luminance: the sample, as limited, less the mean
};

double luminanceOf(const glm::dvec3& c) {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

std::vector<glm::dvec3> colors(const HostImage& image) {
    std::vector<glm::dvec3> result;
    for (int i = 0; i < image.extent().widthPx * image.extent().heightPx; ++i) {
        const float* p = image.pixel(0, 0) + 4 * i;
        result.emplace_back(p[0], p[1], p[2]);
    }
    return result;
}

void expectNear(const HostImage& actual, const std::vector<glm::dvec3>& expected) {
    double mean = 0.0;
    for (const glm::dvec3& e : expected) mean += (e.x + e.y + e.z) / 3.0 / double(expected.size());
    ASSERT_GT(mean, 0.0);
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(double(actual.pixel(0, 0)[4 * int(i) + c]), expected[i][c],
                        kRelative * (std::fabs(expected[i][c]) + mean))
                << int(i) % actual.extent().widthPx << ", " << int(i) / actual.extent().widthPx;
}

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

struct Temporal {
    double maxFrames = 32.0;
    double fireflyFactor = 0.0;  ///< 0 = none
    double antiLag = 0.0;        ///< 0 = off
};

/// temporal.cl. `before` is the frame that left `past`.
Memory accumulate(const FrameImages& f, const FrameImages& before, const Memory& past,
                  const std::vector<glm::dvec3>& now, const Temporal& t) {
    const Extent e = f.depth.extent();
    const FrameInputs inputs = f.inputs(), inputsBefore = before.inputs();
    const auto points = reference::surfacePoints(f.camera, inputs.gbuffer.normalWs, inputs.gbuffer.depth);
    const auto pointsBefore =
        reference::surfacePoints(before.camera, inputsBefore.gbuffer.normalWs, inputsBefore.gbuffer.depth);
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
                reference::unproject(before.camera, {(px + 0.5) / e.widthPx, (py + 0.5) / e.heightPx}, depthThen);
            const auto sumTaps = [&](int firstX, int firstY, int side, double looseness, auto&& weightOf) {
                double weight = 0.0, length = 0.0, moment = 0.0;
                glm::dvec3 sum(0.0);
                for (int ty = firstY; ty < firstY + side; ++ty) {
                    for (int tx = firstX; tx < firstX + side; ++tx) {
                        if (tx < 0 || ty < 0 || tx >= e.widthPx || ty >= e.heightPx) continue;
                        const SurfacePoint& tap = pointsBefore[std::size_t(ty * e.widthPx + tx)];
                        const glm::dvec3 n = points[at].normal;
                        if (!tap.isValid || glm::dot(n, tap.normal) < 0.8 ||
                            std::fabs(glm::dot(n, tap.position - then)) > looseness * 0.01 * depthThen)
                            continue;
                        const double w = weightOf(tx, ty);
                        weight += w;
                        sum += w * past.irradiance[std::size_t(ty * e.widthPx + tx)];
                        length += w * past.length[std::size_t(ty * e.widthPx + tx)];
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

/// One pass of atrous.cl; without `memory`, history is of one frame.
std::vector<glm::dvec3> filterPass(const FrameImages& f, const std::vector<glm::dvec3>& in, const Settings& settings,
                                   int radiusX, int radiusY, int step, const Memory* memory = nullptr) {
    const Extent e = f.depth.extent();
    const FrameInputs inputs = f.inputs();
    const auto points = reference::surfacePoints(f.camera, inputs.gbuffer.normalWs, inputs.gbuffer.depth);
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
            double fade =
                std::min(std::max(double(settings.filterFade) / step, 1.0) / length, 1.0);  // of a step twice as wide
            if (fade < 0.1) fade = 0.0;
            const double variance = memory ? std::max(memory->moment[at] - l * l, 0.0) / length : 0.0;
            const double deviations = double(settings.filterLuminance) / step;  // an iteration has twice the step
            const double guidance = deviations > 0.0 ? std::clamp(length - 3.0, 0.0, 1.0) : 0.0;
            double weights = 0.0;
            glm::dvec3 sum(0.0);
            for (int j = -radiusY; j <= radiusY; ++j) {
                for (int i = -radiusX; i <= radiusX; ++i) {
                    const int tx = x + i * step, ty = y + j * step;
                    if (tx < 0 || ty < 0 || tx >= e.widthPx || ty >= e.heightPx) continue;
                    const auto tap = std::size_t(ty * e.widthPx + tx);
                    if (!points[tap].isValid) continue;
                    const glm::dvec3 turn = points[tap].normal - p.normal;
                    double w = 1.0;
                    const double steps = std::hypot(i, j),
                                 turned = glm::dot(turn, turn) / double(settings.filterNormal);
                    if (steps > 0.0 && settings.filterWeights == FilterWeights::Plane) {
                        const double reach =
                            double(settings.filterDepth) * std::max(8.0 / length, 1.0) * footprint * z * steps * step;
                        const double plane = glm::dot(p.normal, points[tap].position - p.position) / reach;
                        const double dl = luminanceOf(in[tap]) - l;
                        const double brighter =
                            guidance * dl * dl / (deviations * deviations * variance + 1e-4 * l * l + 1e-30);
                        w = std::pow(std::max(1.0 - plane * plane - turned - brighter, 0.0), 2.0);
                    } else if (steps > 0.0) {
                        const double cosine = std::max(glm::dot(p.normal, glm::normalize(eye - p.position)), 0.25);
                        const double dz = std::fabs(double(*f.depth.pixel(tx, ty)) - z);
                        w = std::exp(-dz * cosine / (double(settings.filterDepth) * steps) - turned);
                    }
                    if (steps > 0.0) w *= fade;
                    w *= (radiusX > 0 ? kernel(i) : 1.0) * (radiusY > 0 ? kernel(j) : 1.0);
                    weights += w;
                    sum += w * in[tap];
                }
            }
            out[std::size_t(y * e.widthPx + x)] = sum / weights;
        }
    }
    return out;
}

Settings fewSamples() {
    Settings s;
    s.sampleCount = 4;
    s.antiLag = 0.0f;
    return s;
}

class Denoiser : public testing::TestWithParam<reference::Variant> {
protected:
    Device device_{GetParam().caps, GetParam().options};
};

/// Runs as many frames as there are and compares each with the reference.
void followFrames(const Device& device, const std::vector<const FrameImages*>& frames, Settings settings) {
    Pipeline raw(device), denoised(device);
    Settings noise = settings;
    noise.accumulates = false;
    settings.accumulates = true;
    Memory memory;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "frame " << i);
        raw.setFrame(frames[i]->inputs());
        denoised.setFrame(frames[i]->inputs());
        raw.run(noise);
        denoised.run(settings);
        memory =
            accumulate(*frames[i], *frames[i > 0 ? i - 1 : 0], memory, colors(raw.read(Output::IndirectIrradiance)),
                       {double(settings.historyFrames), double(settings.fireflyFactor), double(settings.antiLag)});
        expectNear(denoised.read(Output::IndirectIrradiance), memory.irradiance);
    }
}

TEST_P(Denoiser, HistoryFollowsMotion) {
    Settings settings = fewSamples();
    settings.historyFrames = 3;
    for (const Extent extent : {Extent{53, 21}, Extent{1, 1}, Extent{7, 3}}) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        const FrameImages frame = slidingWalls(extent);
        followFrames(device_, std::vector(5, &frame), settings);
    }
    const FrameImages large = slidingWalls({191, 347});
    followFrames(device_, std::vector(2, &large), settings);
}

// Pixels that stand beside others that move: what a pixel remembers does not depend on those that share its work-item.
TEST_P(Denoiser, HistoryStandsBesideMotion) {
    Settings settings = fewSamples();
    settings.historyFrames = 5;
    const FrameImages frame = wallsFrame({{53, 37}, true, true});
    followFrames(device_, std::vector(5, &frame), settings);
}

TEST_P(Denoiser, HistoryFollowsACameraThatMoves) {
    std::vector<FrameImages> frames;
    Move before(1.0);
    for (int i = 0; i < 5; ++i) {
        const glm::dvec3 path(0.05 * i, -0.02 * i, -0.11 * i);
        const Move now = glm::rotate(glm::translate(glm::dmat4(1.0), path), 0.013 * i, glm::dvec3(0.3, 1.0, 0.1));
        frames.push_back(wallsFrame({{53, 37}, false, false, before, now}));
        before = now;
    }
    std::vector<const FrameImages*> all;
    for (const FrameImages& frame : frames) all.push_back(&frame);
    followFrames(device_, all, fewSamples());
}

// With a bound that noise reaches, all degrees of confidence occur.
TEST_P(Denoiser, HistoryIsBelievedAsFarAsItFits) {
    Settings settings = fewSamples();
    settings.antiLag = 4.0f;
    settings.fireflyFactor = 2.0f;
    for (const Extent extent : {Extent{53, 37}, Extent{7, 3}, Extent{1, 1}}) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        for (const bool hasBlock : {false, true}) {
            const FrameImages frame = wallsFrame({extent, true, hasBlock});
            followFrames(device_, std::vector(6, &frame), settings);
        }
    }
}

// What another size, resolution or guide left behind is no history, and neither are its tiles' sums.
TEST_P(Denoiser, AnotherSizeOrSettingBeginsAnew) {
    const FrameImages wide = slidingWalls({53, 37}), tall = slidingWalls({37, 53});
    Settings plain = fewSamples(), guided, half;
    plain.antiLag = 16.0f;
    guided = half = plain;
    guided.filterIterations = 1;
    guided.filterLuminance = 2.0f;
    half.divisor = 2;
    Pipeline raw(device_), denoised(device_);
    const auto see = [&](const FrameImages& frame, Settings settings) {
        raw.setFrame(frame.inputs());
        raw.run(settings);
        settings.accumulates = true;
        denoised.setFrame(frame.inputs());
        denoised.run(settings);
    };
    for (const auto& [frame, settings] :
         {std::pair{&tall, &plain}, std::pair{&wide, &plain}, std::pair{&wide, &guided}, std::pair{&wide, &half}}) {
        for (int i = 0; i < 3; ++i) see(wide, plain);
        see(frame == &wide && settings == &plain ? tall : wide, plain);
        see(*frame, *settings);
        expectNear(denoised.read(Output::IndirectIrradiance), colors(raw.read(Output::IndirectIrradiance)));
    }
}

TEST_P(Denoiser, FirefliesAreLimitedAndTheirMomentsGuideTheFilter) {
    const FrameImages frame = slidingWalls({53, 21});
    Pipeline raw(device_), denoised(device_);
    raw.setFrame(frame.inputs());
    denoised.setFrame(frame.inputs());
    Settings settings = fewSamples();
    settings.accumulates = true;
    settings.fireflyFactor = 1.5f;
    settings.filterIterations = 2;
    settings.filterFade = 4.0f;
    settings.filterLuminance = 3.0f;
    settings.filterKernel = FilterKernel::Square3x3;
    for (const int feedback : {0, 1}) {
        settings.feedback = feedback;
        Memory memory;
        raw.forgetHistory();
        denoised.forgetHistory();
        for (int i = 0; i < 7; ++i) {
            SCOPED_TRACE(testing::Message() << "feedback " << feedback << ", frame " << i);
            raw.run(fewSamples());
            denoised.run(settings);
            memory = accumulate(frame, frame, memory, colors(raw.read(Output::IndirectIrradiance)), {32.0, 1.5, 0.0});
            const auto once = filterPass(frame, memory.irradiance, settings, 1, 1, 1, &memory);
            expectNear(denoised.read(Output::IndirectIrradiance), filterPass(frame, once, settings, 1, 1, 2, &memory));
            if (feedback > 0) memory.irradiance = once;
        }
    }
}

void compareFilters(const Device& device, Extent extent, const std::vector<FilterKernel>& kernels) {
    const FrameImages frame = slidingWalls(extent);
    Pipeline raw(device);
    raw.setFrame(frame.inputs());
    Settings noise = fewSamples();
    noise.animatesNoise = false;
    raw.run(noise);
    const std::vector<glm::dvec3> noisy = colors(raw.read(Output::IndirectIrradiance));
    for (const FilterKernel kernel : kernels) {
        for (const FilterWeights weights : {FilterWeights::Plane, FilterWeights::Depth}) {
            SCOPED_TRACE(testing::Message()
                         << kFilterKernelNames[int(kernel)] << ", " << kFilterWeightsNames[int(weights)]);
            Settings settings = noise;
            settings.filterIterations = 2;
            settings.filterKernel = kernel;
            settings.filterWeights = weights;
            std::vector<glm::dvec3> expected = noisy;
            for (const int step : {1, 2}) {
                if (kernel == FilterKernel::Separable) {
                    expected = filterPass(frame, expected, settings, 2, 0, step);
                    expected = filterPass(frame, expected, settings, 0, 2, step);
                } else {
                    const int radius = kernel == FilterKernel::Square3x3 ? 1 : 2;
                    expected = filterPass(frame, expected, settings, radius, radius, step);
                }
            }
            raw.run(settings);
            expectNear(raw.read(Output::IndirectIrradiance), expected);
        }
    }
}

TEST_P(Denoiser, FiltersInEveryForm) {
    for (const Extent extent : {Extent{53, 21}, Extent{7, 3}, Extent{1, 1}}) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        compareFilters(device_, extent, {FilterKernel::Separable, FilterKernel::Square3x3, FilterKernel::Square5x5});
    }
    compareFilters(device_, {191, 347}, {FilterKernel::Separable});
}

// Picked at half and a fourth: what is interpolated lies between what the picks have, what is gathered in full is as if
// nothing had been left out; and history works at lower resolution as at the picture's own.
TEST_P(Denoiser, LowerResolutions) {
    const FrameImages frame = slidingWalls({53, 37});
    Pipeline pipeline(device_);
    FrameInputs inputs = frame.inputs();
    inputs.gbuffer.motion = {};
    pipeline.setFrame(inputs);
    Settings settings = fewSamples();
    settings.sampleCount = 256;
    settings.animatesNoise = false;
    pipeline.run(settings);
    const std::vector<glm::dvec3> full = colors(pipeline.read(Output::IndirectIrradiance));
    EXPECT_EQ(pipeline.gatheredPixels(), 0);
    double mean = 0.0;
    for (const glm::dvec3& e : full) mean += luminanceOf(e);
    for (const int divisor : {2, 4}) {
        settings.divisor = divisor;
        for (const Upsampling upsampling : {Upsampling::Bilateral, Upsampling::Interpolate}) {
            SCOPED_TRACE(testing::Message() << "1/" << divisor << ", " << kUpsamplingNames[int(upsampling)]);
            settings.upsampling = upsampling;
            settings.accumulates = false;
            pipeline.run(settings);
            const HostImage once = pipeline.read(Output::IndirectIrradiance);
            const std::vector<glm::dvec3> low = colors(once);
            int same = 0, lit = 0;
            double lowMean = 0.0;
            for (std::size_t i = 0; i < full.size(); ++i) {
                lowMean += luminanceOf(low[i]);
                if (full[i] == glm::dvec3(0.0)) continue;
                ++lit;
                if (std::fabs(low[i].y - full[i].y) <= 1e-4 * full[i].y) ++same;
            }
            EXPECT_NEAR(lowMean / mean, 1.0, 0.1);  // noise of 256 samples, at a fourth or a sixteenth of the pixels
            if (upsampling == Upsampling::Interpolate) {
                EXPECT_GT(pipeline.gatheredPixels(), 0);
                EXPECT_LT(pipeline.gatheredPixels(), lit);
                EXPECT_GE(same, pipeline.gatheredPixels());
            } else {
                EXPECT_EQ(pipeline.gatheredPixels(), 0);
            }
            // The same frame again and again is its own mean.
            settings.accumulates = true;
            pipeline.forgetHistory();
            for (int i = 0; i < 3; ++i) pipeline.run(settings);
            expectNear(pipeline.read(Output::IndirectIrradiance), low);
        }
    }
}

double meanOf(const std::vector<glm::dvec3>& picture) {
    double sum = 0.0;
    for (const glm::dvec3& e : picture) sum += luminanceOf(e);
    return sum / double(picture.size());
}

// The thieves of energy are rounding and a blur that is fed back: the mean must be that of frames as they come.
class DenoiserOverTime : public Denoiser {};

TEST_P(DenoiserOverTime, NothingDriftsOver500Frames) {
    const FrameImages frame = slidingWalls({53, 37});
    FrameInputs inputs = frame.inputs();
    inputs.gbuffer.motion = {};
    Settings settings = settingsOf(Preset::Balanced);
    Settings noise = settings;
    noise.accumulates = false;
    noise.filterIterations = 0;
    Pipeline raw(device_);
    raw.setFrame(inputs);
    double truth = 0.0;
    for (int i = 0; i < 500; ++i) {
        raw.run(noise);
        truth += meanOf(colors(raw.read(Output::IndirectIrradiance))) / 500.0;
    }
    for (const int feedback : {0, 1}) {
        // Not the spatial filter's last word, whose edges weigh pixels unlike: what history holds, and what is fed
        // back.
        settings.filterIterations = feedback;
        settings.feedback = feedback;
        Pipeline pipeline(device_);
        pipeline.setFrame(inputs);
        double late = 0.0;
        for (int i = 0; i < 500; ++i) {
            pipeline.run(settings);
            if (i >= 436) late += meanOf(colors(pipeline.read(Output::IndirectIrradiance))) / 64.0;
        }

        EXPECT_NEAR(late / truth, 1.0, 0.005) << "feedback " << feedback;
    }
}

// Eight frames after the light has jumped to another place, nothing of the old light is left: of the old picture less
// the new one, which noise knows nothing of, the denoised picture holds no part.
TEST_P(DenoiserOverTime, ALightThatJumpsLeavesNoGhostAfterEightFrames) {
    const FrameImages before = slidingWalls({160, 120});
    FrameImages after = slidingWalls({160, 120});
    const Extent maps = after.rsmFlux.extent();
    for (int y = 0; y < maps.heightPx; ++y)  // what was lit from one half is lit, four times as much, from the other
        for (int x = 0; x < maps.widthPx; ++x)
            for (int c = 0; c < 3; ++c) after.rsmFlux.pixel(x, y)[c] *= 2 * x < maps.widthPx ? 4.0f : 0.0f;
    Pipeline pipeline(device_);
    const auto see = [&](const FrameImages& frame, const Settings& settings, int frames) {
        FrameInputs inputs = frame.inputs();
        inputs.gbuffer.motion = {};
        pipeline.setFrame(inputs);
        for (int i = 0; i < frames; ++i) pipeline.run(settings);
        return colors(pipeline.read(Output::IndirectIrradiance));
    };
    Settings sum;
    sum.estimator = Estimator::Sum;
    const std::vector<glm::dvec3> oldLight = see(before, sum, 1), newLight = see(after, sum, 1);
    const auto ghostOf = [&](float antiLag, bool hasPast) {
        Settings settings = settingsOf(Preset::Balanced);
        settings.antiLag = antiLag;
        pipeline.forgetHistory();
        if (hasPast) see(before, settings, 40);
        const std::vector<glm::dvec3> picture = see(after, settings, 8);
        double shared = 0.0, all = 0.0;
        for (std::size_t i = 0; i < picture.size(); ++i) {
            const double change = luminanceOf(oldLight[i]) - luminanceOf(newLight[i]);
            shared += change * (luminanceOf(picture[i]) - luminanceOf(newLight[i]));
            all += change * change;
        }
        return shared / all;
    };
    const float antiLag = Settings().antiLag;
    // What the filter blurs of the new light looks like a bit of another: that part a picture without a past has too.
    const double blur = ghostOf(antiLag, false);
    EXPECT_LT(std::fabs(ghostOf(antiLag, true) - blur), 0.05);
    EXPECT_GT(ghostOf(0.0f, true) - blur, 0.5);
}

TEST_P(Denoiser, ALightThatGoesOutLeavesNoGhost) {
    const FrameImages lit = slidingWalls({53, 37});
    FrameImages dark = slidingWalls({53, 37});
    std::fill_n(dark.rsmFlux.data(), dark.rsmFlux.sizeBytes(), std::byte(0));
    const auto peakAfter = [&](float antiLag) {
        Pipeline pipeline(device_);
        Settings settings = fewSamples();
        settings.accumulates = true;
        settings.antiLag = antiLag;
        FrameInputs inputs = lit.inputs();
        inputs.gbuffer.motion = {};  // at rest: what moved in from the border would have no history to forget
        pipeline.setFrame(inputs);
        for (int i = 0; i < 16; ++i) pipeline.run(settings);
        inputs = dark.inputs();
        inputs.gbuffer.motion = {};
        pipeline.setFrame(inputs);
        for (int i = 0; i < 4; ++i) pipeline.run(settings);
        double peak = 0.0;
        for (const glm::dvec3& e : colors(pipeline.read(Output::IndirectIrradiance))) peak = std::max(peak, e.y);
        return peak;
    };
    EXPECT_GT(peakAfter(0.0f), 0.0);
    EXPECT_LT(peakAfter(16.0f), 0.02 * peakAfter(0.0f));
}

INSTANTIATE_TEST_SUITE_P(All, DenoiserOverTime, testing::ValuesIn(reference::defaultVariants()),
                         [](const auto& variant) { return variant.param.name; });
INSTANTIATE_TEST_SUITE_P(All, Denoiser, testing::ValuesIn(reference::quickVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
