#pragma once
// A kernel with arguments by name, and the one way to launch it.

#include <array>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compute/device_impl.hpp"
#include "compute/surface.hpp"

namespace earthshine {

/// One kernel for a device's lanes, storage and records. Not thread-safe: arguments are its state.
class Kernel {
public:
    /// Kernel NAME of kernels/NAME.cl; or of `text`, which is not among the library's kernels, but what it includes is.
    /// It is built when it is first used: a frame waits for none that it does not need.
    Kernel(const Device& device, std::string name, std::string text = {})
        : device_(device), name_(std::move(name)), text_(std::move(text)) {}

    Kernel(Kernel&&) = default;
    Kernel(const Kernel&) = delete;

    /// Builds it, if nothing has yet; what follows does so too. Throws BuildError with the compiler's log.
    void build();

    /// Makes `name` a constant of the source for what follows: a loop on a CPU should not ask in each round what is the
    /// same for a whole frame. Every set of values is built once and kept, with arguments of its own: set all anew.
    Kernel& define(std::string_view name, int value);

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

    /// Work-items a group, x and y: what the kernel requires, or the tuning table's within the kernel's limit.
    std::array<std::size_t, 2> localSize() {
        build();
        return built_->localSize;
    }

private:
    struct Built {
        cl::Kernel kernel;
        std::array<std::size_t, 2> localSize{1, 1};
    };
    std::string definitions() const;
    void setRaw(std::string_view argument, std::size_t size, const void* value);
    void setMemory(std::string_view argument, const cl::Memory& memory);

    Device device_;
    std::string name_, text_;
    std::vector<std::string> arguments_;
    std::map<std::string, int, std::less<>> defined_;
    std::map<std::string, Built> variants_;  ///< by definitions()
    Built* built_ = nullptr;                 ///< that of defined_, once it is built
};

}  // namespace earthshine
