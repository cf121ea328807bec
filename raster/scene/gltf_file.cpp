#include "raster/scene/gltf_file.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "earthshine/error.hpp"

namespace earthshine::raster {

namespace {

namespace fs = std::filesystem;

std::uint32_t littleEndian32(const Bytes& bytes, std::size_t offset) {
    return std::uint32_t(bytes[offset]) | std::uint32_t(bytes[offset + 1]) << 8 |
           std::uint32_t(bytes[offset + 2]) << 16 | std::uint32_t(bytes[offset + 3]) << 24;
}

bool isDataUri(std::string_view uri) {
    return uri.starts_with("data:");
}

/// "%20" becomes a space and so on, RFC 3986; what is not two hexadecimal digits stays.
std::string percentDecoded(std::string_view uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escape = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        out += escape ? char(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
        if (escape) i += 2;
    }
    return out;
}

/// The bytes of "data:TYPE;base64,..."; empty if it is not that.
Bytes dataUriBytes(const std::string& uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) return {};
    // tinygltf decodes a few media types only; the decoding does not depend on the type.
    const std::string plain = "data:application/octet-stream;base64," + uri.substr(comma + 1);
    Bytes bytes;
    std::string mimeType;
    tinygltf::DecodeDataURI(&bytes, mimeType, plain, 0, false);
    return bytes;
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
    std::string out(text.substr(0, longest));
    std::replace_if(
        out.begin(), out.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return text.size() > longest ? out + "..." : out;
}

GltfFile::GltfFile(const fs::path& path) : name_(path.filename().string()) {
    std::error_code error;
    const fs::path real = fs::canonical(path, error);
    if (error) throw InputError(fmt::format("{}: {}", printable(path.string()), error.message()));
    folder_ = real.parent_path();
    Bytes bytes = readBytes(real, "");
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) {
        splitBinary(bytes);
    } else {
        json_.assign(bytes.begin(), bytes.end());
    }
    if (json_.size() > gltf_limits::kJsonBytes) {
        fail("", fmt::format("has {} B of JSON; {} B is the most", json_.size(), gltf_limits::kJsonBytes));
    }
}

void GltfFile::fail(std::string_view place, std::string_view what) const {
    throw InputError(place.empty() ? fmt::format("{}: {}", printable(name_), what)
                                   : fmt::format("{}: {}: {}", printable(name_), place, what));
}

void GltfFile::splitBinary(const Bytes& bytes) {
    constexpr std::size_t kHeader = 12;
    constexpr std::size_t kChunkHeader = 8;
    constexpr std::uint32_t kJson = 0x4E4F534A;
    constexpr std::uint32_t kBin = 0x004E4942;
    if (bytes.size() < kHeader + kChunkHeader)
        fail("", fmt::format("a .glb of {} B has no room for a chunk", bytes.size()));
    if (const std::uint32_t version = littleEndian32(bytes, 4); version != 2) {
        fail("header", fmt::format("is version {} of .glb; only version 2 is read", version));
    }
    const std::size_t length = littleEndian32(bytes, 8);
    if (length > bytes.size()) fail("header", fmt::format("says {} B, the file holds {} B", length, bytes.size()));
    std::size_t offset = kHeader;
    for (int chunk = 0; chunk < 2 && offset < length; ++chunk) {
        const std::string place = fmt::format("chunk {}", chunk);
        if (length - offset < kChunkHeader)
            fail(place, fmt::format("{} B are left for its header of 8 B", length - offset));
        const std::size_t size = littleEndian32(bytes, offset);
        const std::uint32_t type = littleEndian32(bytes, offset + 4);
        offset += kChunkHeader;
        if (size > length - offset) fail(place, fmt::format("says {} B, {} B are left", size, length - offset));
        const auto begin = bytes.begin() + std::ptrdiff_t(offset);
        if (chunk == 0) {
            if (type != kJson) fail(place, "is not JSON");
            json_.assign(begin, begin + std::ptrdiff_t(size));
            json_.erase(json_.find_last_not_of('\0') + 1);  // padding of old exporters; it should be spaces
        } else if (type == kBin) {
            binaryChunk_.assign(begin, begin + std::ptrdiff_t(size));
        }
        offset += size;
    }
}

Bytes GltfFile::readBytes(const fs::path& path, std::string_view place) {
    std::error_code error;
    // Devices and pipes have no size and may never end.
    if (!fs::is_regular_file(path, error)) fail(place, "is not a file");
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) fail(place, error.message());
    if (size > gltf_limits::kFileBytes) {
        fail(place, fmt::format("is a file of {} B; {} B is the most", size, gltf_limits::kFileBytes));
    }
    bytesRead_ += size;
    if (bytesRead_ > gltf_limits::kTotalBytes) {
        fail(place, fmt::format("the scene's files together hold more than {} B", gltf_limits::kTotalBytes));
    }
    std::ifstream stream(path, std::ios::binary);
    Bytes bytes(size);
    if (!stream || !stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
        fail(place, "cannot be read");
    return bytes;
}

fs::path GltfFile::resolve(const std::string& uri, std::string_view place) const {
    const std::string relative = percentDecoded(uri);
    if (relative.find("://") != std::string::npos)
        fail(place, "is not a file beside the scene; download it and name it there");
    if (relative.empty() || relative.find('\0') != std::string::npos) fail(place, "is no file name");
    std::error_code error;
    fs::path real = fs::weakly_canonical(folder_ / relative, error);
    if (error) fail(place, error.message());
    const auto [end, ignored] = std::mismatch(folder_.begin(), folder_.end(), real.begin(), real.end());
    if (end != folder_.end()) fail(place, "is outside the scene's folder; move it there");
    return real;
}

void GltfFile::checkUri(const std::string& uri, std::string_view place) const {
    if (isDataUri(uri)) return;
    resolve(uri, fmt::format("{}: \"{}\"", place, printable(uri)));
}

Bytes GltfFile::read(const std::string& uri, std::string_view place) {
    if (isDataUri(uri)) {
        Bytes bytes = dataUriBytes(uri);
        if (bytes.empty()) fail(place, "its data URI holds no base64 data");
        return bytes;
    }
    const std::string what = fmt::format("{}: \"{}\"", place, printable(uri));
    const fs::path path = resolve(uri, what);
    std::error_code error;
    if (!fs::exists(path, error)) fail(what, "there is no such file");
    return readBytes(path, what);
}

}  // namespace earthshine::raster
