// `earthshine render`: a glTF scene through both halves, OpenGL and OpenCL, to pictures.

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/device_options.hpp"
#include "cli/frame_files.hpp"
#include "cli/raster_settings.hpp"
#include "cli/report.hpp"
#include "cli/scene_source.hpp"
#include "cli/sequence.hpp"
#include "cli/sequence_files.hpp"
#include "earthshine/log.hpp"
#include "image/inputs_folder.hpp"
#include "image/json_text.hpp"
#include "raster/gl/gl_context.hpp"
#include "raster/scene_renderer.hpp"

namespace earthshine::cli {

namespace {

constexpr const char* kTransportNames[] = {"auto", "host"};

struct RenderArguments {
    std::string scene;
    RasterSettings raster;
    Settings settings;
    SequenceArguments sequence;
    int transport = 0;  ///< into kTransportNames; both are the host's memory
    DeviceArguments device;
    FrameFileArguments files;
    std::string saveInputs;
};

void renderScene(const RenderArguments& arguments) {
    // From the start of the process to the first pixel: what each part took, in order.
    nlohmann::ordered_json start = {{"untilCommandMs", processMs()}};
    auto note = [&start, watch = Stopwatch()](const char* part) mutable {
        start[part] = watch.ms();
        watch = Stopwatch();
    };
    // What can be refused is refused before anything slow is done.
    OutputSet outputs;
    Sequence sequence(arguments.sequence);
    const int frameCount = arguments.sequence.frameCount, firstFrame = arguments.sequence.firstFrame;
    SequenceFiles files(arguments.files, arguments.sequence.film, firstFrame, frameCount, outputs);
    const auto inputsFolder =
        arguments.saveInputs.empty() ? std::filesystem::path() : outputs.addFolder(arguments.saveInputs, kInputsFile);
    validate(arguments.settings);
    const DeviceChoice choice = chooseDevice(arguments.device);
    note("devicesMs");

    // The GL context outlives everything of OpenCL's: drivers that share objects between the two insist on it.
    const std::unique_ptr<raster::GlContext> context = raster::createContext(arguments.raster.gl);
    note("glContextMs");

    const Stopwatch load;
    raster::Scene scene = loadScene(arguments.scene);
    sequence.begin(scene, arguments.raster);
    const std::vector<int> movedInstances = sequence.movedInstances();
    const double loadMs = load.ms();
    note("sceneMs");

    raster::SceneRenderer renderer(*context, scene);
    note("uploadMs");
    const Device device(choice.caps, arguments.device.options);
    Pipeline pipeline(device);
    note("pipelineMs");
    log(LogLevel::Info, "transport host: textures are read back into memory that OpenCL uses in place");

    FrameImages images;
    FrameTiming timing;
    std::vector<Light> lights;
    files.begin(arguments.raster.size, double(arguments.sequence.framesPerSecond));
    {
        Progress progress("rendering");
        Camera previousCamera = sequence.frame(0).camera;
        const int warmupCount = arguments.sequence.warmupCount();
        for (int i = -warmupCount; i < frameCount; ++i) {
            if (i == firstFrame && i > -warmupCount) timing.clear();
            const Stopwatch whole, draw;
            const SequenceFrame& frame = sequence.frame(std::max(i, 0));
            for (const int instance : movedInstances)
                renderer.setWorldFromObject(instance, scene.instances[std::size_t(instance)].worldFromObject);
            const GlFrame textures = renderer.render(frame.camera, previousCamera, frame.lights,
                                                     {arguments.raster.size, arguments.raster.rsmSizePx,
                                                      arguments.raster.shadowSizePx, arguments.raster.background});
            context->gl().Finish();
            timing.addStep("raster", draw.ms());

            const Stopwatch read;
            images = readBack(textures, frame.camera, frame.lights, context->getProcAddress());
            timing.addStep("read back", read.ms());
            if (i == -warmupCount) files.check(images.inputs());

            const Stopwatch compute;
            pipeline.setFrame(images.inputs());
            pipeline.run(arguments.settings,
                         [&](double part) { progress.update((i + warmupCount + part) / (frameCount + warmupCount)); });
            timing.addStep("compute", compute.ms());
            if (i == -warmupCount) {
                note("firstFrameMs");
                start["firstPixelMs"] = processMs();
            }
            timing.addStep("frame", whole.ms());
            timing.addStages(pipeline.stageTimes());
            if (i >= firstFrame) files.write(i, pipeline, images.inputs());
            previousCamera = frame.camera;
            lights = frame.lights;
        }
    }

    const FrameInputs frame = images.inputs();
    const auto paths = files.paths();
    if (!inputsFolder.empty()) writeInputs(inputsFolder, frame);

    nlohmann::ordered_json report = {{"program", programVersion()}, {"command", "render"}};
    report["scene"] = sceneJson(arguments.scene, scene, lights);
    report["raster"] = nlohmann::ordered_json::object();
    forEachRasterSetting(arguments.raster, [&](const SettingInfo& info, const auto& value) {
        report["raster"][info.name] = settingJson(info, value);
    });
    const raster::GlDescription& gl = context->description();
    report["gl"] = {
        {"platform", gl.platform}, {"vendor", gl.vendor}, {"renderer", gl.renderer}, {"version", gl.version}};
    report["sequence"] = sequenceJson(arguments.sequence);
    report["transport"] = "host";
    report["loadMs"] = loadMs;
    report["start"] = start;
    addFrame(report, {device, choice.why, arguments.settings, timing, frameCount, pipeline.exposure(),
                      pipeline.gatheredPixels(), files.nonFinite(), paths});
    files.finish(readableJson(report));
    outputs.commit();
    fmt::print("scene       {}: {} triangles, {} materials, {} textures\n", arguments.scene, scene.triangleCount(),
               scene.materials.size(), scene.textures.size());
    fmt::print("OpenGL      {}: {}\n", gl.platform, gl.renderer);
    fmt::print("OpenCL      {}\n", deviceTitle(choice.caps));
    fmt::print("transport   host\n\n{}\n", timing.table());
    for (const auto& path : paths) fmt::print("wrote {}\n", path.string());
}

}  // namespace

void addRender(Options& program) {
    const auto arguments = std::make_shared<RenderArguments>();
    Options options = program.command("render", "Render a glTF scene with direct and indirect light",
                                      [arguments] { renderScene(*arguments); });
    options.positional("scene", arguments->scene, "a .gltf or .glb file");
    addFrameFileOptions(options, arguments->files);
    options.text("--save-inputs", "DIR", arguments->saveInputs,
                 "keep G-buffer, RSMs and matrices as a folder that `earthshine indirect` reads");
    options.group("Scene");
    forEachRasterSetting(arguments->raster,
                         [&options](const SettingInfo& info, auto& value) { addSetting(options, info, value); });
    options.group("Light");
    addLightSettings(options, arguments->settings);
    addDeviceOptions(options, arguments->device);
    options.option("--transport", "auto|host", "auto", "how pixels get from OpenGL to OpenCL",
                   [arguments](const std::string& text) { arguments->transport = parseChoice(text, kTransportNames); });
    addSequenceOptions(options, arguments->sequence);
}

}  // namespace earthshine::cli
