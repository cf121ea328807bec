#pragma once
// Settings as options of the command line and as keys of the report, from their one home: a forEach...() that visits
// (SettingInfo, value).

#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/options.hpp"
#include "earthshine/settings.hpp"

namespace earthshine::cli {

/// Adds the option of one setting. Other types than these bring an overload of their own.
template <class Value>
void addSetting(Options& options, const SettingInfo& info, Value& value) {
    const std::string names = fmt::format("--{}", info.name);
    if constexpr (std::is_same_v<Value, bool>) {
        options.onOff(names, value, info.help);
    } else if constexpr (std::is_enum_v<Value>) {
        options.option(names, fmt::format("{}", fmt::join(info.names, "|")), info.names[std::size_t(value)], info.help,
                       [&value, all = info.names](const std::string& text) { value = Value(parseChoice(text, all)); });
    } else {
        static_assert(std::is_same_v<Value, int> || std::is_same_v<Value, float>);
        const std::string help =
            fmt::format("{} [{}; {}]{}{}", info.help, info.min, info.max, *info.unit ? " " : "", info.unit);
        options.option(names, "N", fmt::format("{}", value), help, [&value, info](const std::string& text) {
            if constexpr (std::is_same_v<Value, int>)
                value = parseInt(text, info.min, info.max, info.unit);
            else
                value = parseFloat(text, info.min, info.max, info.unit);
        });
    }
}

/// Adds --preset and then every setting of the light: what is given stands, and the preset sets the rest, in whatever
/// order they are on the command line (options are read in the order in which they are added here).
inline void addLightSettings(Options& options, Settings& settings) {
    options.option(
        "--preset", fmt::format("{}", fmt::join(kPresetNames, "|")), kPresetNames[0],
        "defaults of the settings below: still is one picture from many samples, the others denoise",
        [&settings](const std::string& text) { settings = settingsOf(Preset(parseChoice(text, kPresetNames))); });
    forEachSetting(settings, [&options](const SettingInfo& info, auto& value) { addSetting(options, info, value); });
}

/// The value of one setting as the report shows it.
template <class Value>
nlohmann::ordered_json settingJson(const SettingInfo& info, const Value& value) {
    if constexpr (std::is_enum_v<Value>)
        return info.names[std::size_t(value)];
    else
        return value;
}

}  // namespace earthshine::cli
