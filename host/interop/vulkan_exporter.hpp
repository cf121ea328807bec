#pragma once
// Vulkan as an allocator: images and semaphores that leave as file descriptors. Loaded at run time; no window, no queue
// is ever used.

#include <array>
#include <cstdint>
#include <memory>

#include "earthshine/image.hpp"

namespace earthshine {

/// A device's number in Vulkan (deviceUUID), GL_EXT_memory_object and cl_khr_device_uuid.
using DeviceUuid = std::array<std::uint8_t, 16>;

/// A file descriptor; closed unless someone takes it.
class Fd {
public:
    Fd() = default;
    explicit Fd(int fd) : fd_(fd) {}
    Fd(Fd&& other) noexcept;
    Fd& operator=(Fd&& other) noexcept;
    ~Fd();

    int get() const noexcept { return fd_; }
    /// It belongs to someone else now: a driver that imported it.
    void disown() noexcept { fd_ = -1; }

private:
    int fd_ = -1;
};

class VulkanExporter {
public:
    /// Opens the device of that number. Throws DeviceError: no loader, no driver, no such device, a missing extension.
    explicit VulkanExporter(const DeviceUuid& uuid);
    ~VulkanExporter();
    VulkanExporter(const VulkanExporter&) = delete;
    VulkanExporter& operator=(const VulkanExporter&) = delete;

    /// An image in memory of its own, optimal tiling, as opaque descriptors, one an importer. `id` frees it; the
    /// importers keep what they imported.
    struct Image {
        std::uint64_t id = 0;
        std::uint64_t sizeBytes = 0;
        Fd forGl, forCl;
    };
    Image makeImage(PixelFormat format, Extent extent);
    void free(std::uint64_t imageId) noexcept;

    /// A binary semaphore, not signalled.
    struct Semaphore {
        Fd forGl, forCl;
    };
    Semaphore makeSemaphore();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace earthshine
