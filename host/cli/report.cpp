#include "cli/report.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/setting_options.hpp"
#include "compute/tuning.hpp"

namespace earthshine::cli {

namespace {

using Json = nlohmann::ordered_json;

Json tuningJson(const Tuning& tuning) {
    Json groups = Json::object();
    for (const Tuning::Group& group : tuning.groups)
        groups[group.kernel] = {group.localSizePx[0], group.localSizePx[1]};
    return {{"lanes", tuning.lanes},
            {"storage", storageName(tuning.storage)},
            {"rsmRecords", tuning.rsmRecords},
            {"filterPairs", tuning.filterPairs},
            {"localSize", {tuning.localSizePx[0], tuning.localSizePx[1]}},
            {"kernelLocalSizes", groups},
            {"reason", tuning.reason}};
}

Json seriesJson(const char* kind, const std::string& name, const Series& series) {
    const auto ms = [](double value) { return std::round(value * 1e6) / 1e6; };  // clocks count nanoseconds
    return {{kind, name}, {"medianMs", ms(series.median())}, {"minMs", ms(series.min())}, {"maxMs", ms(series.max())}};
}

}  // namespace

std::string programVersion() {
    return "earthshine " EARTHSHINE_VERSION;
}

Json capsJson(const DeviceCaps& caps) {
    return {{"index", caps.index},
            {"name", caps.name},
            {"vendor", caps.vendor},
            {"type", caps.type},
            {"platform", caps.platformName},
            {"platformVersion", caps.platformVersion},
            {"deviceVersion", caps.deviceVersion},
            {"driverVersion", caps.driverVersion},
            {"openclCVersion", caps.openclCVersion},
            {"available", caps.available},
            {"computeUnits", caps.computeUnits},
            {"nativeFloatWidth", caps.nativeFloatWidth},
            {"localMemoryBytes", caps.localMemoryBytes},
            {"globalMemoryBytes", caps.globalMemoryBytes},
            {"maxAllocationBytes", caps.maxAllocationBytes},
            {"maxWorkGroupSize", caps.maxWorkGroupSize},
            {"unifiedMemory", caps.unifiedMemory},
            {"fusesMultiplyAdd", caps.fusesMultiplyAdd},
            {"images", caps.images},
            {"maxImageSize", {caps.maxImageSizePx[0], caps.maxImageSizePx[1]}},
            {"imageFormats", caps.imageFormats},
            {"transports", caps.transports},
            {"unusable", caps.unusable},
            {"tuning", tuningJson(caps.tuning)}};
}

void addFrame(Json& report, const FrameReport& frame) {
    Json device = capsJson(frame.device.caps());
    device["why"] = frame.whyDevice;
    device["tuning"] = tuningJson(frame.device.tuning());  // as used, not the defaults
    report["device"] = std::move(device);
    report["settings"] = Json::object();
    forEachSetting(frame.settings, [&](const SettingInfo& info, const auto& value) {
        report["settings"][info.name] = settingJson(info, value);
    });
    report["frames"] = frame.frameCount;
    report["framesTimed"] = frame.timing.deviceTotal().ms.size();
    report["stages"] = Json::array();
    for (const auto& [name, series] : frame.timing.stages())
        report["stages"].push_back(seriesJson("stage", name, series));
    report["allStages"] = seriesJson("stage", "all", frame.timing.deviceTotal());
    report["steps"] = Json::array();
    for (const auto& [name, series] : frame.timing.steps()) report["steps"].push_back(seriesJson("step", name, series));
    report["deviceMemoryBytes"] = frame.device.allocatedBytes();
    if (!frame.timing.transport().empty()) {
        Json cost = Json::array();
        for (const auto& [name, series] : frame.timing.transport()) cost.push_back(seriesJson("part", name, series));
        report["transportCost"] = {{"parts", std::move(cost)}, {"hostBytes", frame.timing.transportHostBytes()}};
    }
    report["exposure"] = frame.exposure;
    report["gatheredPixels"] = frame.gatheredPixels;
    report["nonFinite"] = Json::object();
    for (const NonFiniteLayer& layer : frame.nonFinite) report["nonFinite"][layer.layer] = layer.count;
    report["outputs"] = Json::array();
    for (const auto& path : frame.outputs) report["outputs"].push_back(path.string());
}

}  // namespace earthshine::cli
