#include "cli/device_options.hpp"

#include <fmt/format.h>

#include "compute/tuning.hpp"
#include "earthshine/log.hpp"

namespace earthshine::cli {

void addDeviceOptions(Options& options, DeviceArguments& arguments) {
    DeviceOptions& o = arguments.options;
    o.profiling = true;  // every subcommand shows stage times
    options.group("OpenCL device");
    options.text("--device", "N|NAME", arguments.spec,
                 "number or part of the name, see `earthshine devices` [$EARTHSHINE_DEVICE, else the first usable GPU, "
                 "else CPU]");
    options.text("--tuning", "FILE", o.tuningFile,
                 "rows of `earthshine_bench --tune` that go before the library's own [$EARTHSHINE_TUNING]");
    options.option("--lanes", "1|4|8|16", "", "pixels a work-item computes [the tuning table's]",
                   [&o](const std::string& text) {
                       static constexpr const char* kNames[] = {"1", "4", "8", "16"};
                       o.lanes = std::stoi(kNames[parseChoice(text, kNames)]);
                   });
    options.option("--storage", "image|planar|packed", "", "how surfaces are kept [the tuning table's]",
                   [&o](const std::string& text) { o.storage = kStorageNames[parseChoice(text, kStorageNames)]; });
    options.option("--rsm-records", "on|off", "",
                   "gather from packed texels, not from the RSM's images [the tuning table's]",
                   [&o](const std::string& text) {
                       static constexpr const char* kNames[] = {"off", "on"};
                       o.rsmRecords = parseChoice(text, kNames);
                   });
    options.option("--filter-pairs", "on|off", "", "a row and a column of the separable filter in one launch [on]",
                   [&o](const std::string& text) {
                       static constexpr const char* kNames[] = {"off", "on"};
                       o.filterPairs = parseChoice(text, kNames);
                   });
    options.option("--local-size", "WxH", "", "work-items a group of every kernel [the tuning table's]",
                   [&o](const std::string& text) {
                       const Extent size = parseExtent(text, 4096);
                       o.localSizePx[0] = size.widthPx;
                       o.localSizePx[1] = size.heightPx;
                   });
}

DeviceChoice chooseDevice(const DeviceArguments& arguments) {
    DeviceChoice choice;
    choice.caps = selectDevice(arguments.spec, &choice.why);
    log(LogLevel::Info, fmt::format("device {}, {}", deviceTitle(choice.caps), choice.why));
    return choice;
}

std::string deviceTitle(const DeviceCaps& caps) {
    return fmt::format("{}: {} ({})", caps.index, caps.name, caps.platformName);
}

}  // namespace earthshine::cli
