#pragma once
// glTF files made by hand: a JSON document, the bytes of its buffer, and a folder to write them to.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "raster/scene/gltf_loader.hpp"

namespace earthshine::raster::test {

using Json = nlohmann::json;
using ByteVector = std::vector<unsigned char>;

/// A folder of its own, gone at the end.
class TempFolder {
public:
    TempFolder();
    ~TempFolder();
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    const std::filesystem::path& path() const noexcept { return path_; }
    /// Writes a file in it (folders of its name are made) and returns its path.
    std::filesystem::path write(const std::string& name, const ByteVector& bytes) const;

private:
    std::filesystem::path path_;
};

/// A glTF document in the making. All data is one buffer.
struct GltfBuilder {
    Json document = {{"asset", {{"version", "2.0"}}}};
    ByteVector buffer;

    /// Appends bytes at a multiple of four; the index of the new buffer view. `stride` 0: none.
    template <typename T>
    int view(const std::vector<T>& values, int stride = 0) {
        ByteVector bytes(values.size() * sizeof(T));
        std::memcpy(bytes.data(), values.data(), bytes.size());
        return addView(bytes, stride);
    }
    /// A view of its own and an accessor of all of it, `type` as glTF spells it; the accessor's index.
    template <typename T>
    int accessor(const std::vector<T>& values, const char* type, bool normalized = false) {
        return addAccessor(view(values), componentType(T()), values.size() / componentsOf(type), type, normalized);
    }
    int addAccessor(int view, int componentType, std::size_t count, const char* type, bool normalized = false,
                    std::size_t byteOffset = 0);
    /// Appends to an array of the document; the index.
    int add(const char* array, Json element);
    /// A mesh of one primitive, a node that shows it; the node's index.
    int addMesh(Json primitive, Json node = Json::object());
    /// Appends to KHR_lights_punctual; the index.
    int addLight(Json light);
    /// images[], textures[]: a picture in the buffer; the texture's index.
    int addTexture(const ByteVector& picture, Json sampler = nullptr);

    /// The document with its buffer as a data URI, as a .gltf.
    ByteVector gltf() const;
    /// The same as a .glb, its buffer as the binary chunk.
    ByteVector glb() const;
    /// Loads gltf() from a folder of its own.
    Scene load(const LoadOptions& options = {}) const;

    static int componentType(std::int8_t) { return 5120; }
    static int componentType(std::uint8_t) { return 5121; }
    static int componentType(std::int16_t) { return 5122; }
    static int componentType(std::uint16_t) { return 5123; }
    static int componentType(std::uint32_t) { return 5125; }
    static int componentType(float) { return 5126; }
    static std::size_t componentsOf(const std::string& type);

private:
    int addView(const ByteVector& bytes, int stride);
    Json withScene() const;
};

/// The square [-1; 1]^2 in z = 0 seen from +z: positions, normals, uv (0, 0) top left, and its two triangles.
struct Quad {
    static std::vector<float> positions();
    static std::vector<float> normals();
    static std::vector<float> uvs();
    template <typename T>
    static std::vector<T> indices() {
        return {0, 1, 2, 0, 2, 3};
    }
};

/// A builder with the quad, indexed, as meshes[0] and nodes[0]; accessors: 0 positions, 1 normals, 2 uvs, 3 indices.
GltfBuilder quadBuilder();

/// PNG pictures: 2 x 2 of 8-bit RGBA, 2 x 1 of 16-bit RGB.
ByteVector pngRgba8();
ByteVector pngRgb16();

/// What loadGltf() says when it refuses the file; empty if it loads it. Fails the test if the message is not one line.
std::string refusalOf(const std::filesystem::path& path);
std::string refusalOf(const ByteVector& file);
std::string refusalOf(const GltfBuilder& builder);

}  // namespace earthshine::raster::test
