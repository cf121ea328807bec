#pragma once
// The settings of rows of whole frames, and what such rows show beside their time.

#include <functional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "earthshine/device.hpp"
#include "earthshine/settings.hpp"
#include "variants.hpp"

namespace earthshine::bench {

struct FrameSettings {
    Settings settings;
    int warmUps = 1;  ///< frames before time counts
};

/// As `settings`, but the filter never fades: all of it works at any length of history.
FrameSettings neverFading(Settings settings);
/// As `settings`, once history is as long as they let it be.
FrameSettings still(const Settings& settings);

/// --variants without naive: its history would take minutes to fill.
std::vector<Variant> variantsOfStillRows();

/// fast, balanced, high, baseline, each with 1, 4 and 8 samples: "balanced.8spp".
void forEachPreset(const std::function<void(const std::string& name, const Settings& settings)>& visit);

/// Row::addCounters: bytes/px, of all that was allocated on the device since `before` bytes were.
std::function<void(benchmark::State&)> bytesAPixel(const Device& device, double pixels, std::size_t before);

}  // namespace earthshine::bench
