#include "frame_settings.hpp"

#include <fmt/format.h>

#include "run_options.hpp"

namespace earthshine::bench {

FrameSettings neverFading(Settings settings) {
    settings.filterFade = 1024.0f;  // the largest: full at 64 frames of history even in the fifth iteration
    return {settings, 2};           // one without history, which compiles, one with
}

FrameSettings still(const Settings& settings) {
    return {settings, settings.historyFrames + 1};
}

std::vector<Variant> variantsOfStillRows() {
    std::vector<Variant> variants = runOptions().variants;
    std::erase_if(variants, [](const Variant& v) { return v.name == naive().name; });
    return variants;
}

void forEachPreset(const std::function<void(const std::string& name, const Settings& settings)>& visit) {
    for (const Preset preset : {Preset::Fast, Preset::Balanced, Preset::High, Preset::Baseline})
        for (const int sampleCount : {1, 4, 8}) {
            Settings settings = settingsOf(preset);
            settings.sampleCount = sampleCount;
            visit(fmt::format("{}.{}spp", kPresetNames[int(preset)], sampleCount), settings);
        }
}

std::function<void(benchmark::State&)> bytesAPixel(const Device& device, double pixels, std::size_t before) {
    return [=](benchmark::State& state) {
        state.counters["bytes/px"] = double(device.allocatedBytes() - before) / pixels;
    };
}

}  // namespace earthshine::bench
