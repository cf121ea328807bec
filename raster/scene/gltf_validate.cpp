#include "raster/scene/gltf_validate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace earthshine::raster {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 6> kKnownExtensions = {
    "KHR_lights_punctual",   "KHR_texture_transform", "KHR_materials_emissive_strength",
    "KHR_mesh_quantization", "KHR_materials_unlit",   "KHR_materials_pbrSpecularGlossiness"};

constexpr std::uint64_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kFloat = 5126;

const json& arrayOf(const json& object, const char* name) {
    static const json kEmpty = json::array();
    const auto found = object.find(name);
    return found == object.end() ? kEmpty : *found;
}

std::uint64_t unsignedOf(const json& object, const char* name, std::uint64_t otherwise = 0) {
    const auto found = object.find(name);
    return found == object.end() ? otherwise : found->get<std::uint64_t>();
}

std::uint64_t componentBytes(std::uint64_t componentType) {
    return componentType == kByte || componentType == kUnsignedByte     ? 1
           : componentType == kShort || componentType == kUnsignedShort ? 2
                                                                        : 4;
}

/// Bytes of one element; the columns of small matrices start at multiples of 4 bytes.
std::uint64_t elementBytes(const std::string& type, std::uint64_t componentType) {
    const std::uint64_t size = componentBytes(componentType);
    const auto padded = [](std::uint64_t bytes) { return (bytes + 3) / 4 * 4; };
    if (type == "MAT2") return 2 * padded(2 * size);
    if (type == "MAT3") return 3 * padded(3 * size);
    if (type == "MAT4") return 16 * size;
    return (type == "SCALAR" ? 1 : std::uint64_t(type.back() - '0')) * size;
}

class ReferenceCheck {
public:
    ReferenceCheck(const json& document, const std::vector<std::size_t>& bufferBytes, const GltfFile& file)
        : document_(document), bufferBytes_(bufferBytes), file_(file) {}

    void run() {
        forEach("bufferViews", &ReferenceCheck::checkBufferView);
        forEach("accessors", &ReferenceCheck::checkAccessor);
        forEach("images", &ReferenceCheck::checkImage);
        forEach("cameras", &ReferenceCheck::checkCamera);
        checkLights();
        forEach("meshes", &ReferenceCheck::checkMesh);
        forEach("nodes", &ReferenceCheck::checkNode);
        forEach("animations", &ReferenceCheck::checkAnimation);
        checkTrees();
        forEach("scenes", &ReferenceCheck::checkScene);
    }

private:
    void forEach(const char* name, void (ReferenceCheck::*check)(const json&, const std::string&)) {
        const json& elements = arrayOf(document_, name);
        for (std::size_t i = 0; i < elements.size(); ++i) (this->*check)(elements[i], fmt::format("{}[{}]", name, i));
    }

    void checkBufferView(const json& view, const std::string& place) {
        const auto buffer = unsignedOf(view, "buffer");
        const auto end = unsignedOf(view, "byteOffset") + unsignedOf(view, "byteLength");
        if (end > bufferBytes_[buffer]) {
            file_.fail(place,
                       fmt::format("ends at byte {}, buffers[{}] holds {} B", end, buffer, bufferBytes_[buffer]));
        }
        if (unsignedOf(view, "byteStride") % 4 != 0) {
            file_.fail(place, fmt::format("its byteStride {} is not a multiple of 4", unsignedOf(view, "byteStride")));
        }
    }

    /// Checks that `count` elements of `bytes`, `stride` apart from `offset` on, lie in a buffer view.
    void checkRange(std::uint64_t view, std::uint64_t offset, std::uint64_t count, std::uint64_t stride,
                    std::uint64_t bytes, const std::string& place) const {
        const std::uint64_t holds = unsignedOf(arrayOf(document_, "bufferViews")[view], "byteLength");
        // The schema bounds each factor (2^40, 2^40, 252), so that this cannot overflow.
        const std::uint64_t needs = offset + (count - 1) * stride + bytes;
        if (needs > holds) file_.fail(place, fmt::format("needs {} B, bufferViews[{}] holds {} B", needs, view, holds));
    }

    void checkAccessor(const json& accessor, const std::string& place) {
        const auto componentType = unsignedOf(accessor, "componentType");
        const std::uint64_t count = unsignedOf(accessor, "count");
        const std::uint64_t bytes = elementBytes(accessor["type"].get<std::string>(), componentType);
        if (accessor.contains("bufferView")) {
            const std::uint64_t view = unsignedOf(accessor, "bufferView");
            const std::uint64_t stride = unsignedOf(arrayOf(document_, "bufferViews")[view], "byteStride", bytes);
            if (stride < bytes) {
                file_.fail(place, fmt::format("has elements of {} B, the byteStride of bufferViews[{}] is {} B", bytes,
                                              view, stride));
            }
            checkRange(view, unsignedOf(accessor, "byteOffset"), count, stride, bytes, place);
        }
        if (accessor.contains("sparse")) {
            const json& sparse = accessor["sparse"];
            const std::uint64_t changed = unsignedOf(sparse, "count");
            if (changed > count)
                file_.fail(place + ".sparse", fmt::format("changes {} of {} elements", changed, count));
            const json& indices = sparse["indices"];
            const std::uint64_t indexBytes = componentBytes(unsignedOf(indices, "componentType"));
            checkRange(unsignedOf(indices, "bufferView"), unsignedOf(indices, "byteOffset"), changed, indexBytes,
                       indexBytes, place + ".sparse.indices");
            const json& values = sparse["values"];
            checkRange(unsignedOf(values, "bufferView"), unsignedOf(values, "byteOffset"), changed, bytes, bytes,
                       place + ".sparse.values");
        }
    }

    void checkImage(const json& image, const std::string& place) {
        if (image.contains("uri") == image.contains("bufferView"))
            file_.fail(place, "needs either a uri or a bufferView");
        if (image.contains("uri")) file_.checkUri(image["uri"].get<std::string>(), place);
    }

    void checkCamera(const json& camera, const std::string& place) {
        const auto type = camera["type"].get<std::string>();
        if (!camera.contains(type)) file_.fail(place + "." + type, "is missing");
        const json& lens = camera[type];
        if (type == "orthographic" && lens["ymag"].get<double>() == 0.0)
            file_.fail(place + ".orthographic.ymag", "is 0");
        if (lens.contains("zfar") && lens["zfar"].get<double>() <= lens["znear"].get<double>()) {
            file_.fail(place, "its zfar is not beyond its znear");
        }
    }

    void checkLights() const {
        const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
        if (!document_.contains(lights)) return;
        for (std::size_t i = 0; i < document_[lights].size(); ++i) {
            const json& light = document_[lights][i];
            if (light["type"] == "spot" && !light.contains("spot")) {
                file_.fail(fmt::format("extensions.KHR_lights_punctual.lights[{}].spot", i), "is missing");
            }
        }
    }

    struct Allowed {
        std::string_view name;
        std::string_view type;
        std::string_view otherType;
        bool (*component)(std::uint64_t type, bool normalized);
    };

    void checkAttribute(const std::string& name, std::uint64_t accessor, std::uint64_t vertexCount,
                        const std::string& place) {
        // glTF 2.0, 3.7.2.1, widened by KHR_mesh_quantization.
        static constexpr std::array<Allowed, 5> kAllowed = {{
            {"POSITION", "VEC3", "", [](std::uint64_t type, bool) { return type <= kUnsignedShort || type == kFloat; }},
            {"NORMAL", "VEC3", "",
             [](std::uint64_t type, bool n) { return type == kFloat || (n && (type == kByte || type == kShort)); }},
            {"TANGENT", "VEC4", "VEC3",
             [](std::uint64_t type, bool n) { return type == kFloat || (n && (type == kByte || type == kShort)); }},
            {"TEXCOORD_", "VEC2", "",
             [](std::uint64_t type, bool) { return type <= kUnsignedShort || type == kFloat; }},
            {"COLOR_", "VEC4", "VEC3",
             [](std::uint64_t type, bool n) {
                 return type == kFloat || (n && (type == kUnsignedByte || type == kUnsignedShort));
             }},
        }};
        const json& of = arrayOf(document_, "accessors")[accessor];
        for (const Allowed& allowed : kAllowed) {
            if (!name.starts_with(allowed.name)) continue;
            const auto type = of["type"].get<std::string>();
            const auto component = unsignedOf(of, "componentType");
            const bool normalized = of.value("normalized", false);
            if ((type != allowed.type && type != allowed.otherType) || !allowed.component(component, normalized)) {
                file_.fail(place,
                           fmt::format("accessors[{}] is {} of component type {}{}, which {} cannot be", accessor, type,
                                       component, normalized ? " normalized" : "", printable(name)));
            }
        }
        if (const auto count = unsignedOf(of, "count"); count != vertexCount) {
            file_.fail(place,
                       fmt::format("accessors[{}] has {} elements, POSITION has {}", accessor, count, vertexCount));
        }
    }

    void checkMesh(const json& mesh, const std::string& place) {
        const json& primitives = mesh["primitives"];
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const json& primitive = primitives[i];
            const std::string at = fmt::format("{}.primitives[{}]", place, i);
            const json& attributes = primitive["attributes"];
            const bool hasPosition = attributes.contains("POSITION");
            const std::uint64_t vertexCount =
                hasPosition ? unsignedOf(arrayOf(document_, "accessors")[unsignedOf(attributes, "POSITION")], "count")
                            : 0;
            if (hasPosition) {
                for (const auto& [name, accessor] : attributes.items()) {
                    checkAttribute(name, accessor.get<std::uint64_t>(), vertexCount, at + "." + printable(name));
                }
                const json& targets = arrayOf(primitive, "targets");
                for (std::size_t t = 0; t < targets.size(); ++t) {
                    for (const auto& [name, accessor] : targets[t].items()) {
                        checkAttribute(name, accessor.get<std::uint64_t>(), vertexCount,
                                       fmt::format("{}.targets[{}].{}", at, t, printable(name)));
                    }
                }
            }
            if (primitive.contains("indices")) checkIndices(unsignedOf(primitive, "indices"), at + ".indices");
        }
    }

    void checkIndices(std::uint64_t accessor, const std::string& place) const {
        const json& of = arrayOf(document_, "accessors")[accessor];
        const auto component = unsignedOf(of, "componentType");
        if (of["type"] != "SCALAR" || component == kByte || component == kShort || component == kFloat) {
            file_.fail(place,
                       fmt::format("accessors[{}] is {} of component type {}; indices are SCALAR of 5121, 5123 or 5125",
                                   accessor, of["type"].get<std::string>(), component));
        }
        if (!of.contains("bufferView")) file_.fail(place, fmt::format("accessors[{}] has no bufferView", accessor));
    }

    void checkNode(const json& node, const std::string& place) {
        if (node.contains("matrix")) {
            if (node.contains("translation") || node.contains("rotation") || node.contains("scale")) {
                file_.fail(place, "has a matrix and a translation, rotation or scale; it may have one of the two");
            }
            const json& m = node["matrix"];
            // Exporters round; a real projection is far from this.
            constexpr double kRounding = 1e-5;
            if (std::abs(m[3].get<double>()) > kRounding || std::abs(m[7].get<double>()) > kRounding ||
                std::abs(m[11].get<double>()) > kRounding || std::abs(m[15].get<double>() - 1.0) > kRounding) {
                file_.fail(place + ".matrix", "its last row is not 0 0 0 1");
            }
        }
        if (node.contains("rotation")) {
            double squared = 0.0;
            for (const json& element : node["rotation"]) squared += element.get<double>() * element.get<double>();
            if (!(squared > 1e-12 && squared < 1e12))
                file_.fail(place + ".rotation", "is no rotation: its length is not 1");
        }
    }

    /// The accessors of what is played: translation, rotation and scale of a node (glTF 2.0, 3.11).
    void checkAnimation(const json& animation, const std::string& place) {
        const json& channels = animation["channels"];
        std::set<std::pair<std::uint64_t, std::string>> targets;
        for (std::size_t i = 0; i < channels.size(); ++i) {
            const std::string at = fmt::format("{}.channels[{}]", place, i);
            const auto sampler = unsignedOf(channels[i], "sampler");
            if (const std::size_t count = animation["samplers"].size(); sampler >= count)
                file_.fail(at + ".sampler", fmt::format("is {}, but samplers has {} elements", sampler, count));
            const json& target = channels[i]["target"];
            const auto path = target["path"].get<std::string>();
            const bool isRotation = path == "rotation";
            if (!target.contains("node") || (!isRotation && path != "translation" && path != "scale")) continue;
            const auto node = unsignedOf(target, "node");
            if (arrayOf(document_, "nodes")[node].contains("matrix"))
                file_.fail(at, fmt::format("animates nodes[{}], which has a matrix; it needs a {}", node, path));
            if (!targets.emplace(node, path).second)
                file_.fail(at, fmt::format("animates the {} of nodes[{}] a second time", path, node));
            checkAnimationSampler(animation["samplers"][sampler], isRotation,
                                  fmt::format("{}.samplers[{}]", place, sampler));
        }
    }

    void checkAnimationSampler(const json& sampler, bool isRotation, const std::string& place) const {
        const auto input = unsignedOf(sampler, "input"), output = unsignedOf(sampler, "output");
        const json& times = arrayOf(document_, "accessors")[input];
        const json& values = arrayOf(document_, "accessors")[output];
        if (times["type"] != "SCALAR" || unsignedOf(times, "componentType") != kFloat)
            file_.fail(place + ".input",
                       fmt::format("accessors[{}] is {} of component type {}; times are SCALAR of 5126", input,
                                   times["type"].get<std::string>(), unsignedOf(times, "componentType")));
        const auto component = unsignedOf(values, "componentType");
        const bool isNormalized = values.value("normalized", false) && component <= kUnsignedShort;
        if (values["type"] != (isRotation ? "VEC4" : "VEC3") ||
            (component != kFloat && !(isRotation && isNormalized))) {
            file_.fail(place + ".output", fmt::format("accessors[{}] is {} of component type {}, which a {} cannot be",
                                                      output, values["type"].get<std::string>(), component,
                                                      isRotation ? "rotation" : "translation or scale"));
        }
        const bool isSpline = sampler.value("interpolation", "LINEAR") == "CUBICSPLINE";
        const std::uint64_t keys = unsignedOf(times, "count"), count = unsignedOf(values, "count");
        if (isSpline && keys < 2) file_.fail(place + ".input", "has one key; a CUBICSPLINE needs two");
        if (const std::uint64_t needs = isSpline ? 3 * keys : keys; count != needs) {
            file_.fail(place + ".output",
                       fmt::format("accessors[{}] has {} elements, {} keys need {}", output, count, keys, needs));
        }
    }

    /// Every node has one parent at most, and going from parent to parent ends.
    void checkTrees() {
        constexpr std::size_t kNone = ~std::size_t(0);
        const json& nodes = arrayOf(document_, "nodes");
        parents_.assign(nodes.size(), kNone);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (const json& child : arrayOf(nodes[i], "children")) {
                std::size_t& parent = parents_[child.get<std::size_t>()];
                if (parent != kNone) {
                    file_.fail(
                        fmt::format("nodes[{}]", child.get<std::size_t>()),
                        fmt::format("is a child of nodes[{}] and of nodes[{}]; a node has one parent", parent, i));
                }
                parent = i;
            }
        }
        std::vector<std::size_t> seenFrom(nodes.size(), kNone);
        for (std::size_t start = 0; start < nodes.size(); ++start) {
            for (std::size_t node = start; node != kNone && seenFrom[node] == kNone; node = parents_[node]) {
                seenFrom[node] = start;
                const std::size_t parent = parents_[node];
                if (parent != kNone && seenFrom[parent] == start) {
                    file_.fail(fmt::format("nodes[{}]", parent), "is its own ancestor");
                }
            }
        }
    }

    void checkScene(const json& scene, const std::string& place) {
        std::vector<bool> listed(parents_.size(), false);
        const json& roots = arrayOf(scene, "nodes");
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const auto root = roots[i].get<std::size_t>();
            const std::string at = fmt::format("{}.nodes[{}]", place, i);
            if (parents_[root] != ~std::size_t(0)) {
                file_.fail(at,
                           fmt::format("nodes[{}] is a child of nodes[{}]; a scene lists roots", root, parents_[root]));
            }
            if (listed[root]) file_.fail(at, fmt::format("nodes[{}] is listed twice", root));
            listed[root] = true;
        }
    }

    const json& document_;
    const std::vector<std::size_t>& bufferBytes_;
    const GltfFile& file_;
    std::vector<std::size_t> parents_;  // of each node
};

}  // namespace

bool isKnownExtension(std::string_view name) {
    return std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) != kKnownExtensions.end();
}

void checkExtensions(const json& document, const GltfFile& file) {
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object() || !asset->contains("version") ||
        !(*asset)["version"].is_string()) {
        file.fail("asset.version", "is missing; is this a glTF 2.0 file?");
    }
    if (const auto version = (*asset)["version"].get<std::string>(); !version.starts_with("2.")) {
        file.fail("asset.version", fmt::format("is {}; only glTF 2.0 is read", printable(version)));
    }
    const auto required = document.find("extensionsRequired");
    if (required == document.end() || !required->is_array()) return;  // a wrong type is for checkSchema() to tell
    for (const json& extension : *required) {
        if (!extension.is_string()) continue;
        const auto& name = extension.get_ref<const std::string&>();
        if (!isKnownExtension(name)) {
            file.fail("extensionsRequired",
                      fmt::format("{} is not supported; export the scene without it", printable(name)));
        }
    }
}

void checkReferences(const json& document, const std::vector<std::size_t>& bufferBytes, const GltfFile& file) {
    ReferenceCheck(document, bufferBytes, file).run();
}

}  // namespace earthshine::raster
