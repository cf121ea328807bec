// `earthshine quality`: every estimator's error against the truth, over scenes and settings, in one table.

#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/device_options.hpp"
#include "cli/frame_timing.hpp"
#include "cli/picture_source.hpp"
#include "cli/quality_list.hpp"
#include "cli/quality_report.hpp"
#include "cli/report.hpp"
#include "cli/scene_source.hpp"
#include "cli/trace_run.hpp"
#include "earthshine/error.hpp"
#include "earthshine/log.hpp"
#include "image/json_text.hpp"
#include "image/output_set.hpp"
#include "raster/camera_fit.hpp"
#include "raster/gl/gl_context.hpp"
#include "raster/scene_renderer.hpp"
#include "raster/trace/trace_state.hpp"

namespace fs = std::filesystem;

namespace earthshine::cli {

namespace {

struct QualityArguments {
    std::string list, out, cache;
    Extent size{320, 180};
    int rsmSizePx = 512, shadowSizePx = 2048;
    std::string gl = "auto";
    float noise = 1e-3f;
    int mostSamples = 16384;
    int repeats = 5;
    DeviceArguments device;
};

/// A scene, ready to be drawn and traced.
struct Subject {
    raster::Scene scene;
    Camera camera;
    std::vector<Light> lights;
};

/// What the path tracer says, from the cache or anew.
struct Truth {
    QualityTruth summary;
    LoadedPicture indirect, direct;
};

std::string cacheName(const std::string& scene, Extent size, std::uint64_t fingerprint, bool visibility) {
    return fmt::format("{}-{}x{}-{}-{:016x}.exr", scene, size.widthPx, size.heightPx,
                       visibility ? "one-bounce" : "unoccluded", fingerprint);
}

float attributeOf(const fs::path& sidecar, const char* key) {
    std::ifstream stream(sidecar);
    const auto json = nlohmann::json::parse(stream, nullptr, false);
    return json.is_object() && json.contains(key) && json[key].is_number() ? json[key].get<float>() : -1.0f;
}

Truth truthOf(const Subject& subject, const QualityScene& scene, bool visibility, const QualityArguments& arguments,
              const fs::path& cache) {
    trace::TraceSettings settings;
    settings.extent = arguments.size;
    settings.indirectVisibility = visibility;
    const std::uint64_t fingerprint = trace::fingerprintOf(subject.scene, subject.camera, subject.lights, settings);
    const fs::path file = cache / cacheName(scene.name, arguments.size, fingerprint, visibility);
    const fs::path sidecar = fs::path(file).replace_extension(".json");
    const float cachedNoise = fs::exists(file) ? attributeOf(sidecar, "noiseRelMse") : -1.0f;
    const bool isGood = cachedNoise >= 0.0f && (cachedNoise <= arguments.noise ||
                                                attributeOf(sidecar, "samples") >= float(arguments.mostSamples));
    if (!isGood) {
        trace::PathTracer tracer(subject.scene, subject.camera, subject.lights, settings);
        {
            Progress progress(
                fmt::format("{}: tracing the truth{}", scene.name, visibility ? "" : " without indirect visibility"));
            spend(tracer, {arguments.mostSamples, 0.0, double(arguments.noise)},
                  [&](double part) { progress.update(part); });
        }
        OutputSet outputs;
        writeTraced(outputs.addFile(file), tracer, {});
        std::ofstream(outputs.addFile(sidecar))
            << readableJson({{"samples", tracer.sampleCount()}, {"noiseRelMse", tracer.noise().relMse}});
        outputs.commit();
    }
    Truth truth;
    truth.summary.noiseRelMse = double(attributeOf(sidecar, "noiseRelMse"));
    truth.summary.samples = int(attributeOf(sidecar, "samples"));
    truth.indirect = loadPicture(file, "indirect-irradiance");
    truth.direct = loadPicture(file, "direct-irradiance");
    return truth;
}

/// 1 where both halves see a surface: at silhouettes a pixel may be either's sky.
HostImage surfaceMask(const HostImage& truthDepth, const HostImage& rasterDepth) {
    HostImage mask(PixelFormat::R32F, truthDepth.extent());
    const auto [width, height] = mask.extent();
    for (int i = 0; i < width * height; ++i)
        mask.pixel(0, 0)[i] = truthDepth.pixel(0, 0)[i] > 0.0f && rasterDepth.pixel(0, 0)[i] > 0.0f ? 1.0f : 0.0f;
    return mask;
}

double medianMs(std::vector<double> ms) {
    return Series{std::move(ms)}.median();
}

/// The pictures of one setting, and its times over some runs.
struct Run {
    HostImage indirect, direct;
    double estimatorMs = 0, frameMs = 0;
};

Run runSetting(Pipeline& pipeline, const QualitySetting& setting, int repeats, const std::string& title) {
    std::vector<double> estimator, frame;
    Progress progress(title);
    // A setting of one frame is run several times to be timed, each as if it were the first.
    const int runs = setting.frames > 1 ? setting.frames : repeats + 1;
    pipeline.forgetHistory();
    for (int i = 0; i < runs; ++i) {
        if (setting.frames == 1) pipeline.forgetHistory();
        pipeline.run(setting.settings, [&](double part) { progress.update((i + part) / runs); });
        if (i == 0) continue;  // compiles
        double all = 0.0;
        for (const StageTime& stage : pipeline.stageTimes()) all += stage.ms;
        estimator.push_back(indirectMs(pipeline.stageTimes()));
        frame.push_back(all);
    }
    return {pipeline.read(Output::IndirectIrradiance), pipeline.read(Output::DirectIrradiance),
            medianMs(std::move(estimator)), medianMs(std::move(frame))};
}

QualityResult measureScene(const QualityScene& scene, const QualityList& list, const QualityArguments& arguments,
                           const fs::path& cache, raster::GlContext& context, Pipeline& pipeline) {
    Subject subject;
    subject.scene = loadScene(scene.file.string());
    subject.camera = raster::cameraFor(subject.scene, scene.camera, arguments.size);
    subject.lights = raster::fitLights(subject.scene, {scene.sun});
    const Truth unoccluded = truthOf(subject, scene, false, arguments, cache);
    const Truth oneBounce = truthOf(subject, scene, true, arguments, cache);

    raster::SceneRenderer renderer(context, subject.scene);
    const GlFrame textures =
        renderer.render(subject.camera, subject.camera, subject.lights,
                        {arguments.size, arguments.rsmSizePx, arguments.shadowSizePx, glm::vec3(0.0f)});
    const FrameImages images = readBack(textures, subject.camera, subject.lights, context.getProcAddress());
    pipeline.setFrame(images.inputs());
    const HostImage mask = surfaceMask(oneBounce.indirect.skyMask, images.depth);
    CompareOptions options;
    options.mask = mask.view();

    QualityResult result{&scene, unoccluded.summary, oneBounce.summary, {}, {}};
    HostImage converged;
    for (const QualitySetting& setting : list.settings) {
        // The full sum takes as long as a hundred gathers, and as long every time.
        const int repeats = setting.settings.estimator == Estimator::Sum ? 1 : arguments.repeats;
        Run run = runSetting(pipeline, setting, repeats, fmt::format("{}: {}", scene.name, setting.label));
        QualityRow row{&setting,
                       run.estimatorMs,
                       run.frameMs,
                       {},
                       measureErrors(run.indirect.view(), unoccluded.indirect.pixels.view(), options),
                       measureErrors(run.indirect.view(), oneBounce.indirect.pixels.view(), options)};
        log(LogLevel::Info, fmt::format("{}: {}: mean {:+.2f} %, relMSE {:.3g}, {:.2f} ms", scene.name, setting.label,
                                        100 * row.unoccluded.meanError, row.unoccluded.relMse, row.estimatorMs));
        if (!converged.empty()) row.converged = measureErrors(run.indirect.view(), converged.view(), options);
        result.rows.push_back(std::move(row));
        if (&setting == &list.settings.back())
            result.direct = measureErrors(run.direct.view(), oneBounce.direct.pixels.view(), options);
        if (setting.settings.estimator == Estimator::Sum && setting.settings.rsmMinify == 1)
            converged = std::move(run.indirect);
    }
    result.unoccluded.mean = result.rows.front().unoccluded.referenceMean;
    result.oneBounce.mean = result.rows.front().oneBounce.referenceMean;
    return result;
}

/// Files of one folder, announced before the work and written after it.
class ReportFolder {
public:
    ReportFolder(const fs::path& folder, const QualityList& list) {
        std::error_code error;
        fs::create_directories(folder, error);
        if (error) throw Error(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
        json_ = outputs_.addFile(folder / "quality.json");
        markdown_ = outputs_.addFile(folder / "quality.md");
        for (const QualityScene& scene : list.scenes) {
            plots_.push_back(outputs_.addFile(folder / fmt::format("{}-ms.svg", scene.name)));
            plots_.push_back(outputs_.addFile(folder / fmt::format("{}-samples.svg", scene.name)));
        }
    }
    void write(const nlohmann::ordered_json& json, const std::string& markdown,
               const std::vector<QualityResult>& results) {
        put(json_, readableJson(json));
        put(markdown_, markdown);
        for (std::size_t i = 0; i < results.size(); ++i) {
            put(plots_[2 * i], svgOf(errorAgainstMs(results[i])));
            put(plots_[2 * i + 1], svgOf(errorAgainstSamples(results[i])));
        }
        outputs_.commit();
    }
    std::vector<fs::path> paths() const { return outputs_.paths(); }

private:
    static void put(const fs::path& path, const std::string& text) {
        std::ofstream stream(path, std::ios::binary);
        stream << text << std::flush;
        if (!stream) throw Error(fmt::format("{}: cannot be written", path.string()));
    }
    OutputSet outputs_;
    fs::path json_, markdown_;
    std::vector<fs::path> plots_;
};

void measureQuality(const QualityArguments& arguments) {
    const QualityList list = readQualityList(arguments.list);
    ReportFolder folder(arguments.out, list);
    const fs::path cache = arguments.cache.empty() ? fs::path(arguments.out) / "references" : fs::path(arguments.cache);
    fs::create_directories(cache);
    const DeviceChoice choice = chooseDevice(arguments.device);
    const std::unique_ptr<raster::GlContext> context = raster::createContext(arguments.gl);
    const Device device(choice.caps, arguments.device.options);
    Pipeline pipeline(device);

    std::vector<QualityResult> results;
    for (const QualityScene& scene : list.scenes)
        results.push_back(measureScene(scene, list, arguments, cache, *context, pipeline));

    const std::string heading = fmt::format("{}, {} ({}), {}x{} pixels, RSMs of {} texels a side.", programVersion(),
                                            device.caps().name, device.caps().platformVersion, arguments.size.widthPx,
                                            arguments.size.heightPx, arguments.rsmSizePx);
    const nlohmann::ordered_json json = {{"program", programVersion()},
                                         {"command", "quality"},
                                         {"list", arguments.list},
                                         {"size", {arguments.size.widthPx, arguments.size.heightPx}},
                                         {"rsmSize", arguments.rsmSizePx},
                                         {"shadowSize", arguments.shadowSizePx},
                                         {"device", capsJson(device.caps())},
                                         {"scenes", qualityJson(results)}};
    const std::string markdown = qualityMarkdown(results, heading);
    folder.write(json, markdown, results);
    fmt::print("{}", markdown);
    for (const auto& path : folder.paths()) fmt::print("wrote {}\n", path.string());
}

}  // namespace

void addQuality(Options& program) {
    const auto arguments = std::make_shared<QualityArguments>();
    Options options = program.command("quality", "Measure errors against the truth over scenes and settings",
                                      [arguments] { measureQuality(*arguments); });
    options.positional("list", arguments->list, "a JSON file of scenes and settings, as data/quality.json");
    options.text("-o,--out", "DIR", arguments->out, "folder for quality.md, quality.json and plots", true);
    options.text("--cache", "DIR", arguments->cache, "folder that keeps references for the next time [DIR/references]");
    options.option("--size", "WxH", "320x180", "width and height of the pictures",
                   [arguments](const std::string& text) { arguments->size = parseExtent(text, 4096); });
    options.option("--rsm-size", "N", "512", "side of each light's reflective shadow map, px",
                   [arguments](const std::string& text) { arguments->rsmSizePx = parseInt(text, 1, 16384); });
    options.option("--shadow-size", "N", "2048", "side of each light's shadow map, px",
                   [arguments](const std::string& text) { arguments->shadowSizePx = parseInt(text, 1, 16384); });
    options.text("--gl", "TEXT", arguments->gl, "where OpenGL comes from: auto, egl, egl-device[:N] or osmesa");
    options.option("--noise", "X", "0.001", "relMSE that references may keep",
                   [arguments](const std::string& text) { arguments->noise = parseFloat(text, 1e-9, 1.0); });
    options.option("--max-spp", "N", "16384", "samples a pixel at which references stop all the same",
                   [arguments](const std::string& text) { arguments->mostSamples = parseInt(text, 2, 1 << 30); });
    options.option("--repeats", "N", "5", "timed runs of each setting",
                   [arguments](const std::string& text) { arguments->repeats = parseInt(text, 1, 1000); });
    addDeviceOptions(options, arguments->device);
}

}  // namespace earthshine::cli
