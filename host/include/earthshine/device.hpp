#pragma once
// OpenCL devices: what is here, what matters to us about each, and which one to use.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace earthshine {

/// How a kernel's surfaces are kept: OpenCL images; one buffer of float planes with padded rows; or one buffer of
/// pixels, whose three numbers share 64 bits (12 or 13 of mantissa each: kernels/common/packed_three.clh).
enum class Storage { Image, Planar, Packed };

/// How kernels are built and launched on a device. Defaults come from the tuning table (bench/README.md).
struct Tuning {
    struct Group {
        std::string kernel;
        int localSizePx[2];
    };

    int lanes = 1;                     ///< pixels a work-item computes: 1, 4, 8 or 16
    Storage storage = Storage::Image;  ///< of every surface
    bool rsmRecords = true;            ///< gather from packed 32-byte records; false: from the RSM's three images
    bool filterPairs = true;           ///< a row and a column of the separable filter in one launch; false: in two
    int localSizePx[2] = {1, 1};       ///< work-items a group, x and y
    std::vector<Group> groups;         ///< the same of kernels that have their own
    std::string reason;                ///< one line: where lanes and storage come from
};

/// What a device can do, asked once.
struct DeviceCaps {
    int index = 0;  ///< over all platforms, in the loader's order; what --device takes
    std::string name, vendor, deviceVersion, driverVersion, openclCVersion, platformName, platformVersion;
    std::string type;  ///< "GPU", "CPU", "accelerator" or "other"
    bool available = false;
    bool images = false;                    ///< image support at all
    std::vector<std::string> imageFormats;  ///< of our four PixelFormats, those that images can be read and written in
    std::vector<std::string> transports;  ///< "host", and "gl-sharing", "external-memory" if their extensions are there
    int nativeFloatWidth = 0;
    int computeUnits = 0;
    std::size_t localMemoryBytes = 0;
    std::size_t globalMemoryBytes = 0;
    std::size_t maxAllocationBytes = 0;
    std::size_t maxWorkGroupSize = 0;
    std::size_t maxImageSizePx[2] = {0, 0};
    bool unifiedMemory = false;
    bool fusesMultiplyAdd = false;  ///< fma() is one instruction
    std::string unusable;           ///< why this device cannot run Earthshine; empty if it can
    Tuning tuning;                  ///< the defaults chosen for it
};

/// Every device of every platform that the ICD loader finds; empty without any. Never throws for a broken driver: such
/// a device is listed with `unusable` set.
std::vector<DeviceCaps> listDevices();

/// The device that `spec` means: a number (DeviceCaps::index), a part of a device's or platform's name (any case), or
/// "" for $EARTHSHINE_DEVICE, and without that the first usable GPU, else CPU, else anything.
/// Throws UsageError if nothing or more than one device fits a name, DeviceError if there is none that works.
/// `why`, if given, receives one line on the choice.
DeviceCaps selectDevice(const std::string& spec, std::string* why = nullptr);

/// What to change of a device's own defaults; for experiments and tests.
struct DeviceOptions {
    int lanes = 0;                ///< 0 = the tuning table's
    std::string storage;          ///< "image", "planar", "packed", "" = the tuning table's
    int rsmRecords = -1;          ///< 0, 1, -1 = the tuning table's
    int filterPairs = -1;         ///< 0, 1, -1 = 1
    int localSizePx[2] = {0, 0};  ///< of every kernel; 0 = the tuning table's
    std::string tuningFile;       ///< rows that go before the library's own; "" = $EARTHSHINE_TUNING or none
    bool profiling = false;       ///< stage times by profiling events; slows some drivers down (Intel's by up to 1.8x)
    std::string
        kernelFolder;         ///< read kernel sources from here, not from the library; "" = $EARTHSHINE_KERNELS or none
    std::string cacheFolder;  ///< "" = $EARTHSHINE_CACHE, else $XDG_CACHE_HOME/earthshine, else ~/.cache/earthshine;
                              ///< "none" = off
    std::vector<std::intptr_t> contextProperties;  ///< more for clCreateContext, in pairs; openForGl fills it
};

/// An open device: context, one queue, program cache. Shared by copies, which all belong to one thread at a time; the
/// last one closes it. Close before GL.
class Device {
public:
    /// Throws DeviceError if the device cannot be opened, UsageError for options that it does not have.
    explicit Device(const DeviceCaps& caps, const DeviceOptions& options = {});

    const DeviceCaps& caps() const noexcept;
    const Tuning& tuning() const noexcept;

    /// Bytes of all surfaces and buffers made on it so far; what was given back since is not taken off. Pixels of the
    /// host that are read in place, or on their way, do not count.
    std::size_t allocatedBytes() const noexcept;

    struct Impl;
    Impl& impl() const noexcept { return *impl_; }

private:
    std::shared_ptr<Impl> impl_;
};

}  // namespace earthshine
