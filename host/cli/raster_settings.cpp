#include "cli/raster_settings.hpp"

#include "earthshine/error.hpp"

namespace earthshine::cli {

namespace {

std::string optionName(const SettingInfo& info) {
    return fmt::format("--{}", info.name);
}

std::vector<std::string> parts(const std::string& text, std::size_t min, std::size_t max, const char* form) {
    const std::vector<std::string> result = splitCommas(text);
    if (result.size() < min || result.size() > max) throw UsageError(fmt::format("'{}' is not {}", text, form));
    return result;
}

}  // namespace

void addSetting(Options& options, const SettingInfo& info, Extent& value) {
    options.option(optionName(info), "WxH", fmt::format("{}x{}", value.widthPx, value.heightPx), info.help,
                   [&value, info](const std::string& text) { value = parseExtent(text, int(info.max)); });
}

void addSetting(Options& options, const SettingInfo& info, std::string& value) {
    options.text(optionName(info), "TEXT", value, info.help);
}

void addSetting(Options& options, const SettingInfo& info, std::optional<raster::Sun>& value) {
    options.option(optionName(info), "A,E[,L]", "", info.help, [&value](const std::string& text) {
        const auto numbers = parts(text, 2, 3, "AZIMUTH,ELEVATION[,LUX], as in 135,50,50000");
        raster::Sun sun;
        sun.azimuthDeg = parseFloat(numbers[0], -360, 360, "degrees");
        sun.elevationDeg = parseFloat(numbers[1], -90, 90, "degrees");
        if (numbers.size() > 2) sun.lux = parseFloat(numbers[2], 0, 1e6, "lux");
        value = sun;
    });
}

void addSetting(Options& options, const SettingInfo& info, glm::vec3& value) {
    options.option(optionName(info), "R,G,B", fmt::format("{},{},{}", value.r, value.g, value.b),
                   fmt::format("{}, {}", info.help, info.unit), [&value, info](const std::string& text) {
                       const auto numbers = parts(text, 3, 3, "three numbers, as in 400,600,900");
                       for (int i = 0; i < 3; ++i)
                           value[i] = parseFloat(numbers[std::size_t(i)], info.min, info.max, info.unit);
                   });
}

nlohmann::ordered_json settingJson(const SettingInfo&, const Extent& value) {
    return {value.widthPx, value.heightPx};
}

nlohmann::ordered_json settingJson(const SettingInfo&, const std::optional<raster::Sun>& value) {
    if (!value) return {};
    return {{"azimuthDeg", value->azimuthDeg}, {"elevationDeg", value->elevationDeg}, {"lux", value->lux}};
}

nlohmann::ordered_json settingJson(const SettingInfo&, const glm::vec3& value) {
    return {value.r, value.g, value.b};
}

}  // namespace earthshine::cli
