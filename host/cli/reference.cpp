// `earthshine reference`: the truth about a scene, by tracing paths.

#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/raster_settings.hpp"
#include "cli/report.hpp"
#include "cli/scene_source.hpp"
#include "cli/trace_run.hpp"
#include "earthshine/error.hpp"
#include "earthshine/log.hpp"
#include "image/json_text.hpp"
#include "image/output_set.hpp"
#include "raster/camera_fit.hpp"

namespace fs = std::filesystem;

namespace earthshine::cli {

namespace {

constexpr int kDefaultSamples = 256;
constexpr int kMostSamples = 1 << 30;

struct ReferenceArguments {
    std::string scene, out, report, resume;
    RasterSettings raster;  ///< what of it the path tracer shares: isShared()
    trace::TraceSettings trace;
    bool noIndirectVisibility = false;
    TraceBudget budget;
};

/// The settings of the rasterizer that mean something without maps and GL.
bool isShared(const SettingInfo& info) {
    const std::string_view name = info.name;
    return name == "size" || name == "camera" || name == "sun" || name == "background";
}

std::string bouncesText(int bounces) {
    return bounces == trace::kAllBounces ? "all" : std::to_string(bounces);
}

nlohmann::ordered_json settingsJson(const ReferenceArguments& arguments, const trace::TraceSettings& settings) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    forEachRasterSetting(arguments.raster, [&](const SettingInfo& info, const auto& value) {
        if (isShared(info)) json[info.name] = settingJson(info, value);
    });
    json["bounces"] = bouncesText(settings.bounceCount);
    json["indirectVisibility"] = settings.indirectVisibility;
    json["emission"] = settings.emission;
    json["seed"] = settings.seed;
    json["threads"] = settings.threads;
    return json;
}

/// Sums of earlier runs: taken up if they are there, and put back in their place whole.
class ResumeFile {
public:
    explicit ResumeFile(fs::path path) : path_(std::move(path)) {
        if (!path_.empty()) OutputSet().addFile(path_);  // refuses now what could not be written later
    }
    void load(trace::PathTracer& tracer) const {
        if (path_.empty() || !fs::exists(path_)) return;
        tracer.loadState(path_.string());
        log(LogLevel::Info, fmt::format("{}: goes on from {} samples", path_.string(), tracer.sampleCount()));
    }
    void save(const trace::PathTracer& tracer) const {
        if (path_.empty()) return;
        OutputSet outputs;
        tracer.saveState(outputs.addFile(path_).string());
        outputs.commit();
    }

private:
    fs::path path_;
};

void writeText(const fs::path& temporary, const std::string& path, const std::string& text) {
    std::ofstream stream(temporary, std::ios::binary);
    stream << text << std::flush;
    if (!stream) throw Error(fmt::format("{}: cannot be written", path));
}

void traceReference(const ReferenceArguments& arguments) {
    if (fs::path(arguments.out).extension() != ".exr")
        throw UsageError(fmt::format("--out: '{}' must end in .exr", arguments.out));
    if (!arguments.report.empty() && fs::path(arguments.report).extension() != ".json")
        throw UsageError(fmt::format("--report: '{}' must end in .json", arguments.report));
    OutputSet outputs;
    const fs::path out = outputs.addFile(arguments.out);
    const fs::path reportFile = arguments.report.empty() ? fs::path() : outputs.addFile(arguments.report);
    const ResumeFile resume(arguments.resume);

    trace::TraceSettings settings = arguments.trace;
    settings.extent = arguments.raster.size;
    settings.background = arguments.raster.background;
    settings.indirectVisibility = !arguments.noIndirectVisibility;
    TraceBudget budget = arguments.budget;
    if (budget.samples == 0 && budget.seconds == 0.0 && budget.relMse == 0.0) budget.samples = kDefaultSamples;

    const raster::Scene scene = loadScene(arguments.scene);
    const Camera camera = raster::cameraFor(scene, arguments.raster.camera, arguments.raster.size);
    const std::vector<Light> lights = raster::fitLights(scene, {arguments.raster.sun});
    trace::PathTracer tracer(scene, camera, lights, settings);
    resume.load(tracer);
    std::string stoppedBy;
    {
        Progress progress("tracing");
        stoppedBy = spend(
            tracer, budget, [&](double part) { progress.update(part); }, [&] { resume.save(tracer); });
    }
    resume.save(tracer);

    const trace::TraceNoise noise = tracer.noise();
    const trace::RayCount rays = tracer.rays();
    const std::size_t nonFinite =
        writeTraced(out, tracer,
                    {{"earthshine:bounces", bouncesText(settings.bounceCount)},
                     {"earthshine:indirectVisibility", std::string(settings.indirectVisibility ? "on" : "off")},
                     {"earthshine:samples", float(tracer.sampleCount())},
                     {"earthshine:noiseRelMse", float(noise.relMse)}});
    if (nonFinite > 0) log(LogLevel::Warning, fmt::format("{}: {} values are not finite", arguments.out, nonFinite));
    if (!reportFile.empty()) {
        nlohmann::ordered_json report = {{"program", programVersion()}, {"command", "reference"}};
        report["scene"] = sceneJson(arguments.scene, scene, lights);
        report["settings"] = settingsJson(arguments, settings);
        report["budget"] = {{"samples", budget.samples}, {"seconds", budget.seconds}, {"relMse", budget.relMse}};
        report["stoppedBy"] = stoppedBy;
        report.update(tracedJson(tracer));
        report["nonFinite"] = nonFinite;
        report["outputs"] = {arguments.out};
        writeText(reportFile, arguments.report, readableJson(report));
    }
    outputs.commit();
    fmt::print("samples     {} a pixel, {} surface pixels, {} bounces{}\n", tracer.sampleCount(),
               tracer.surfacePixels(), bouncesText(settings.bounceCount),
               settings.indirectVisibility ? "" : ", nothing in the way");
    fmt::print("noise left  relMSE {:.3g}, mean {:.3g} % (stopped by {})\n", noise.relMse, 100 * noise.meanError,
               stoppedBy);
    fmt::print("rays        {:.1f} million in {:.1f} s: {:.2f} million a second\n", double(rays.total()) * 1e-6,
               rays.seconds, double(rays.total()) * 1e-6 / std::max(rays.seconds, 1e-9));
    for (const auto& path : outputs.paths()) fmt::print("wrote {}\n", path.string());
}

void addBudgetOptions(Options& options, TraceBudget& budget) {
    options.group("Budget (whatever comes first ends it)");
    options.option("--spp", "N", std::to_string(kDefaultSamples), "samples a pixel, those of --resume included",
                   [&budget](const std::string& text) { budget.samples = parseInt(text, 1, kMostSamples); });
    options.option("--time", "S", "", "seconds",
                   [&budget](const std::string& text) { budget.seconds = double(parseFloat(text, 1e-3, 1e7, "s")); });
    options.option("--until-relmse", "X", "", "relative mean squared error that is left, by its own estimate",
                   [&budget](const std::string& text) { budget.relMse = double(parseFloat(text, 1e-12, 1e3)); });
}

}  // namespace

void addReference(Options& program) {
    const auto arguments = std::make_shared<ReferenceArguments>();
    Options options =
        program.command("reference", "Trace the truth about a glTF scene", [arguments] { traceReference(*arguments); });
    options.positional("scene", arguments->scene, "a .gltf or .glb file");
    options.group("Files");
    options.text("-o,--out", "FILE", arguments->out, "picture.exr, with a layer for every part of the light", true);
    options.text("--report", "FILE", arguments->report, "a JSON file with settings, noise and rays");
    options.text("--resume", "FILE", arguments->resume, "keep the sums here, and go on from them if they are there");
    options.group("Scene");
    forEachRasterSetting(arguments->raster, [&options](const SettingInfo& info, auto& value) {
        if (isShared(info)) addSetting(options, info, value);
    });
    options.group("Light");
    options.option("--bounces", "N|all", "1", "diffuse bounces after the direct light; all = until a path dies",
                   [arguments](const std::string& text) {
                       arguments->trace.bounceCount = text == "all" ? trace::kAllBounces : parseInt(text, 0, 1000);
                   });
    options.flag("--no-indirect-visibility", arguments->noIndirectVisibility,
                 "nothing stands in the way of a bounce: what a reflective shadow map estimates");
    options.flag("--emission", arguments->trace.emission,
                 "show what surfaces emit (it lights nothing), as render does");
    options.option("--seed", "N", "0", "of the random numbers", [arguments](const std::string& text) {
        arguments->trace.seed = std::uint32_t(parseInt(text, 0, std::numeric_limits<int>::max()));
    });
    options.option("--threads", "N", "0", "0 = one a core; the picture is the same",
                   [arguments](const std::string& text) { arguments->trace.threads = parseInt(text, 0, 1024); });
    addBudgetOptions(options, arguments->budget);
}

}  // namespace earthshine::cli
