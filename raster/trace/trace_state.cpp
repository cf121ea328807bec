// The file: the line "earthshine trace 1\n", then in native byte order the fingerprint (u64), width, height and sample
// count (i32 each), the two halves (three f64 a pixel, rows from the top), and FNV-1a of all before it (u64).

#include "raster/trace/trace_state.hpp"

#include <cstring>
#include <fstream>
#include <limits>

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine::trace {

namespace {

constexpr std::string_view kMagic = "earthshine trace 1\n";

/// FNV-1a over 64-bit words, the last one filled up with zeros.
class Fnv {
public:
    void add(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const char*>(data);
        for (; size >= sizeof(std::uint64_t); bytes += sizeof(std::uint64_t), size -= sizeof(std::uint64_t))
            addWord(bytes, sizeof(std::uint64_t));
        if (size > 0) addWord(bytes, size);
    }
    template <class T>
    void add(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
        add(&value, sizeof(value));
    }
    template <class... Floats>
    void addFloats(Floats... values) {
        (add(float(values)), ...);
    }
    template <class Vector>
    void addVector(const Vector& v) {  // GLM vectors and matrices of floats
        static_assert(sizeof(v) % sizeof(float) == 0);
        add(&v, sizeof(v));
    }
    template <class T>
    void addAll(const std::vector<T>& values) {
        add(std::uint64_t(values.size()));
        add(values.data(), values.size() * sizeof(T));
    }
    std::uint64_t value() const { return hash_; }

private:
    void addWord(const char* bytes, std::size_t size) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes, size);
        hash_ = (hash_ ^ word) * 0x100000001b3u;
        hash_ ^= hash_ >> 32;  // FNV of words alone hardly mixes their high bits
    }
    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

void addTextureRef(Fnv& fnv, const raster::TextureRef& ref) {
    fnv.add(std::int32_t(ref.texture));
    fnv.add(std::int32_t(ref.texCoord));
    fnv.addVector(ref.uvFromUv);
}

void addCamera(Fnv& fnv, const Camera& camera) {
    fnv.addVector(camera.viewFromWorld);
    fnv.addVector(camera.clipFromView);
}

void addScene(Fnv& fnv, const raster::Scene& scene) {
    for (const raster::Instance& instance : scene.instances) {
        fnv.add(std::int32_t(instance.mesh));
        fnv.addVector(instance.worldFromObject);
    }
    for (const raster::Mesh& mesh : scene.meshes) {
        fnv.addAll(mesh.vertices);
        fnv.addAll(mesh.indices);
        fnv.add(std::int32_t(mesh.material));
    }
    for (const raster::Material& m : scene.materials) {
        fnv.addVector(m.baseColor);
        fnv.addFloats(m.metallic, m.normalScale, m.alphaCutoff);
        fnv.add(std::int32_t(m.alphaMode));
        fnv.add(std::int32_t(m.doubleSided));
        for (const auto* ref : {&m.baseColorTexture, &m.metallicTexture, &m.normalTexture}) addTextureRef(fnv, *ref);
    }
    for (const raster::Texture& t : scene.textures) {
        for (const int value :
             {t.widthPx, t.heightPx, int(t.isSrgb), int(t.wrapU), int(t.wrapV), int(t.linearFilter), int(t.mipmaps)})
            fnv.add(std::int32_t(value));
        fnv.addAll(t.rgba8);
        fnv.addAll(t.rgba16);
    }
}

template <class T>
void put(std::string& bytes, const T* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <class T>
T take(const std::string& bytes, std::size_t& at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    at += sizeof(T);
    return value;
}

std::uint64_t checksum(const std::string& bytes, std::size_t size) {
    Fnv fnv;
    fnv.add(bytes.data(), size);
    return fnv.value();
}

}  // namespace

std::uint64_t fingerprintOf(const raster::Scene& scene, const Camera& camera, std::span<const Light> lights,
                            const TraceSettings& settings) {
    Fnv fnv;
    addScene(fnv, scene);
    addCamera(fnv, camera);
    for (const Light& light : lights) {
        fnv.add(std::int32_t(light.type));
        fnv.addVector(light.intensity);
        fnv.addFloats(light.innerConeAngle, light.outerConeAngle, light.rangeM);
        addCamera(fnv, light.camera);
    }
    for (const int value : {settings.bounceCount, int(settings.indirectVisibility), int(settings.strategy)})
        fnv.add(std::int32_t(value));
    fnv.add(settings.seed);
    return fnv.value();
}

void writeSums(const std::string& path, std::uint64_t fingerprint, Extent extent, const TraceSums& sums) {
    std::string bytes(kMagic);
    const std::int32_t header[] = {extent.widthPx, extent.heightPx, sums.sampleCount};
    put(bytes, &fingerprint, 1);
    put(bytes, header, std::size(header));
    for (const auto& half : sums.halves) put(bytes, half.data(), half.size());
    const std::uint64_t sum = checksum(bytes, bytes.size());
    put(bytes, &sum, 1);
    std::ofstream stream(path, std::ios::binary);
    stream.write(bytes.data(), std::streamsize(bytes.size()));
    stream.flush();
    if (!stream) throw Error(fmt::format("{}: cannot be written", path));
}

TraceSums readSums(const std::string& path, std::uint64_t fingerprint, Extent extent) {
    const auto refuse = [&path](const char* what) -> InputError {
        return InputError(fmt::format("{}: {}", path, what));
    };
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw refuse("cannot be read");
    const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    std::size_t at = kMagic.size();
    constexpr std::size_t kHeaderBytes = sizeof(std::uint64_t) + 3 * sizeof(std::int32_t);
    if (bytes.compare(0, kMagic.size(), kMagic) != 0 || bytes.size() < at + kHeaderBytes + sizeof(std::uint64_t))
        throw refuse("is not a state of `earthshine reference`");
    const auto found = take<std::uint64_t>(bytes, at);
    const auto width = take<std::int32_t>(bytes, at), height = take<std::int32_t>(bytes, at);
    TraceSums sums;
    sums.sampleCount = take<std::int32_t>(bytes, at);
    if (Extent{width, height} != extent)
        throw InputError(fmt::format("{}: is of {}x{} pixels, the picture of {}x{}: remove the file to start anew",
                                     path, width, height, extent.widthPx, extent.heightPx));
    if (found != fingerprint)
        throw refuse("was made with another scene, camera, light or setting: remove the file to start anew");
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    std::size_t end = bytes.size() - sizeof(std::uint64_t);
    if (end - at != 2 * pixels * sizeof(glm::dvec3) || sums.sampleCount < 0 ||
        checksum(bytes, end) != take<std::uint64_t>(bytes, end))
        throw refuse("is damaged: remove the file to start anew");
    for (auto& half : sums.halves) {
        half.resize(pixels);
        std::memcpy(half.data(), bytes.data() + at, pixels * sizeof(glm::dvec3));
        at += pixels * sizeof(glm::dvec3);
    }
    return sums;
}

}  // namespace earthshine::trace
