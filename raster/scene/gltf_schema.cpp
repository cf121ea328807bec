#include "raster/scene/gltf_schema.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace earthshine::raster {

namespace {

using nlohmann::json;

enum class Kind { Integer, Number, Boolean, String, Object, Integers, Numbers, Strings, Objects, IndexMap, IndexMaps };

constexpr double kOne = 1.0 + 1e-5;  // exporters round
constexpr double kMaxInt = 2147483647.0;
constexpr double kMaxFloat = 3.4028234e38;   // positions, colours and matrices are 32-bit floats in the end
constexpr double kMaxBytes = 1099511627776;  // 1 TiB: beyond any file, and products with a stride stay exact

/// One property of an object of the document.
struct Property {
    const char* name;
    Kind kind;
    bool required = false;
    double min = -kMaxFloat;  // of the number, or of each number in the array
    double max = kMaxFloat;
    std::size_t minSize = 0;  // of the array
    std::size_t maxSize = std::numeric_limits<std::size_t>::max();
    const char* indexInto = nullptr;            // JSON pointer of the array into which the number points
    std::span<const double> numbers = {};       // all that the number may be
    std::span<const char* const> strings = {};  // all that the string may be
    std::span<const Property> members = {};     // of the object, or of each object in the array
};

constexpr Property index(const char* name, const char* into, bool required = false) {
    return {.name = name, .kind = Kind::Integer, .required = required, .min = 0, .max = kMaxInt, .indexInto = into};
}
constexpr Property indices(const char* name, const char* into) {
    return {.name = name, .kind = Kind::Integers, .min = 0, .max = kMaxInt, .indexInto = into};
}
constexpr Property size(const char* name, double min, bool required = false, double max = kMaxBytes) {
    return {.name = name, .kind = Kind::Integer, .required = required, .min = min, .max = max};
}
constexpr Property number(const char* name, double min = -kMaxFloat, double max = kMaxFloat, bool required = false) {
    return {.name = name, .kind = Kind::Number, .required = required, .min = min, .max = max};
}
constexpr Property numbers(const char* name, std::size_t count, double min = -kMaxFloat, double max = kMaxFloat) {
    return {.name = name, .kind = Kind::Numbers, .min = min, .max = max, .minSize = count, .maxSize = count};
}
constexpr Property integerOf(const char* name, std::span<const double> values, bool required = false) {
    return {.name = name, .kind = Kind::Integer, .required = required, .numbers = values};
}
constexpr Property stringOf(const char* name, std::span<const char* const> values, bool required = false) {
    return {.name = name, .kind = Kind::String, .required = required, .strings = values};
}
constexpr Property string(const char* name) {
    return {.name = name, .kind = Kind::String};
}
constexpr Property boolean(const char* name) {
    return {.name = name, .kind = Kind::Boolean};
}
constexpr Property object(const char* name, std::span<const Property> members, bool required = false) {
    return {.name = name, .kind = Kind::Object, .required = required, .members = members};
}
constexpr Property objects(const char* name, std::span<const Property> members, bool required = false,
                           std::size_t minSize = 0) {
    return {.name = name, .kind = Kind::Objects, .required = required, .minSize = minSize, .members = members};
}

constexpr double kIndexTypes[] = {5121, 5123, 5125};
constexpr double kComponentTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr double kModes[] = {0, 1, 2, 3, 4, 5, 6};
constexpr double kMagFilters[] = {9728, 9729};
constexpr double kMinFilters[] = {9728, 9729, 9984, 9985, 9986, 9987};
constexpr double kWraps[] = {33071, 33648, 10497};
constexpr const char* kAccessorTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr const char* kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr const char* kCameraTypes[] = {"perspective", "orthographic"};
constexpr const char* kLightTypes[] = {"directional", "point", "spot"};
constexpr const char* kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr const char* kLights = "/extensions/KHR_lights_punctual/lights";

constexpr Property kNoExtension[] = {{.name = "extensions", .kind = Kind::Object}};

constexpr Property kBuffer[] = {string("uri"), size("byteLength", 1, true), kNoExtension[0]};
// tinygltf keeps a stride in its own way unless it is as the specification says.
constexpr Property kBufferView[] = {index("buffer", "/buffers", true), size("byteOffset", 0),
                                    size("byteLength", 1, true), size("byteStride", 4, false, 252), kNoExtension[0]};
constexpr Property kSparseIndices[] = {index("bufferView", "/bufferViews", true), size("byteOffset", 0, false, kMaxInt),
                                       integerOf("componentType", kIndexTypes, true)};
constexpr Property kSparseValues[] = {index("bufferView", "/bufferViews", true), size("byteOffset", 0, false, kMaxInt)};
constexpr Property kSparse[] = {size("count", 1, true, kMaxInt), object("indices", kSparseIndices, true),
                                object("values", kSparseValues, true)};
constexpr Property kAccessor[] = {index("bufferView", "/bufferViews"),
                                  size("byteOffset", 0),
                                  integerOf("componentType", kComponentTypes, true),
                                  boolean("normalized"),
                                  size("count", 1, true),
                                  stringOf("type", kAccessorTypes, true),
                                  object("sparse", kSparse),
                                  kNoExtension[0]};

constexpr Property kPrimitive[] = {
    {.name = "attributes",
     .kind = Kind::IndexMap,
     .required = true,
     .min = 0,
     .max = kMaxInt,
     .indexInto = "/accessors"},
    index("indices", "/accessors"),
    index("material", "/materials"),
    integerOf("mode", kModes),
    {.name = "targets", .kind = Kind::IndexMaps, .min = 0, .max = kMaxInt, .indexInto = "/accessors"},
    kNoExtension[0]};
constexpr Property kMesh[] = {string("name"),
                              objects("primitives", kPrimitive, true, 1),
                              {.name = "weights", .kind = Kind::Numbers},
                              kNoExtension[0]};

constexpr Property kNodeLight[] = {index("light", kLights, true)};
constexpr Property kNodeExtensions[] = {object("KHR_lights_punctual", kNodeLight)};
constexpr Property kNode[] = {string("name"),
                              index("mesh", "/meshes"),
                              index("camera", "/cameras"),
                              index("skin", "/skins"),
                              indices("children", "/nodes"),
                              numbers("matrix", 16),
                              numbers("translation", 3),
                              numbers("rotation", 4),
                              numbers("scale", 3),
                              {.name = "weights", .kind = Kind::Numbers},
                              object("extensions", kNodeExtensions)};
constexpr Property kScene[] = {string("name"), indices("nodes", "/nodes"), kNoExtension[0]};

constexpr Property kTextureTransform[] = {numbers("offset", 2), numbers("scale", 2), number("rotation"),
                                          size("texCoord", 0, false, kMaxInt)};
constexpr Property kTextureInfoExtensions[] = {object("KHR_texture_transform", kTextureTransform)};
constexpr Property kTextureInfo[] = {index("index", "/textures", true), size("texCoord", 0, false, kMaxInt),
                                     number("scale"), number("strength"), object("extensions", kTextureInfoExtensions)};
constexpr Property kMetallicRoughness[] = {numbers("baseColorFactor", 4, 0, kOne),
                                           object("baseColorTexture", kTextureInfo),
                                           number("metallicFactor", 0, kOne),
                                           number("roughnessFactor", 0, kOne),
                                           object("metallicRoughnessTexture", kTextureInfo),
                                           kNoExtension[0]};
constexpr Property kEmissiveStrength[] = {number("emissiveStrength", 0)};
constexpr Property kSpecularGlossiness[] = {numbers("diffuseFactor", 4, 0, kOne),
                                            object("diffuseTexture", kTextureInfo)};
constexpr Property kMaterialExtensions[] = {object("KHR_materials_emissive_strength", kEmissiveStrength),
                                            object("KHR_materials_pbrSpecularGlossiness", kSpecularGlossiness),
                                            object("KHR_materials_unlit", {})};
constexpr Property kMaterial[] = {string("name"),
                                  object("pbrMetallicRoughness", kMetallicRoughness),
                                  object("normalTexture", kTextureInfo),
                                  object("occlusionTexture", kTextureInfo),
                                  object("emissiveTexture", kTextureInfo),
                                  numbers("emissiveFactor", 3, 0),
                                  stringOf("alphaMode", kAlphaModes),
                                  number("alphaCutoff", 0),
                                  boolean("doubleSided"),
                                  object("extensions", kMaterialExtensions)};
constexpr Property kTexture[] = {string("name"), index("source", "/images"), index("sampler", "/samplers"),
                                 kNoExtension[0]};
constexpr Property kImage[] = {string("name"), string("uri"), string("mimeType"), index("bufferView", "/bufferViews"),
                               kNoExtension[0]};
constexpr Property kSampler[] = {integerOf("magFilter", kMagFilters), integerOf("minFilter", kMinFilters),
                                 integerOf("wrapS", kWraps), integerOf("wrapT", kWraps), kNoExtension[0]};

constexpr Property kPerspective[] = {number("yfov", 1e-4, 3.1415, true), number("aspectRatio", 1e-6),
                                     number("znear", 1e-9, kMaxFloat, true), number("zfar", 1e-9)};
constexpr Property kOrthographic[] = {number("xmag", -kMaxFloat, kMaxFloat, true),
                                      number("ymag", -kMaxFloat, kMaxFloat, true), number("znear", 0, kMaxFloat, true),
                                      number("zfar", 1e-9, kMaxFloat, true)};
constexpr Property kCamera[] = {string("name"), stringOf("type", kCameraTypes, true),
                                object("perspective", kPerspective), object("orthographic", kOrthographic),
                                kNoExtension[0]};
constexpr Property kSpot[] = {number("innerConeAngle", 0, 1.5707964), number("outerConeAngle", 1e-4, 1.5707964)};
constexpr Property kLight[] = {string("name"),         stringOf("type", kLightTypes, true),
                               numbers("color", 3, 0), number("intensity", 0),
                               number("range", 1e-9),  object("spot", kSpot)};
constexpr Property kLightsPunctual[] = {objects("lights", kLight, true)};
constexpr Property kAnimationTarget[] = {
    index("node", "/nodes"), {.name = "path", .kind = Kind::String, .required = true}, kNoExtension[0]};
constexpr Property kAnimationChannel[] = {size("sampler", 0, true, kMaxInt), object("target", kAnimationTarget, true),
                                          kNoExtension[0]};
constexpr Property kAnimationSampler[] = {index("input", "/accessors", true), index("output", "/accessors", true),
                                          stringOf("interpolation", kInterpolations), kNoExtension[0]};
constexpr Property kAnimation[] = {string("name"), objects("channels", kAnimationChannel, true, 1),
                                   objects("samplers", kAnimationSampler, true, 1), kNoExtension[0]};
constexpr Property kAsset[] = {{.name = "version", .kind = Kind::String, .required = true}};

constexpr Property kRootExtensions[] = {object("KHR_lights_punctual", kLightsPunctual)};
constexpr Property kRoot[] = {object("asset", kAsset, true),
                              {.name = "extensionsUsed", .kind = Kind::Strings},
                              {.name = "extensionsRequired", .kind = Kind::Strings},
                              object("extensions", kRootExtensions),
                              index("scene", "/scenes"),
                              objects("scenes", kScene),
                              objects("nodes", kNode),
                              objects("meshes", kMesh),
                              objects("accessors", kAccessor),
                              objects("bufferViews", kBufferView),
                              objects("buffers", kBuffer),
                              objects("materials", kMaterial),
                              objects("textures", kTexture),
                              objects("images", kImage),
                              objects("samplers", kSampler),
                              objects("cameras", kCamera),
                              objects("animations", kAnimation),
                              {.name = "skins", .kind = Kind::Objects}};

class SchemaCheck {
public:
    SchemaCheck(const json& document, const GltfFile& file) : document_(document), file_(file) {}

    void checkMembers(const json& value, std::span<const Property> members, const std::string& place) {
        if (!value.is_object()) wrongType(value, place, "an object");
        for (const Property& property : members) {
            const auto found = value.find(property.name);
            const std::string at = place.empty() ? property.name : place + "." + property.name;
            if (found != value.end()) {
                checkValue(*found, property, at);
            } else if (property.required) {
                file_.fail(at, "is missing");
            }
        }
    }

private:
    [[noreturn]] void wrongType(const json& value, const std::string& place, const char* expected) const {
        file_.fail(place, fmt::format("is {} {}, not {}", value.is_object() || value.is_array() ? "an" : "a",
                                      value.type_name(), expected));
    }

    void checkValue(const json& value, const Property& property, const std::string& place) {
        switch (property.kind) {
            case Kind::Integer:
            case Kind::Number:
                return checkNumber(value, property, property.kind == Kind::Integer, place);
            case Kind::Boolean:
                if (!value.is_boolean()) wrongType(value, place, "true or false");
                return;
            case Kind::String:
                return checkString(value, property, place);
            case Kind::Object:
                return checkMembers(value, property.members, place);
            case Kind::IndexMap:
                if (!value.is_object()) wrongType(value, place, "an object");
                for (const auto& [key, element] : value.items()) {
                    checkNumber(element, property, true, place + "." + printable(key));
                }
                return;
            default:
                return checkArray(value, property, place);
        }
    }

    void checkArray(const json& value, const Property& property, const std::string& place) {
        if (!value.is_array()) wrongType(value, place, "an array");
        if (value.size() < property.minSize || value.size() > property.maxSize) {
            file_.fail(place, fmt::format("has {} elements, needs {}", value.size(), property.minSize));
        }
        Property element = property;
        element.kind = property.kind == Kind::Integers  ? Kind::Integer
                       : property.kind == Kind::Numbers ? Kind::Number
                       : property.kind == Kind::Strings ? Kind::String
                       : property.kind == Kind::Objects ? Kind::Object
                                                        : Kind::IndexMap;
        for (std::size_t i = 0; i < value.size(); ++i) checkValue(value[i], element, fmt::format("{}[{}]", place, i));
    }

    void checkNumber(const json& value, const Property& property, bool integer, const std::string& place) {
        if (!value.is_number()) wrongType(value, place, integer ? "an integer" : "a number");
        if (integer && !value.is_number_integer())
            file_.fail(place, fmt::format("is {}, not an integer", value.dump()));
        const double number = value.get<double>();
        if (!property.numbers.empty()) {
            for (const double allowed : property.numbers) {
                if (number == allowed) return;
            }
            file_.fail(place, fmt::format("is {}, which glTF does not know", value.dump()));
        }
        if (property.indexInto) {
            const std::size_t count = elementCount(property.indexInto);
            if (!(number >= 0.0 && number < double(count))) {
                file_.fail(place, fmt::format("is {}, but {} has {} elements", value.dump(),
                                              pointerName(property.indexInto), count));
            }
        }
        if (!(number >= property.min && number <= property.max)) {
            file_.fail(place, fmt::format("is {}, not in [{}; {}]", value.dump(), property.min, property.max));
        }
    }

    void checkString(const json& value, const Property& property, const std::string& place) const {
        if (!value.is_string()) wrongType(value, place, "a string");
        if (property.strings.empty()) return;
        const auto& text = value.get_ref<const std::string&>();
        for (const char* allowed : property.strings) {
            if (text == allowed) return;
        }
        file_.fail(place, fmt::format("is \"{}\", which glTF does not know", printable(text)));
    }

    std::size_t elementCount(const char* pointer) {
        const auto [entry, isNew] = counts_.try_emplace(pointer, 0);
        if (isNew) {
            const json::json_pointer at(pointer);
            if (document_.contains(at) && document_.at(at).is_array()) entry->second = document_.at(at).size();
        }
        return entry->second;
    }

    static std::string pointerName(const char* pointer) {
        std::string name(pointer + 1);
        for (char& c : name) c = c == '/' ? '.' : c;
        return name;
    }

    const json& document_;
    const GltfFile& file_;
    std::map<const char*, std::size_t> counts_;  // by address: every pointer is a literal above
};

}  // namespace

void checkSchema(const json& document, const GltfFile& file) {
    SchemaCheck(document, file).checkMembers(document, kRoot, "");
}

}  // namespace earthshine::raster
