// Whole frames through the pipeline, as a program of the library's runs them: pixels in, direct light, indirect light,
// exposure, tone map, and the wait for all of it (wall_ms). Plain and _still rows as in indirect_bench.cpp. bytes/px
// are of all that the pipeline keeps on the device, the light's maps among them.

#include <memory>

#include "benches.hpp"
#include "frame_settings.hpp"
#include "room.hpp"
#include "room_frame.hpp"
#include "row.hpp"
#include "run_options.hpp"

namespace earthshine::bench {

namespace {

Row frame(const Variant& variant, Extent extent, const FrameSettings& settings) {
    const Device device(runOptions().device, variant.options);
    const auto pipeline = std::make_shared<Pipeline>(device);
    pipeline->setFrame(roomFrame(extent, kRsmSizePx).inputs());
    Row row{.device = device, .run = [=] {
                pipeline->run(settings.settings);
                return pipeline->stageTimes();
            }};
    row.pixels = double(extent.widthPx) * extent.heightPx;
    row.warmUps = settings.warmUps;
    row.showsStages = true;
    row.addCounters = bytesAPixel(device, row.pixels, 0);
    return row;
}

}  // namespace

void addFrameRows() {
    forEachPreset([](const std::string& name, const Settings& settings) {
        const auto make = [](const FrameSettings& s) {
            return [=](const Variant& variant, Extent extent) { return frame(variant, extent, s); };
        };
        addRows("frame", usualExtents(), name, make(neverFading(settings)));
        addRows("frame", usualExtents(), name + "_still", variantsOfStillRows(), make(still(settings)));
    });
}

}  // namespace earthshine::bench
