// The whole of indirect light: packing, gather, temporal, history check, filter, modulate, with each kernel's part.
//
// The filter fades as history grows (kernels/atrous.cl) until it only copies. So rows come in two kinds: plain ones
// never let it fade (filter-fade 1024), so that every pass does its full work, as it does where history is short; and
// those named _still are what a camera at rest comes to, history as long as the preset keeps it. bytes/px are of what
// indirect light keeps beside its inputs, and of the picture that it ends in.

#include <fmt/format.h>

#include <memory>

#include "benches.hpp"
#include "frame_settings.hpp"
#include "pipeline/indirect_pass.hpp"
#include "room.hpp"
#include "row.hpp"
#include "run_options.hpp"
#include "stages/modulate_stage.hpp"

namespace earthshine::bench {

namespace {

struct Frame {
    Frame(const Variant& variant, Extent extent, const Settings& s)
        : room(variant, extent), previous(room.another()), pass(room.device), modulate(room.device), settings(s) {}

    void enqueue() {
        FrameGeometry geometry{room.rays, room.extent, room.inputs.rsm.sizePx, 1, room.inputs.shadowExtent};
        geometry.frameIndex = index++;
        geometry.previousRays = room.rays;
        geometry.hasHistory = pass.hasHistory(room.extent, settings);
        geometry.hasConfidence = pass.hasConfidence();
        pass.enqueue(room.inputs, previous, makeParams(settings, geometry), {});
        modulate.enqueue({room.inputs.albedo, pass.irradiance(), nullptr, radiance});
    }

    Room room;
    FrameSurfaces previous;
    std::size_t bytesBefore = room.device.allocatedBytes();
    IndirectPass pass;
    ModulateStage modulate;
    Surface radiance = room.three();
    Settings settings;
    int index = 0;
};

Row indirect(const Variant& variant, Extent extent, const FrameSettings& settings) {
    const auto frame = std::make_shared<Frame>(variant, extent, settings.settings);
    const Device device = frame->room.device;
    Row row{.device = device, .run = launches(device, [=] { frame->enqueue(); })};
    row.pixels = frame->room.pixels;
    row.samples = settings.settings.sampleCount;
    row.warmUps = settings.warmUps;
    row.showsStages = true;
    row.addCounters = bytesAPixel(device, row.pixels, frame->bytesBefore);
    return row;
}

void add(const Extents& extents, const std::string& name, const FrameSettings& settings,
         const std::vector<Variant>& variants) {
    addRows("indirect", extents, name, variants,
            [=](const Variant& variant, Extent extent) { return indirect(variant, extent, settings); });
}

}  // namespace

void addIndirectRows() {
    // The fixed row, over sizes and over samples.
    const auto fixed = [](int sampleCount) {
        Settings settings = settingsOf(Preset::Balanced);
        settings.sampleCount = sampleCount;
        settings.filterIterations = 5;
        return settings;
    };
    const Extents sizes{{{640, 360}, {1280, 720}, {1920, 1080}, {3840, 2160}}}, oneSize{{{1920, 1080}}};
    add(sizes, "8spp.5iterations", neverFading(fixed(8)), runOptions().variants);
    for (const int sampleCount : {4, 16, 32, 64})
        add(oneSize, fmt::format("{}spp.5iterations", sampleCount), neverFading(fixed(sampleCount)),
            runOptions().variants);
    add(usualExtents(), "8spp.5iterations_still", still(fixed(8)), variantsOfStillRows());
    forEachPreset([](const std::string& name, const Settings& settings) {
        add(usualExtents(), name, neverFading(settings), runOptions().variants);
        add(usualExtents(), name + "_still", still(settings), variantsOfStillRows());
    });
}

}  // namespace earthshine::bench
