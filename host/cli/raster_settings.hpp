#pragma once
// Every setting of the OpenGL half, visited like those of the OpenCL half (earthshine/settings.hpp): one home for name,
// default, range and help.

#include <optional>
#include <string>

#include "cli/setting_options.hpp"
#include "earthshine/image.hpp"
#include "raster/light_fit.hpp"

namespace earthshine::cli {

inline constexpr int kMaxSizePx = 16384;

struct RasterSettings {
    Extent size{1280, 720};
    std::string camera;              ///< name or number; "" = the first, or a view of everything
    std::optional<raster::Sun> sun;  ///< in place of the scene's own directional lights
    glm::vec3 background{0.0f};      ///< cd/m^2
    int rsmSizePx = 512;
    int shadowSizePx = 2048;
    std::string gl = "auto";
};

/// Calls visit(SettingInfo, value) for each setting.
template <class SettingsT, class Visitor>
void forEachRasterSetting(SettingsT& s, Visitor&& visit) {
    visit(SettingInfo{"size", "px", 1, kMaxSizePx, "width and height of the picture"}, s.size);
    visit(
        SettingInfo{"camera", "", 0, 0, "name or number of the scene's camera [its first, else a view of everything]"},
        s.camera);
    visit(
        SettingInfo{"sun", "", 0, 0,
                    "AZIMUTH,ELEVATION[,LUX]: a sun in place of the scene's directional lights; degrees, azimuth 0 is "
                    "-z, 90 is +x [the scene's lights]"},
        s.sun);
    visit(SettingInfo{"background", "cd/m^2", 0, 60000, "R,G,B where the camera sees nothing"}, s.background);
    visit(SettingInfo{"rsm-size", "px", 1, kMaxSizePx, "side of each light's reflective shadow map"}, s.rsmSizePx);
    visit(SettingInfo{"shadow-size", "px", 1, kMaxSizePx, "side of each light's shadow map"}, s.shadowSizePx);
    visit(SettingInfo{"gl", "", 0, 0, "where OpenGL comes from: auto, egl, egl-device[:N] or osmesa"}, s.gl);
}

void addSetting(Options& options, const SettingInfo& info, Extent& value);
void addSetting(Options& options, const SettingInfo& info, std::string& value);
void addSetting(Options& options, const SettingInfo& info, std::optional<raster::Sun>& value);
void addSetting(Options& options, const SettingInfo& info, glm::vec3& value);

nlohmann::ordered_json settingJson(const SettingInfo& info, const Extent& value);
nlohmann::ordered_json settingJson(const SettingInfo& info, const std::optional<raster::Sun>& value);
nlohmann::ordered_json settingJson(const SettingInfo& info, const glm::vec3& value);

}  // namespace earthshine::cli
