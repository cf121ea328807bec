#pragma once
// The parts of a report (--report) that every command which computes has in common.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/frame_files.hpp"
#include "cli/frame_timing.hpp"
#include "earthshine/device.hpp"
#include "earthshine/settings.hpp"

namespace earthshine::cli {

/// "earthshine 0.1.0"
std::string programVersion();

/// A device as `devices --json` and the report show it.
nlohmann::ordered_json capsJson(const DeviceCaps& caps);

/// What a computed frame adds to a report.
struct FrameReport {
    const Device& device;
    std::string whyDevice;
    const Settings& settings;
    const FrameTiming& timing;
    int frameCount = 1;
    float exposure = 0.0f;
    int gatheredPixels = 0;  ///< that interpolation left to be gathered in full
    std::vector<NonFiniteLayer> nonFinite;
    std::vector<std::filesystem::path> outputs;
};

/// Puts its keys into `report`: device, settings, frames, stages, steps, deviceMemoryBytes, transportCost (of frames
/// that came from OpenGL), exposure, gatheredPixels, nonFinite, outputs.
void addFrame(nlohmann::ordered_json& report, const FrameReport& frame);

}  // namespace earthshine::cli
