#include "image/inputs_json.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <sstream>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include "earthshine/error.hpp"
#include "image/json_text.hpp"

namespace earthshine {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "earthshine-inputs";
constexpr int kVersion = 1;
constexpr std::uintmax_t kMaxFileBytes = 16u << 20;  // thousands of lights; more is some other file

/// A value and where it stands, for messages.
struct Place {
    const Json& value;
    std::string where;

    [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", where, what)); }

    Place at(const char* key) const {
        if (!value.is_object()) fail(fmt::format("expected an object, found {}", value.type_name()));
        const auto found = value.find(key);
        if (found == value.end()) fail(fmt::format("no \"{}\"", key));
        return {*found, fmt::format("{}: {}", where, key)};
    }

    bool has(const char* key) const { return value.is_object() && value.contains(key); }

    /// A key that nothing reads is most likely a slip of the pen.
    void allowOnly(std::initializer_list<std::string_view> keys) const {
        if (!value.is_object()) fail(fmt::format("expected an object, found {}", value.type_name()));
        for (const auto& item : value.items())
            if (item.key() != "comment" && std::find(keys.begin(), keys.end(), item.key()) == keys.end())
                fail(fmt::format("unknown key \"{}\"; expected {}", item.key(), fmt::join(keys, ", ")));
    }

    std::string text() const {
        if (!value.is_string()) fail(fmt::format("expected a string, found {}", value.type_name()));
        return value.get<std::string>();
    }

    float number() const {
        if (!value.is_number()) fail(fmt::format("expected a number, found {}", value.type_name()));
        const float result = value.get<float>();
        if (!std::isfinite(result)) fail("too large for a float");
        return result;
    }

    void numbers(float* out, std::size_t count) const {
        if (!value.is_array() || value.size() != count)
            fail(fmt::format("expected {} numbers, found {}", count,
                             value.is_array() ? fmt::format("{}", value.size()) : value.type_name()));
        for (std::size_t i = 0; i < count; ++i) out[i] = Place{value[i], fmt::format("{}[{}]", where, i)}.number();
    }
};

Json numbers(const float* values, std::size_t count) {
    return std::vector<float>(values, values + count);
}

Json writeCamera(const Camera& camera) {
    return {{"viewFromWorld", numbers(glm::value_ptr(camera.viewFromWorld), 16)},
            {"clipFromView", numbers(glm::value_ptr(camera.clipFromView), 16)}};
}

glm::mat4 readMatrix(const Place& place) {
    glm::mat4 matrix;
    place.numbers(glm::value_ptr(matrix), 16);
    return matrix;
}

Camera readCamera(const Place& place) {
    place.allowOnly({"viewFromWorld", "clipFromView"});
    const Place view = place.at("viewFromWorld"), clip = place.at("clipFromView");
    const Camera camera{readMatrix(view), readMatrix(clip)};
    if (const std::string fault = faultOf(camera); !fault.empty()) place.fail(fault);
    return camera;
}

ImageFiles readFiles(const Place& place, std::initializer_list<const char*> required,
                     std::initializer_list<const char*> optional) {
    ImageFiles files;
    const auto read = [&](const char* key) {
        const Place entry = place.at(key);
        const std::filesystem::path file = std::filesystem::path(entry.text()).lexically_normal();
        if (file.empty() || file.is_absolute() || *file.begin() == "..")
            entry.fail("expected the name of a file inside the folder");
        files[key] = file.string();
    };
    for (const char* key : required) read(key);
    for (const char* key : optional)
        if (place.has(key)) read(key);
    return files;
}

Light readLight(const Place& place) {
    place.allowOnly({"name", "type", "intensity", "innerConeAngle", "outerConeAngle", "rangeM", "indirectScale",
                     "gatherRadiusUv", "camera", "rsmDepth", "rsmNormal", "rsmFlux", "shadowDepth"});
    Light light;
    if (place.has("name")) light.name = place.at("name").text();
    const Place type = place.at("type");
    if (type.text() != "directional" && type.text() != "spot")
        type.fail(fmt::format("expected \"directional\" or \"spot\", found \"{}\"", type.text()));
    light.type = type.text() == "spot" ? LightType::Spot : LightType::Directional;

    const Place intensity = place.at("intensity");
    intensity.numbers(glm::value_ptr(light.intensity), 3);
    const bool spot = light.type == LightType::Spot;
    if (spot || place.has("innerConeAngle")) light.innerConeAngle = place.at("innerConeAngle").number();
    if (spot || place.has("outerConeAngle")) light.outerConeAngle = place.at("outerConeAngle").number();
    if (place.has("rangeM")) light.rangeM = place.at("rangeM").number();

    if (place.has("indirectScale")) light.indirectScale = place.at("indirectScale").number();
    if (place.has("gatherRadiusUv")) light.gatherRadiusUv = place.at("gatherRadiusUv").number();
    light.camera = readCamera(place.at("camera"));
    if (const std::string fault = faultOf(light); !fault.empty()) place.fail(fault);
    return light;
}

}  // namespace

std::string writeDescription(const InputsDescription& description) {
    Json json = {{"format", kFormat}, {"version", kVersion}, {"camera", writeCamera(description.camera)}};
    json["images"] = Json::object();
    for (const auto& [key, file] : description.images) json["images"][key] = file;
    json["lights"] = Json::array();
    for (std::size_t i = 0; i < description.lights.size(); ++i) {
        const Light& light = description.lights[i];
        Json entry = {{"name", light.name},
                      {"type", light.type == LightType::Spot ? "spot" : "directional"},
                      {"intensity", numbers(glm::value_ptr(light.intensity), 3)},
                      {"innerConeAngle", light.innerConeAngle},
                      {"outerConeAngle", light.outerConeAngle},
                      {"rangeM", light.rangeM},
                      {"indirectScale", light.indirectScale},
                      {"gatherRadiusUv", light.gatherRadiusUv},
                      {"camera", writeCamera(light.camera)}};
        for (const auto& [key, file] : description.lightMaps[i]) entry[key] = file;
        json["lights"].push_back(std::move(entry));
    }
    return readableJson(json);
}

InputsDescription readDescription(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(fmt::format("{}: no such file", file.string()));
    if (std::filesystem::file_size(file, error) > kMaxFileBytes)
        throw InputError(
            fmt::format("{}: larger than {} MiB; no {} file", file.string(), kMaxFileBytes >> 20, kFormat));
    std::ifstream stream(file, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    if (!stream) throw InputError(fmt::format("{}: cannot be read", file.string()));
    Json json;
    try {
        json = Json::parse(text.str());
    } catch (const Json::exception& e) {  // a parse_error, or out_of_range for 1e999
        std::string what = e.what();      // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
        if (const auto at = what.find("] "); at != std::string::npos) what.erase(0, at + 2);
        std::replace(what.begin(), what.end(), '\n', ' ');
        throw InputError(fmt::format("{}: {}", file.string(), what));
    }

    const Place root{json, file.string()};
    if (!root.has("format") || json["format"] != kFormat) root.fail(fmt::format("\"format\" must be \"{}\"", kFormat));
    if (const Place version = root.at("version"); version.value != kVersion)
        version.fail(fmt::format("expected {}, found {}", kVersion, version.value.dump()));
    root.allowOnly({"format", "version", "camera", "images", "lights"});

    InputsDescription description;
    description.camera = readCamera(root.at("camera"));
    const Place images = root.at("images");
    images.allowOnly({"albedo", "normal", "depth", "motion", "emission"});
    description.images = readFiles(images, {"albedo", "normal", "depth"}, {"motion", "emission"});
    const Place lights = root.at("lights");
    if (!lights.value.is_array()) lights.fail(fmt::format("expected a list, found {}", lights.value.type_name()));
    for (std::size_t i = 0; i < lights.value.size(); ++i) {
        const Place light{lights.value[i], fmt::format("{}[{}]", lights.where, i)};
        description.lights.push_back(readLight(light));
        description.lightMaps.push_back(readFiles(light, {"rsmDepth", "rsmNormal", "rsmFlux", "shadowDepth"}, {}));
    }
    return description;
}

}  // namespace earthshine
