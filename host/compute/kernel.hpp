#pragma once
// A kernel with arguments by name, and the one way to launch it.

#include <string>
#include <string_view>
#include <vector>

#include "compute/device_impl.hpp"
#include "compute/surface.hpp"

namespace earthshine {

/// One kernel built for a device's lanes, storage and records. Not thread-safe: arguments are its state.
class Kernel {
public:
    /// Builds kernels/NAME.cl and takes its kernel NAME. Throws BuildError with the compiler's log.
    Kernel(const Device& device, std::string name);

    /// Sets the argument that the kernel's source calls `argument`; a surface also sets its layout.
    /// Throws DeviceError if there is no such argument or the driver refuses the value.
    Kernel& set(std::string_view argument, const Surface& surface);
    Kernel& set(std::string_view argument, const cl::Buffer& buffer);
    Kernel& set(std::string_view argument, const cl::Image2D& image);
    template <class Params>
    Kernel& setParams(std::string_view argument, const Params& params) {
        setRaw(argument, sizeof(Params), &params);
        return *this;
    }

    /// Launches over an extent: one item per LANES pixels of a row, the global size rounded up to whole groups.
    void enqueue(Extent extent);
    /// Launches `x` by `y` work-items, rounded up to whole groups.
    void enqueueItems(std::size_t x, std::size_t y);

private:
    void setRaw(std::string_view argument, std::size_t size, const void* value);
    void setMemory(std::string_view argument, const cl::Memory& memory);

    Device device_;
    std::string name_;
    cl::Kernel kernel_;
    std::vector<std::string> arguments_;
    std::size_t localSize_[2] = {1, 1};
};

}  // namespace earthshine
