#pragma once
// The bytes of a glTF file, and the only door to the files beside it.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::raster {

using Bytes = std::vector<unsigned char>;

/// What a scene may ask of this machine. A file that says more is wrong or hostile; without these limits a few bytes
/// could ask for all of the memory.
namespace gltf_limits {
inline constexpr std::uintmax_t kFileBytes = 0x7fffffff;                ///< one file; tinygltf counts in int
inline constexpr std::uintmax_t kTotalBytes = std::uintmax_t(1) << 32;  ///< all files of a scene
inline constexpr std::size_t kJsonBytes = std::size_t(1) << 29;         ///< parsed, it takes up to 10 times as much
inline constexpr int kJsonDepth = 64;                                   ///< glTF itself needs about 10
inline constexpr std::size_t kVertices = std::size_t(1) << 26;          ///< all meshes of a scene
inline constexpr std::size_t kIndices = std::size_t(1) << 27;           ///< all meshes of a scene
inline constexpr std::size_t kInstances = std::size_t(1) << 22;         ///< many nodes may share a mesh of many parts
inline constexpr std::size_t kElements = std::size_t(1) << 30;          ///< that accessors give, morph targets included
inline constexpr std::size_t kAnimationKeys = std::size_t(1) << 22;     ///< all animations of a scene
inline constexpr int kImageSidePx = 16384;                              ///< what current GPUs can hold
inline constexpr std::size_t kImageBytes = std::size_t(1) << 30;        ///< one image, decoded
inline constexpr std::size_t kTextureBytes = std::size_t(1) << 33;      ///< all textures of a scene, decoded
}  // namespace gltf_limits

/// `text` from a file, fit for a message of one line: without control characters, cut after `longest` bytes.
std::string printable(std::string_view text, std::size_t longest = 80);

/// A .gltf or .glb file, told apart by its content.
class GltfFile {
public:
    /// Reads the file and takes a .glb apart. Throws InputError.
    explicit GltfFile(const std::filesystem::path& path);

    const std::string& json() const noexcept { return json_; }
    /// The second chunk of a .glb; empty without one.
    const Bytes& binaryChunk() const noexcept { return binaryChunk_; }

    /// The bytes behind a URI of the file: base64 in the URI itself, or a file in the same folder or below.
    /// `place` is who asks, for the message. Throws InputError if the file is elsewhere, missing or too large.
    Bytes read(const std::string& uri, std::string_view place);

    /// Throws InputError if read() would refuse the URI for what it names, be there such a file or not.
    void checkUri(const std::string& uri, std::string_view place) const;

    /// Throws InputError("file: place: what"), or without the place if it is empty.
    [[noreturn]] void fail(std::string_view place, std::string_view what) const;

private:
    std::filesystem::path resolve(const std::string& uri, std::string_view place) const;
    Bytes readBytes(const std::filesystem::path& path, std::string_view place);
    void splitBinary(const Bytes& bytes);

    std::string name_;
    std::filesystem::path folder_;  // canonical
    std::uintmax_t bytesRead_ = 0;
    std::string json_;
    Bytes binaryChunk_;
};

}  // namespace earthshine::raster
