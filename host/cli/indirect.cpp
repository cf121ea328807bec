// `earthshine indirect`: the OpenCL half alone, over a folder of inputs that any renderer may have made. No GL context.

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/device_options.hpp"
#include "cli/frame_files.hpp"
#include "cli/report.hpp"
#include "cli/setting_options.hpp"
#include "image/inputs_folder.hpp"
#include "image/json_text.hpp"

namespace earthshine::cli {

namespace {

struct IndirectArguments {
    std::string folder;
    Settings settings;
    int frameCount = 1;
    DeviceArguments device;
    FrameFileArguments files;
};

void computeIndirect(const IndirectArguments& arguments) {
    OutputSet outputs;
    const FrameFiles files(arguments.files, outputs);
    validate(arguments.settings);
    const DeviceChoice choice = chooseDevice(arguments.device);

    const Stopwatch load;
    const FrameImages images = loadInputs(arguments.folder);
    const double loadMs = load.ms();
    const FrameInputs frame = images.inputs();
    files.check(frame);

    const Device device(choice.caps, arguments.device.options);
    Pipeline pipeline(device);
    FrameTiming timing;
    {
        Progress progress("indirect light");
        for (int i = 0; i < arguments.frameCount; ++i) {
            if (i == 1) timing.clear();
            const Stopwatch compute;
            pipeline.setFrame(frame);
            pipeline.run(arguments.settings, [&](double part) { progress.update((i + part) / arguments.frameCount); });
            timing.addStep("compute", compute.ms());
            timing.addStages(pipeline.stageTimes());
        }
    }

    const auto paths = outputs.paths();
    const auto nonFinite = files.writePictures(pipeline, frame);
    nlohmann::ordered_json report = {
        {"program", programVersion()}, {"command", "indirect"}, {"inputs", arguments.folder}};
    report["size"] = {images.depth.extent().widthPx, images.depth.extent().heightPx};
    report["lights"] = frame.lights.size();
    report["loadMs"] = loadMs;
    addFrame(report, {device, choice.why, arguments.settings, timing, arguments.frameCount, pipeline.exposure(),
                      pipeline.gatheredPixels(), nonFinite, paths});
    files.writeReport(readableJson(report));
    outputs.commit();
    fmt::print("inputs      {}: {}x{}, {} lights\n", arguments.folder, images.depth.extent().widthPx,
               images.depth.extent().heightPx, frame.lights.size());
    fmt::print("OpenCL      {}\n\n{}\n", deviceTitle(choice.caps), timing.table());
    for (const auto& path : paths) fmt::print("wrote {}\n", path.string());
}

}  // namespace

void addIndirect(Options& program) {
    const auto arguments = std::make_shared<IndirectArguments>();
    Options options = program.command(
        "indirect", "Compute the light of a G-buffer and RSMs that are in a folder of EXR and JSON files",
        [arguments] { computeIndirect(*arguments); });
    options.positional("inputs", arguments->folder, "folder of inputs, as `render --save-inputs` makes it");
    addFrameFileOptions(options, arguments->files);
    options.group("Light");
    addLightSettings(options, arguments->settings);
    addDeviceOptions(options, arguments->device);
    options.option("--frames", "N", "1", "compute this often, to time it; the first of several is not counted",
                   [arguments](const std::string& text) { arguments->frameCount = parseInt(text, 1, 100000); });
}

}  // namespace earthshine::cli
