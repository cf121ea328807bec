// `earthshine motion`: error and flicker of settings while the camera orbits, and what is left of a sun that has
// jumped.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <nlohmann/json.hpp>

#include "cli/camera_path.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/device_options.hpp"
#include "cli/frame_timing.hpp"
#include "cli/quality_list.hpp"
#include "cli/report.hpp"
#include "cli/scene_source.hpp"
#include "earthshine/error.hpp"
#include "image/json_text.hpp"
#include "image/metrics.hpp"
#include "image/output_set.hpp"
#include "raster/camera_fit.hpp"
#include "raster/gl/gl_context.hpp"
#include "raster/scene_renderer.hpp"

namespace earthshine::cli {

namespace {

struct MotionArguments {
    std::string list, out;
    Extent size{320, 180};
    int rsmSizePx = 512, shadowSizePx = 2048;
    std::string gl = "auto";
    int frameCount = 64;
    float orbitDegPerFrame = 0.5f;
    int jumpFrame = 0;  ///< 0 = the sun stays
    DeviceArguments device;
};

constexpr double kJumpDeg = 60.0;    // how far the sun's azimuth jumps
constexpr int kFramesAfterJump = 8;  // after so many there should be no ghost
// A pixel of the previous frame shows the same surface if its point lies within half a pixel's width of the plane
// through the reprojected one, and its normal is turned by less than 8 degrees (squared difference). What changes where
// another leaf comes into a pixel's middle is no flicker: it is the picture.
constexpr double kSamePlanePx = 0.5, kSameTurn = 0.02;

struct MotionRow {
    const QualitySetting* setting = nullptr;
    Series indirectMs, relMse, hdrFlip, flicker;
    std::optional<double> jumped, fresh;  ///< relMSE eight frames after the jump, with and without a past
};

float luminanceAt(const HostImage& image, int x, int y) {
    const float* p = image.pixel(x, y);
    return 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
}

/// The depth mask of a frame, for measureErrors.
HostImage surfaceMask(const HostImage& depth) {
    HostImage mask(PixelFormat::R32F, depth.extent());
    for (int y = 0; y < depth.extent().heightPx; ++y)
        for (int x = 0; x < depth.extent().widthPx; ++x) *mask.pixel(x, y) = *depth.pixel(x, y) > 0.0f ? 1.0f : 0.0f;
    return mask;
}

int surfacePixels(const HostImage& mask) {
    int pixels = 0;
    for (int y = 0; y < mask.extent().heightPx; ++y)
        for (int x = 0; x < mask.extent().widthPx; ++x) pixels += *mask.pixel(x, y) > 0.0f;
    return pixels;
}

/// What a frame saw, for the next one to find again.
struct Sight {
    Sight() = default;
    explicit Sight(const FrameImages& frame)
        : viewFromClip(glm::inverse(glm::dmat4(frame.camera.clipFromView))),
          worldFromView(glm::inverse(glm::dmat4(frame.camera.viewFromWorld))),
          depth(toFloat(frame.depth.view())),
          normalWs(toFloat(frame.normalWs.view())) {}

    /// The point at a place of the picture, px, and m along the camera's -z.
    glm::dvec3 pointWs(double x, double y, double z) const {
        const double xNdc = 2.0 * (x + 0.5) / depth.extent().widthPx - 1.0;
        const double yNdc = 1.0 - 2.0 * (y + 0.5) / depth.extent().heightPx;
        // Two points of the pixel's line, whatever the projection, then the one at that depth.
        glm::dvec4 a = viewFromClip * glm::dvec4(xNdc, yNdc, -0.5, 1.0),
                   b = viewFromClip * glm::dvec4(xNdc, yNdc, 0.5, 1.0);
        a /= a.w;
        b /= b.w;
        return glm::dvec3(worldFromView * glm::mix(a, b, (-z - a.z) / (b.z - a.z)));
    }
    glm::dvec3 normal(int x, int y) const {
        const float* n = normalWs.pixel(x, y);
        return {n[0], n[1], n[2]};
    }

    glm::dmat4 viewFromClip{1.0}, worldFromView{1.0};
    HostImage depth, normalWs;
};

/// The pixels whose surface the previous frame saw in the pixel that they come from.
struct Match {
    int x, y, previousX, previousY;
};
std::vector<Match> matchesOf(const Sight& now, const Sight& before, const HostImage& motion) {
    const Extent e = now.depth.extent();
    std::vector<Match> matches;
    for (int y = 0; y < e.heightPx; ++y) {
        for (int x = 0; x < e.widthPx; ++x) {
            const float* m = motion.pixel(x, y);
            const Match match{x, y, int(std::lround(float(x) + m[0])), int(std::lround(float(y) + m[1]))};
            if (!(*now.depth.pixel(x, y) > 0.0f) || match.previousX < 0 || match.previousY < 0 ||
                match.previousX >= e.widthPx || match.previousY >= e.heightPx)
                continue;
            const double depth = double(*now.depth.pixel(x, y) + m[2]);
            const double seen = double(*before.depth.pixel(match.previousX, match.previousY));
            const glm::dvec3 then = before.pointWs(double(x) + double(m[0]), double(y) + double(m[1]), depth);
            const glm::dvec3 there = before.pointWs(match.previousX, match.previousY, seen);
            const glm::dvec3 n = now.normal(x, y), turn = before.normal(match.previousX, match.previousY) - n;
            const double pixelM = glm::length(before.pointWs(1.0, 0.0, depth) - before.pointWs(0.0, 0.0, depth));
            if (seen > 0.0 && std::fabs(glm::dot(n, there - then)) <= kSamePlanePx * pixelM &&
                glm::dot(turn, turn) <= kSameTurn)
                matches.push_back(match);
        }
    }
    return matches;
}

/// Mean |now - before| of luminance over the matches, over the mean of `now` there.
double changeOf(const HostImage& now, const HostImage& before, const std::vector<Match>& matches) {
    double difference = 0.0, sum = 0.0;
    for (const Match& m : matches) {
        const double l = double(luminanceAt(now, m.x, m.y));
        difference += std::fabs(l - double(luminanceAt(before, m.previousX, m.previousY)));
        sum += l;
    }
    return sum > 0.0 ? difference / sum : 0.0;
}

double meanOf(const Series& series) {
    double sum = 0.0;
    for (double v : series.ms) sum += v;
    return series.ms.empty() ? 0.0 : sum / double(series.ms.size());
}

/// A setting at work: a pipeline with a past, and, after a jump, one without.
struct Runner {
    Runner(const Device& device, const QualitySetting& s) : pipeline(device) { row.setting = &s; }
    Pipeline pipeline;
    std::optional<Pipeline> fresh;
    HostImage before;
    MotionRow row;
};

struct MotionResult {
    const QualityScene* scene;
    std::vector<MotionRow> rows;
    double truthFlicker = 0.0;
    double countedShare = 0.0;  ///< of the pixels that see a surface, those that count for flicker
};

MotionResult measureScene(const QualityScene& scene, const QualityList& list, const MotionArguments& arguments,
                          raster::GlContext& context, const Device& device) {
    const raster::Scene loaded = loadScene(scene.file.string());
    const Camera start = raster::cameraFor(loaded, scene.camera, arguments.size);
    const glm::dvec3 pivot = orbitPivot(start, loaded);
    std::optional<raster::Sun> sun = scene.sun;
    if (!sun)
        for (const raster::SceneLight& light : loaded.lights)
            if (light.type == raster::SceneLightType::Directional) sun = raster::sunOf(light);
    raster::SceneRenderer renderer(context, loaded);
    const raster::RasterSettings settings{arguments.size, arguments.rsmSizePx, arguments.shadowSizePx, glm::vec3(0.0f)};

    Pipeline truth(device);
    Settings fullSum;
    fullSum.estimator = Estimator::Sum;
    std::vector<std::unique_ptr<Runner>> runners;
    for (const QualitySetting& setting : list.settings) runners.push_back(std::make_unique<Runner>(device, setting));

    MotionResult result{&scene, {}, 0.0, 0.0};
    Camera previous = start;
    Sight sightBefore;
    HostImage truthBefore;
    Series truthFlicker, counted;
    Progress progress(scene.name);
    for (int i = 0; i < arguments.frameCount; ++i) {
        const bool hasJumped = arguments.jumpFrame > 0 && i >= arguments.jumpFrame;
        raster::LightOptions lightOptions{scene.sun, {}, i == 0};
        if (hasJumped) lightOptions.sun = movedSun(sun.value_or(raster::Sun()), {kJumpDeg, 0.0, {}}, 1.0);
        const std::vector<Light> lights = raster::fitLights(loaded, lightOptions);
        const Camera camera = i == 0 ? start : orbited(start, pivot, i * double(arguments.orbitDegPerFrame));
        const FrameImages images =
            readBack(renderer.render(camera, previous, lights, settings), camera, lights, context.getProcAddress());
        previous = camera;
        const HostImage mask = surfaceMask(images.depth);
        Sight sight(images);
        CompareOptions compare;
        compare.mask = mask.view();

        truth.setFrame(images.inputs());
        truth.run(fullSum);
        HostImage expected = truth.read(Output::IndirectIrradiance);
        const bool isContinuous = i > 0 && i != arguments.jumpFrame;
        std::vector<Match> matches;
        if (isContinuous) {
            matches = matchesOf(sight, sightBefore, toFloat(images.motion.view()));
            truthFlicker.ms.push_back(changeOf(expected, truthBefore, matches));
            counted.ms.push_back(double(matches.size()) / double(std::max(surfacePixels(mask), 1)));
        }
        for (const auto& runner : runners) {
            runner->pipeline.setFrame(images.inputs());
            runner->pipeline.run(runner->row.setting->settings);
            HostImage picture = runner->pipeline.read(Output::IndirectIrradiance);
            const PictureErrors errors = measureErrors(picture.view(), expected.view(), compare);
            MotionRow& row = runner->row;
            row.relMse.ms.push_back(errors.relMse);
            row.hdrFlip.ms.push_back(errors.hdrFlipMean);
            if (i > 0) row.indirectMs.ms.push_back(indirectMs(runner->pipeline.stageTimes()));
            if (isContinuous) row.flicker.ms.push_back(changeOf(picture, runner->before, matches));
            if (hasJumped && i < arguments.jumpFrame + kFramesAfterJump) {
                if (!runner->fresh) runner->fresh.emplace(device);
                runner->fresh->setFrame(images.inputs());
                runner->fresh->run(row.setting->settings);
                if (i == arguments.jumpFrame + kFramesAfterJump - 1) {
                    row.jumped = errors.relMse;
                    const HostImage clean = runner->fresh->read(Output::IndirectIrradiance);
                    row.fresh = measureErrors(clean.view(), expected.view(), compare).relMse;
                }
            }
            runner->before = std::move(picture);
        }
        sightBefore = std::move(sight);
        truthBefore = std::move(expected);
        progress.update((i + 1.0) / arguments.frameCount);
    }
    for (const auto& runner : runners) result.rows.push_back(std::move(runner->row));
    result.truthFlicker = meanOf(truthFlicker);
    result.countedShare = meanOf(counted);
    return result;
}

std::string tableOf(const MotionResult& result, const MotionArguments& arguments) {
    std::string text = fmt::format(
        "\n## {}, orbit of {} degrees a frame\n\nThe full sum's own flicker: {:.4f}, over {:.1f} % of the pixels.\n\n"
        "| setting | ms | relMSE | HDR-FLIP | flicker |{}\n|---|---:|---:|---:|---:|{}\n",
        result.scene->name, arguments.orbitDegPerFrame, result.truthFlicker, 100.0 * result.countedShare,
        arguments.jumpFrame > 0 ? " relMSE 8 frames after the sun jumped | with no past |" : "",
        arguments.jumpFrame > 0 ? "---:|---:|" : "");
    for (const MotionRow& row : result.rows) {
        text += fmt::format("| {} | {:.2f} | {:.4g} | {:.4f} | {:.4f} |", row.setting->label, row.indirectMs.median(),
                            meanOf(row.relMse), meanOf(row.hdrFlip), meanOf(row.flicker));
        if (row.jumped) text += fmt::format(" {:.4g} | {:.4g} |", *row.jumped, *row.fresh);
        text += '\n';
    }
    return text;
}

nlohmann::ordered_json jsonOf(const MotionResult& result) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const MotionRow& row : result.rows) {
        nlohmann::ordered_json json = {{"setting", row.setting->label},
                                       {"indirectMs", row.indirectMs.median()},
                                       {"relMse", row.relMse.ms},
                                       {"hdrFlip", row.hdrFlip.ms},
                                       {"flicker", row.flicker.ms}};
        if (row.jumped) {
            json["relMseAfterJump"] = *row.jumped;
            json["relMseWithoutPast"] = *row.fresh;
        }
        rows.push_back(std::move(json));
    }
    return {{"scene", result.scene->name},
            {"fullSumFlicker", result.truthFlicker},
            {"flickerPixels", result.countedShare},
            {"rows", std::move(rows)}};
}

void measureMotion(const MotionArguments& arguments) {
    if (arguments.jumpFrame > 0 && arguments.jumpFrame + kFramesAfterJump > arguments.frameCount)
        throw UsageError(fmt::format("--jump: {} leaves less than {} of {} frames", arguments.jumpFrame,
                                     kFramesAfterJump, arguments.frameCount));
    const QualityList list = readQualityList(arguments.list);
    OutputSet outputs;
    const auto file = outputs.addFile(arguments.out);
    const DeviceChoice choice = chooseDevice(arguments.device);
    const std::unique_ptr<raster::GlContext> context = raster::createContext(arguments.gl);
    const Device device(choice.caps, arguments.device.options);

    nlohmann::ordered_json json = {{"program", programVersion()},
                                   {"command", "motion"},
                                   {"list", arguments.list},
                                   {"size", {arguments.size.widthPx, arguments.size.heightPx}},
                                   {"frames", arguments.frameCount},
                                   {"orbit", arguments.orbitDegPerFrame},
                                   {"jump", arguments.jumpFrame},
                                   {"device", capsJson(device.caps())},
                                   {"scenes", nlohmann::ordered_json::array()}};
    fmt::print(
        "Means over {} frames of {}x{} against the full sum of each frame; flicker: mean change of luminance from a "
        "frame to "
        "the next where both see the same surface, over the mean. {}, {}.\n",
        arguments.frameCount, arguments.size.widthPx, arguments.size.heightPx, programVersion(), device.caps().name);
    for (const QualityScene& scene : list.scenes) {
        const MotionResult result = measureScene(scene, list, arguments, *context, device);
        fmt::print("{}", tableOf(result, arguments));
        std::fflush(stdout);  // scenes take minutes
        json["scenes"].push_back(jsonOf(result));
    }
    std::ofstream stream(file, std::ios::binary);
    stream << readableJson(json) << std::flush;
    if (!stream) throw Error(fmt::format("{}: cannot be written", arguments.out));
    outputs.commit();
}

}  // namespace

void addMotion(Options& program) {
    const auto arguments = std::make_shared<MotionArguments>();
    Options options =
        program.command("motion", "Measure errors and flicker along an orbit, and ghosts of a sun that jumps",
                        [arguments] { measureMotion(*arguments); });
    options.positional("list", arguments->list, "a JSON file of scenes and settings, as data/motion.json");
    options.text("-o,--out", "FILE", arguments->out, "JSON file of every frame's numbers", true);
    options.option("--size", "WxH", "320x180", "width and height of the pictures",
                   [arguments](const std::string& text) { arguments->size = parseExtent(text, 4096); });
    options.option("--rsm-size", "N", "512", "side of each light's reflective shadow map, px",
                   [arguments](const std::string& text) { arguments->rsmSizePx = parseInt(text, 1, 16384); });
    options.option("--shadow-size", "N", "2048", "side of each light's shadow map, px",
                   [arguments](const std::string& text) { arguments->shadowSizePx = parseInt(text, 1, 16384); });
    options.text("--gl", "TEXT", arguments->gl, "where OpenGL comes from: auto, egl, egl-device[:N] or osmesa");
    options.option("--frames", "N", "64", "frames of the orbit",
                   [arguments](const std::string& text) { arguments->frameCount = parseInt(text, 2, 10000); });
    options.option("--orbit", "DEG", "0.5", "degrees a frame", [arguments](const std::string& text) {
        arguments->orbitDegPerFrame = parseFloat(text, -90.0, 90.0);
    });
    options.option(
        "--jump", "FRAME", "",
        "the sun's azimuth jumps by 60 degrees at this frame; a scene without a sun gets one then [it stays]",
        [arguments](const std::string& text) { arguments->jumpFrame = parseInt(text, 1, 10000); });
    addDeviceOptions(options, arguments->device);
}

}  // namespace earthshine::cli
