#include "compute/program_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "compute/kernel_source.hpp"
#include "earthshine/error.hpp"
#include "earthshine/log.hpp"

namespace earthshine {

namespace {

namespace fs = std::filesystem;

// An entry is: magic, key size, binary size, hash of the binary; then the key's text and the binary.
constexpr std::uint64_t kMagic = 0x31304c435345ull;  // "ESCL01"
struct Header {
    std::uint64_t magic, keyBytes, binaryBytes, binaryHash;
};

// FNV-1a. Names files and finds damage; that two keys are one is decided by comparing them whole.
std::uint64_t hashOf(const void* data, std::size_t size) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (std::size_t i = 0; i < size; ++i)
        hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3ull;
    return hash;
}

std::vector<unsigned char> readEntry(const fs::path& path, const std::string& key) {
    std::ifstream in(path, std::ios::binary);
    Header header{};
    std::error_code error;
    const auto fileBytes = fs::file_size(path, error);
    if (error || !in.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != kMagic ||
        header.keyBytes != key.size() || header.binaryBytes > fileBytes)
        return {};
    std::string storedKey(header.keyBytes, '\0');
    std::vector<unsigned char> binary(header.binaryBytes);
    if (!in.read(storedKey.data(), std::streamsize(storedKey.size())) || storedKey != key) return {};
    if (!in.read(reinterpret_cast<char*>(binary.data()), std::streamsize(binary.size()))) return {};
    if (hashOf(binary.data(), binary.size()) != header.binaryHash) return {};
    return binary;
}

// Written beside its place and renamed, so that two programs at once do not see half an entry.
void writeEntry(const fs::path& path, const std::string& key, const std::vector<unsigned char>& binary) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    const fs::path temporary = fmt::format("{}.{}.{}.tmp", path.string(), ::getpid(),
                                           std::hash<std::thread::id>()(std::this_thread::get_id()));
    {
        std::ofstream out(temporary, std::ios::binary);
        const Header header{kMagic, key.size(), binary.size(), hashOf(binary.data(), binary.size())};
        out.write(reinterpret_cast<const char*>(&header), sizeof header);
        out.write(key.data(), std::streamsize(key.size()));
        out.write(reinterpret_cast<const char*>(binary.data()), std::streamsize(binary.size()));
        if (!out) {
            log(LogLevel::Debug, fmt::format("kernel cache: cannot write {}", temporary.string()));
            out.close();
            fs::remove(temporary, error);
            return;
        }
    }
    fs::rename(temporary, path, error);
    if (error) fs::remove(temporary, error);
}

cl::Program buildFromSource(const cl::Context& context, const cl::Device& device, const std::string& name,
                            const std::string& source, const std::string& options, const std::string& deviceName) {
    // Until the end of this scope, whatever comes of it.
    struct Shown {
        explicit Shown(const std::string& kernel) { log(LogLevel::Progress, "compiling kernel " + kernel); }
        Shown(const Shown&) = delete;
        Shown& operator=(const Shown&) = delete;
        ~Shown() { log(LogLevel::Progress, ""); }
    } const shown(name);
    cl::Program program(context, source);
    try {
        program.build({device}, options.c_str());
    } catch (const cl::Error& error) {
        const auto buildLog = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
        throw BuildError(
            fmt::format("{}.cl: {} on \"{}\" with {}", name, clErrorName(error.err()), deviceName, options),
            withFilesAndLines(buildLog, source));
    }
    return program;
}

}  // namespace

std::string cacheFolderFor(const std::string& asked) {
    std::string folder = asked;
    if (folder.empty())
        if (const char* own = std::getenv("EARTHSHINE_CACHE")) folder = own;
    if (folder == "none") return {};
    if (!folder.empty()) return folder;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg) return (fs::path(xdg) / "earthshine").string();
    if (const char* home = std::getenv("HOME"); home && *home) return (fs::path(home) / ".cache/earthshine").string();
    return {};
}

cl::Program buildProgram(const cl::Context& context, const cl::Device& device, const std::string& name,
                         const std::string& source, const std::string& options, const std::string& cacheFolder) {
    const std::string deviceName = device.getInfo<CL_DEVICE_NAME>();
    if (cacheFolder.empty()) return buildFromSource(context, device, name, source, options, deviceName);

    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    const std::string key =
        fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", platform.getInfo<CL_PLATFORM_NAME>(), deviceName,
                    device.getInfo<CL_DEVICE_VENDOR>(), device.getInfo<CL_DRIVER_VERSION>(),
                    device.getInfo<CL_DEVICE_VERSION>(), platform.getInfo<CL_PLATFORM_VERSION>(), options, source);
    const fs::path path = fs::path(cacheFolder) / fmt::format("{}-{:016x}.bin", name, hashOf(key.data(), key.size()));

    if (std::vector<unsigned char> binary = readEntry(path, key); !binary.empty()) {
        try {
            cl::Program program(context, {device}, {binary});
            program.build({device}, options.c_str());
            return program;
        } catch (const cl::Error&) {
            log(LogLevel::Debug, fmt::format("kernel cache: the driver refuses {}, building anew", path.string()));
        }
    }
    cl::Program program = buildFromSource(context, device, name, source, options, deviceName);
    try {
        const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
        if (!binaries.empty() && !binaries[0].empty()) writeEntry(path, key, binaries[0]);
    } catch (const cl::Error&) {
        log(LogLevel::Debug, fmt::format("kernel cache: the driver gives no binary of {}", name));
    }
    return program;
}

}  // namespace earthshine
