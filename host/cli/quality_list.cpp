#include "cli/quality_list.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/options.hpp"
#include "earthshine/error.hpp"

namespace earthshine::cli {

namespace {

using Json = nlohmann::ordered_json;

/// An object of the list, and where it stands in the file.
class Entry {
public:
    Entry(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
        if (!json.is_object()) fail("must be an object");
    }
    [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", place_, what)); }
    void allow(const std::vector<std::string>& keys) const {
        for (const auto& [key, value] : json_.items())
            if (std::find(keys.begin(), keys.end(), key) == keys.end())
                fail(fmt::format("'{}' is none of {}", key, fmt::join(keys, ", ")));
    }
    const Json* find(const std::string& key) const {
        const auto found = json_.find(key);
        return found == json_.end() ? nullptr : &*found;
    }
    std::string text(const std::string& key, const std::string& otherwise) const {
        const Json* value = find(key);
        if (!value) return otherwise;
        if (!value->is_string()) fail(fmt::format("'{}' must be a text", key));
        return value->get<std::string>();
    }
    const Json& json() const { return json_; }

private:
    const Json& json_;
    std::string place_;
};

QualityScene sceneOf(const Entry& entry, const std::filesystem::path& folder) {
    entry.allow({"file", "camera", "sun"});
    QualityScene scene;
    const std::string file = entry.text("file", "");
    if (file.empty()) entry.fail("needs a 'file'");
    scene.file = folder / file;
    scene.camera = entry.text("camera", "");
    if (const Json* sun = entry.find("sun")) {
        if (!sun->is_array() || sun->size() != 3 ||
            !std::all_of(sun->begin(), sun->end(), [](const Json& n) { return n.is_number(); }))
            entry.fail("'sun' must be [azimuth, elevation, lux]");
        scene.sun = raster::Sun{(*sun)[0].get<float>(), (*sun)[1].get<float>(), (*sun)[2].get<float>()};
    }
    scene.name = scene.file.stem().string() + (scene.camera.empty() ? "" : "-" + scene.camera);
    std::replace_if(
        scene.name.begin(), scene.name.end(), [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_'; },
        '_');
    return scene;
}

/// Sets one value from JSON, in the words of the command line.
template <class Value>
void assign(const Entry& entry, const SettingInfo& info, const Json& json, Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
        if (!json.is_boolean()) entry.fail(fmt::format("'{}' must be true or false", info.name));
        value = json.get<bool>();
    } else if constexpr (std::is_enum_v<Value>) {
        if (!json.is_string())
            entry.fail(fmt::format("'{}' must be one of {}", info.name, fmt::join(info.names, ", ")));
        value = Value(parseChoice(json.get<std::string>(), info.names));
    } else {
        if (!json.is_number() || (std::is_same_v<Value, int> && !json.is_number_integer()))
            entry.fail(fmt::format("'{}' must be a {}number", info.name, std::is_same_v<Value, int> ? "whole " : ""));
        value = json.get<Value>();
    }
}

QualitySetting settingOf(const Entry& entry) {
    std::vector<std::string> keys{"series", "preset", "frames"};
    QualitySetting setting;
    forEachSetting(setting.settings, [&keys](const SettingInfo& info, auto&) { keys.emplace_back(info.name); });
    entry.allow(keys);
    try {
        if (entry.find("preset")) {
            setting.label = entry.text("preset", "");
            setting.settings = settingsOf(Preset(parseChoice(setting.label, kPresetNames)));
        }
        if (const Json* frames = entry.find("frames")) {
            assign(entry, {"frames", "", 1, 1000, ""}, *frames, setting.frames);
            if (setting.frames < 1 || setting.frames > 1000) entry.fail("'frames' must be in [1; 1000]");
            setting.label += fmt::format("{}frames {}", setting.label.empty() ? "" : ", ", setting.frames);
        }
        forEachSetting(setting.settings, [&](const SettingInfo& info, auto& value) {
            const Json* json = entry.find(info.name);
            if (!json) return;
            assign(entry, info, *json, value);
            const std::string text =
                json->is_string() ? json->get<std::string>() : fmt::format("{} {}", info.name, json->dump());
            setting.label += (setting.label.empty() ? "" : ", ") + text;
        });
        validate(setting.settings);
    } catch (const UsageError& e) {
        entry.fail(e.what());
    }
    if (setting.label.empty()) setting.label = "defaults";
    setting.series = entry.text("series", setting.label);
    return setting;
}

}  // namespace

QualityList readQualityList(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
    Json json;
    try {
        json = Json::parse(stream);
    } catch (const Json::parse_error& e) {
        throw InputError(fmt::format("{}: is no JSON: byte {} makes no sense", path.string(), e.byte));
    }
    const Entry list(json, path.string());
    list.allow({"scenes", "settings"});
    const auto forEachOf = [&](const std::string& key, auto&& visit) {
        const Json* array = list.find(key);
        if (!array || !array->is_array() || array->empty()) list.fail(fmt::format("needs a list '{}'", key));
        for (std::size_t i = 0; i < array->size(); ++i)
            visit(Entry((*array)[i], fmt::format("{}: {}[{}]", path.string(), key, i)));
    };
    QualityList result;
    forEachOf("scenes", [&](const Entry& entry) { result.scenes.push_back(sceneOf(entry, path.parent_path())); });
    forEachOf("settings", [&](const Entry& entry) { result.settings.push_back(settingOf(entry)); });
    return result;
}

}  // namespace earthshine::cli
