#include "raster/scene_support.hpp"

#include <atomic>
#include <fstream>

#include <gmock/gmock.h>
#include <unistd.h>

#include "earthshine/error.hpp"

namespace earthshine::raster::test {

namespace {

std::string base64(const ByteVector& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63u];
    }
    return out;
}

void append32(ByteVector& out, std::size_t value) {
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<unsigned char>(value >> (8 * i)));
}

ByteVector fromHex(const std::string& text) {
    ByteVector out;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
        out.push_back(static_cast<unsigned char>(std::stoi(text.substr(i, 2), nullptr, 16)));
    }
    return out;
}

}  // namespace

TempFolder::TempFolder() {
    static std::atomic<int> serial = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("earthshine_scene_" + std::to_string(::getpid()) + "_" + std::to_string(serial++));
    std::filesystem::create_directories(path_);
}

TempFolder::~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TempFolder::write(const std::string& name, const ByteVector& bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
}

std::size_t GltfBuilder::componentsOf(const std::string& type) {
    return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
}

int GltfBuilder::add(const char* array, Json element) {
    document[array].push_back(std::move(element));
    return static_cast<int>(document[array].size()) - 1;
}

int GltfBuilder::addView(const ByteVector& bytes, int stride) {
    while (buffer.size() % 4 != 0) buffer.push_back(0);
    Json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    buffer.insert(buffer.end(), bytes.begin(), bytes.end());
    return add("bufferViews", std::move(view));
}

int GltfBuilder::addAccessor(int view, int componentType, std::size_t count, const char* type, bool normalized,
                             std::size_t byteOffset) {
    Json accessor = {{"componentType", componentType}, {"count", count}, {"type", type}};
    if (view >= 0) accessor["bufferView"] = view;
    if (normalized) accessor["normalized"] = true;
    if (byteOffset > 0) accessor["byteOffset"] = byteOffset;
    return add("accessors", std::move(accessor));
}

int GltfBuilder::addMesh(Json primitive, Json node) {
    node["mesh"] = add("meshes", {{"primitives", Json::array({std::move(primitive)})}});
    return add("nodes", std::move(node));
}

int GltfBuilder::addLight(Json light) {
    Json& lights = document["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(light));
    return static_cast<int>(lights.size()) - 1;
}

int GltfBuilder::addTexture(const ByteVector& picture, Json sampler) {
    Json texture = {{"source", add("images", {{"bufferView", view(picture)}, {"mimeType", "image/png"}})}};
    if (!sampler.is_null()) texture["sampler"] = add("samplers", std::move(sampler));
    return add("textures", std::move(texture));
}

ByteVector GltfBuilder::gltf() const {
    Json out = document;
    if (!buffer.empty() && !out.contains("buffers")) {
        out["buffers"] = Json::array(
            {{{"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer)}}});
    }
    const std::string text = out.dump();
    return {text.begin(), text.end()};
}

ByteVector GltfBuilder::glb() const {
    Json out = document;
    ByteVector chunk = buffer;
    out["buffers"] = Json::array({{{"byteLength", chunk.size()}}});
    while (chunk.size() % 4 != 0) chunk.push_back(0);
    std::string text = out.dump();
    while (text.size() % 4 != 0) text += ' ';
    ByteVector file = {'g', 'l', 'T', 'F'};
    append32(file, 2);
    append32(file, 12 + 8 + text.size() + 8 + chunk.size());
    append32(file, text.size());
    append32(file, 0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    append32(file, chunk.size());
    append32(file, 0x004E4942);
    file.insert(file.end(), chunk.begin(), chunk.end());
    return file;
}

Scene GltfBuilder::load(const LoadOptions& options) const {
    const TempFolder folder;
    return loadGltf(folder.write("scene.gltf", gltf()), options);
}

std::vector<float> Quad::positions() {
    return {-1, 1, 0, -1, -1, 0, 1, -1, 0, 1, 1, 0};
}
std::vector<float> Quad::normals() {
    return {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
}
std::vector<float> Quad::uvs() {
    return {0, 0, 0, 1, 1, 1, 1, 0};
}

GltfBuilder quadBuilder() {
    GltfBuilder builder;
    const int position = builder.accessor(Quad::positions(), "VEC3");
    const int normal = builder.accessor(Quad::normals(), "VEC3");
    const int uv = builder.accessor(Quad::uvs(), "VEC2");
    const int indices = builder.accessor(Quad::indices<std::uint16_t>(), "SCALAR");
    builder.addMesh(
        {{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}}, {"indices", indices}});
    return builder;
}

ByteVector pngRgba8() {
    return fromHex(
        "89504e470d0a1a0a0000000d494844520000000200000002080600000072b60d24000000174944415478da63f8cfc0f01f081b1880f4"
        "7f2e11390d003ba405e0779e91ef0000000049454e44ae426082");
}

ByteVector pngRgb16() {
    return fromHex(
        "89504e470d0a1a0a0000000d49484452000000020000000110020000002bd0349e000000144944415478da63f8ff9f918101880c2caf"
        "1802001a4b036fdc8425bf0000000049454e44ae426082");
}

std::string refusalOf(const std::filesystem::path& path) {
    try {
        loadGltf(path);
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_THAT(message, testing::StartsWith(path.filename().string() + ": "));
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_LT(message.size(), 400u) << message;
        return message;
    }
    return {};
}

std::string refusalOf(const ByteVector& file) {
    const TempFolder folder;
    return refusalOf(folder.write("scene.gltf", file));
}

std::string refusalOf(const GltfBuilder& builder) {
    return refusalOf(builder.gltf());
}

}  // namespace earthshine::raster::test
