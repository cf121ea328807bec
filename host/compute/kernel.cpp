#include "compute/kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compute/kernel_source.hpp"
#include "compute/program_cache.hpp"
#include "compute/tuning.hpp"
#include "earthshine/error.hpp"

namespace earthshine {

namespace {

static_assert(int(Storage::Image) == STORAGE_IMAGE && int(Storage::Planar) == STORAGE_PLANAR &&
              int(Storage::Packed) == STORAGE_PACKED);

std::string buildOptions(const DeviceCaps& caps, const Tuning& tuning) {
    return fmt::format("-cl-std=CL1.2 -DES_DIALECT_CL -DLANES={} -DSTORAGE={} -DRSM_RECORDS={} -DES_FMA={}",
                       tuning.lanes, int(tuning.storage), tuning.rsmRecords ? 1 : 0, caps.fusesMultiplyAdd ? 1 : 0);
}

}  // namespace

std::string Kernel::definitions() const {
    std::string options;
    for (const auto& [name, value] : defined_) options += fmt::format(" -D{}={}", name, value);
    return options;
}

Kernel& Kernel::define(std::string_view name, int value) {
    const auto at = defined_.find(name);
    if (at != defined_.end() && at->second == value) return *this;
    defined_.insert_or_assign(std::string(name), value);
    built_ = nullptr;
    return *this;
}

void Kernel::build() {
    if (built_) return;
    const std::string options = definitions();
    if (const auto at = variants_.find(options); at != variants_.end()) {
        built_ = &at->second;
        return;
    }
    Device::Impl& impl = device_.impl();
    const std::string& folder = impl.options.kernelFolder;
    const std::string source =
        text_.empty() ? expandKernel(name_ + ".cl", folder) : expandKernelText(name_ + ".cl", text_, folder);
    arguments_ = argumentNames(source, name_, impl.tuning.rsmRecords);
    impl.checked(name_ + ": building", [&] {
        const cl::Program program = buildProgram(impl.context, impl.device, name_, source,
                                                 buildOptions(impl.caps, impl.tuning) + options, impl.cacheFolder);
        Built built{cl::Kernel(program, name_.c_str())};
        const auto limit = built.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(impl.device);
        const auto own = built.kernel.getWorkGroupInfo<CL_KERNEL_COMPILE_WORK_GROUP_SIZE>(impl.device);  // 0: any
        if (own[0] > 0) {
            // The device's limit decides: rusticl (Mesa 22.3) runs groups beyond the one it tells for a kernel.
            if (own[0] * own[1] > impl.caps.maxWorkGroupSize)
                throw DeviceError(fmt::format("{}: works in groups of {} items, this device takes {}", name_,
                                              own[0] * own[1], impl.caps.maxWorkGroupSize));
            built.localSize = {own[0], own[1]};
        } else {
            const std::array<int, 2> wanted = localSizeOf(impl.tuning, name_);
            const std::size_t x = std::min<std::size_t>(std::size_t(wanted[0]), limit);
            built.localSize = {x, std::max<std::size_t>(std::min<std::size_t>(std::size_t(wanted[1]), limit / x), 1)};
        }
        built_ = &variants_.emplace(options, std::move(built)).first->second;
        return 0;
    });
}

void Kernel::setRaw(std::string_view argument, std::size_t size, const void* value) {
    build();
    const auto at = std::find(arguments_.begin(), arguments_.end(), argument);
    if (at == arguments_.end()) throw DeviceError(fmt::format("{}: the kernel has no argument '{}'", name_, argument));
    device_.impl().checked(fmt::format("{}: argument '{}' of {} bytes", name_, argument, size), [&] {
        built_->kernel.setArg(cl_uint(at - arguments_.begin()), size, value);
        return 0;
    });
}

void Kernel::setMemory(std::string_view argument, const cl::Memory& memory) {
    const cl_mem handle = memory();
    setRaw(argument, sizeof handle, &handle);
}

Kernel& Kernel::set(std::string_view argument, const Surface& surface) {
    setMemory(argument, surface.memory());
    return setParams(std::string(argument) + "Layout", surface.layout());
}

Kernel& Kernel::set(std::string_view argument, const cl::Buffer& buffer) {
    setMemory(argument, buffer);
    return *this;
}

Kernel& Kernel::set(std::string_view argument, const cl::Image2D& image) {
    setMemory(argument, image);
    return *this;
}

void Kernel::enqueue(Extent extent) {
    const int lanes = device_.tuning().lanes;
    enqueueItems(std::size_t((extent.widthPx + lanes - 1) / lanes), std::size_t(extent.heightPx));
}

void Kernel::enqueueItems(std::size_t x, std::size_t y) {
    if (x == 0 || y == 0) return;
    build();
    Device::Impl& impl = device_.impl();
    impl.checked(fmt::format("{}: launching {} x {} items", name_, x, y), [&] {
        const std::array<std::size_t, 2>& group = built_->localSize;
        const cl::NDRange local(group[0], group[1]);
        const auto roundUp = [](std::size_t n, std::size_t to) { return (n + to - 1) / to * to; };
        const cl::NDRange global(roundUp(x, group[0]), roundUp(y, group[1]));
        impl.record(name_, [&](cl::Event* event) {
            impl.queue.enqueueNDRangeKernel(built_->kernel, cl::NullRange, global, local, nullptr, event);
        });
        return 0;
    });
}

}  // namespace earthshine
