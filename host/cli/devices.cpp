// `earthshine devices`: what is here, what each device can do, and which one would be used.

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/report.hpp"
#include "compute/tuning.hpp"
#include "earthshine/device.hpp"
#include "earthshine/error.hpp"
#include "image/json_text.hpp"

namespace earthshine::cli {

namespace {

struct DevicesArguments {
    std::string spec;
    bool json = false;
};

std::string describe(const DeviceCaps& caps, bool chosen) {
    std::string text = fmt::format("{} {}: {}\n", chosen ? "*" : " ", caps.index, caps.name);
    const auto line = [&text](const char* name, const std::string& value) {
        text += fmt::format("       {:<14}{}\n", name, value);
    };
    line("platform", fmt::format("{}, {}", caps.platformName, caps.platformVersion));
    line("driver", fmt::format("{}, {}", caps.deviceVersion, caps.driverVersion));
    if (!caps.unusable.empty()) {
        line("unusable", caps.unusable);
        return text;
    }
    line("type", fmt::format("{}, {} units, {} floats wide, {}", caps.type, caps.computeUnits, caps.nativeFloatWidth,
                             caps.fusesMultiplyAdd ? "fused multiply-add" : "no fused multiply-add"));
    line("memory", fmt::format("{} MiB global{}, {} KiB local, {} work-items a group", caps.globalMemoryBytes >> 20,
                               caps.unifiedMemory ? " shared with the host" : "", caps.localMemoryBytes >> 10,
                               caps.maxWorkGroupSize));
    line("images", !caps.images ? std::string("none")
                                : fmt::format("{} up to {}x{}", fmt::join(caps.imageFormats, " "),
                                              caps.maxImageSizePx[0], caps.maxImageSizePx[1]));
    line("transports", fmt::format("{}", fmt::join(caps.transports, " ")));
    const Tuning& t = caps.tuning;
    line("tuning", fmt::format("lanes {}, {} storage, {}, groups of {}x{}", t.lanes, storageName(t.storage),
                               t.rsmRecords ? "packed RSM" : "RSM images", t.localSizePx[0], t.localSizePx[1]));
    for (const Tuning::Group& group : t.groups)
        line("", fmt::format("{:<18} {}x{}", group.kernel, group.localSizePx[0], group.localSizePx[1]));
    line("", fmt::format("({})", t.reason));
    return text;
}

void listAll(const DevicesArguments& arguments) {
    const std::vector<DeviceCaps> devices = listDevices();
    int chosen = -1;
    std::string why;
    try {
        chosen = selectDevice(arguments.spec, &why).index;
    } catch (const DeviceError& e) {  // none works: the list says why
        why = e.what();
    }
    if (arguments.json) {
        nlohmann::ordered_json json = {{"devices", nlohmann::ordered_json::array()}};
        for (const DeviceCaps& caps : devices) json["devices"].push_back(capsJson(caps));
        json["chosen"] = chosen < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(chosen);
        json["why"] = why;
        fmt::print("{}", readableJson(json));
        return;
    }
    for (const DeviceCaps& caps : devices) fmt::print("{}\n", describe(caps, caps.index == chosen));
    if (chosen < 0)
        fmt::print("no device can be used: {}\n", why);
    else
        fmt::print("* device {} would be used: {}\n", chosen, why);
}

}  // namespace

void addDevices(Options& program) {
    const auto arguments = std::make_shared<DevicesArguments>();
    Options options = program.command("devices", "List the OpenCL devices, and which one would be used",
                                      [arguments] { listAll(*arguments); });
    options.text("--device", "N|NAME", arguments->spec, "which one would be used if asked for like this");
    options.flag("--json", arguments->json, "print JSON");
}

}  // namespace earthshine::cli
