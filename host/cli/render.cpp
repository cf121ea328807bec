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

constexpr const char* kTransportChoices[] = {"auto", "host", "gl-sharing", "external-memory"};

struct RenderArguments {
    std::string scene;
    RasterSettings raster;
    Settings settings;
    SequenceArguments sequence;
    int transport = 0;  ///< into kTransportChoices
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

    GlDevice opened =
        openForGl(choice.caps, arguments.device.options, context->handle(), kTransportChoices[arguments.transport]);
    const Device& device = opened.device;
    Transport& transport = opened.transport;
    context->setTextureStorage(&transport);
    raster::SceneRenderer renderer(*context, scene);
    note("uploadMs");
    Pipeline pipeline(device);
    note("pipelineMs");

    // The frame's own images are in host memory if they came that way, else only if something asks for them.
    const bool needsInputs = files.needsInputs() || !inputsFolder.empty();
    FrameImages images;
    FrameInputs inputs;
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
            const double drawMs = draw.ms();
            if (i == -warmupCount && needsInputs) {
                images = readBack(textures, frame.camera, frame.lights, context->getProcAddress());
                files.check(images.inputs());
            }

            const Stopwatch compute;
            pipeline.setFrame(transport, textures, frame.camera, frame.lights);
            pipeline.run(arguments.settings,
                         [&](double part) { progress.update((i + warmupCount + part) / (frameCount + warmupCount)); });
            const TransportCost& cost = transport.cost();
            timing.addStep("raster", drawMs + cost.waitMs);
            timing.addStep("transport", cost.acquireMs + cost.releaseMs);
            timing.addStep("compute", compute.ms() - cost.waitMs - cost.acquireMs - cost.releaseMs);
            if (i == -warmupCount) {
                note("firstFrameMs");
                start["firstPixelMs"] = processMs();
            }
            timing.addStep("frame", whole.ms());
            timing.addTransport(cost);
            timing.addStages(pipeline.stageTimes());
            if (transport.hostImages()) {
                inputs = transport.hostImages()->inputs();
            } else if (needsInputs && i >= firstFrame) {
                images = readBack(textures, frame.camera, frame.lights, context->getProcAddress());
                inputs = images.inputs();
            }
            if (i >= firstFrame) files.write(i, pipeline, inputs);
            previousCamera = frame.camera;
            lights = frame.lights;
        }
    }

    const auto paths = files.paths();
    if (!inputsFolder.empty()) writeInputs(inputsFolder, inputs);

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
    report["transport"] = transport.name();
    report["transportReason"] = transport.reason();
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
    fmt::print("transport   {} ({})\n\n{}\n", transport.name(), transport.reason(), timing.table());
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
    options.option(
        "--transport", "auto|host|gl-sharing|external-memory", "auto",
        "how pixels get from OpenGL to OpenCL; auto takes the best that passes a round trip",
        [arguments](const std::string& text) { arguments->transport = parseChoice(text, kTransportChoices); });
    addSequenceOptions(options, arguments->sequence);
}

}  // namespace earthshine::cli
