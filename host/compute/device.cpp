#include "earthshine/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "compute/device_impl.hpp"
#include "compute/program_cache.hpp"
#include "compute/quirks.hpp"
#include "compute/surface.hpp"
#include "compute/tuning.hpp"
#include "earthshine/error.hpp"
#include "earthshine/log.hpp"

namespace earthshine {

namespace {

struct Found {
    cl::Device device;
    DeviceCaps caps;
};

std::string trimmed(std::string text) {
    while (!text.empty() && (std::isspace(static_cast<unsigned char>(text.back())) || text.back() == '\0'))
        text.pop_back();
    const auto begin = text.find_first_not_of(" \t");
    return begin == std::string::npos ? std::string() : text.substr(begin);
}

const char* typeName(cl_device_type type) {
    if (type & CL_DEVICE_TYPE_GPU) return "GPU";
    if (type & CL_DEVICE_TYPE_CPU) return "CPU";
    if (type & CL_DEVICE_TYPE_ACCELERATOR) return "accelerator";
    return "other";
}

std::vector<std::string> usableImageFormats(const cl::Context& context) {
    std::vector<cl::ImageFormat> supported;
    context.getSupportedImageFormats(CL_MEM_READ_WRITE, CL_MEM_OBJECT_IMAGE2D, &supported);
    std::vector<std::string> names;
    for (PixelFormat format : {PixelFormat::R32F, PixelFormat::RGBA16F, PixelFormat::RGBA32F, PixelFormat::RGBA8}) {
        const cl::ImageFormat wanted = clImageFormat(format);
        const bool isSupported = std::any_of(supported.begin(), supported.end(), [&](const cl::ImageFormat& f) {
            return f.image_channel_order == wanted.image_channel_order &&
                   f.image_channel_data_type == wanted.image_channel_data_type;
        });
        if (isSupported) names.emplace_back(formatName(format));
    }
    return names;
}

void query(const cl::Platform& platform, Found& found) {
    DeviceCaps& caps = found.caps;
    const cl::Device& device = found.device;
    caps.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    caps.platformName = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
    caps.platformVersion = trimmed(platform.getInfo<CL_PLATFORM_VERSION>());
    caps.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
    caps.deviceVersion = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    caps.driverVersion = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    caps.openclCVersion = trimmed(device.getInfo<CL_DEVICE_OPENCL_C_VERSION>());
    caps.type = typeName(device.getInfo<CL_DEVICE_TYPE>());
    caps.available = device.getInfo<CL_DEVICE_AVAILABLE>() != CL_FALSE;
    caps.images = device.getInfo<CL_DEVICE_IMAGE_SUPPORT>() != CL_FALSE;
    caps.nativeFloatWidth = int(device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>());
    caps.computeUnits = int(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    caps.localMemoryBytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    caps.globalMemoryBytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    caps.maxAllocationBytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    caps.maxWorkGroupSize = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    caps.unifiedMemory = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() != CL_FALSE;
    caps.fusesMultiplyAdd = (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_FMA) != 0 && !emulatesFma(caps);
    if (caps.images) {
        caps.maxImageSizePx[0] = device.getInfo<CL_DEVICE_IMAGE2D_MAX_WIDTH>();
        caps.maxImageSizePx[1] = device.getInfo<CL_DEVICE_IMAGE2D_MAX_HEIGHT>();
    }
    const auto has = [&](const char* name) { return hasExtension(device, name); };
    caps.transports = {"host"};
    if (has("cl_khr_gl_sharing")) caps.transports.emplace_back("gl-sharing");
    if (has("cl_khr_external_memory_opaque_fd") && has("cl_khr_external_semaphore_opaque_fd"))
        caps.transports.emplace_back("external-memory");

    if (!caps.available) caps.unusable = "the driver says that it is not available";
    if (caps.unusable.empty() && device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() == CL_FALSE)
        caps.unusable = "the driver has no compiler";
    if (caps.unusable.empty()) caps.unusable = knownUnusable(caps);
    if (caps.unusable.empty()) {
        const cl::Context context(device);
        if (caps.images) caps.imageFormats = usableImageFormats(context);
    }
    caps.tuning = defaultTuning(caps);
}

std::vector<Found> findDevices() {
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        return {};  // the loader says so when there is no platform at all
    }
    std::vector<Found> found;
    for (const cl::Platform& platform : platforms) {
        std::vector<cl::Device> devices;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error&) {
            continue;  // CL_DEVICE_NOT_FOUND: a platform without devices
        }
        for (const cl::Device& device : devices) {
            Found one{device, {}};
            try {
                query(platform, one);
            } catch (const cl::Error& error) {
                one.caps.unusable = fmt::format("{}: {}", error.what(), clErrorName(error.err()));
            }
            one.caps.index = int(found.size());
            found.push_back(std::move(one));
        }
    }
    return found;
}

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

const DeviceCaps& byName(const std::vector<DeviceCaps>& all, const std::string& spec) {
    std::vector<const DeviceCaps*> fits;
    const std::string wanted = lowered(spec);
    for (const DeviceCaps& caps : all)
        if (lowered(caps.name).find(wanted) != std::string::npos ||
            lowered(caps.platformName).find(wanted) != std::string::npos)
            fits.push_back(&caps);
    if (fits.empty()) {
        std::string names;
        for (const DeviceCaps& caps : all)
            names += fmt::format("{}\"{}\" ({})", names.empty() ? "" : ", ", caps.name, caps.platformName);
        throw UsageError(fmt::format("device: nothing here has the number or name '{}'; there is {}", spec, names));
    }
    if (fits.size() > 1)
        throw UsageError(fmt::format("device: '{}' fits \"{}\" and \"{}\"; say more, or use a number", spec,
                                     fits[0]->name, fits[1]->name));
    return *fits[0];
}

}  // namespace

std::vector<DeviceCaps> listDevices() {
    std::vector<DeviceCaps> all;
    for (Found& found : findDevices()) all.push_back(std::move(found.caps));
    return all;
}

DeviceCaps selectDevice(const std::string& spec, std::string* why) {
    const std::vector<DeviceCaps> all = listDevices();
    if (all.empty())
        throw DeviceError("device: no OpenCL device here; install a driver (pocl-opencl-icd runs on any CPU)");
    std::string wanted = spec, reason = "asked for";
    if (wanted.empty())
        if (const char* fromEnvironment = std::getenv("EARTHSHINE_DEVICE"); fromEnvironment && *fromEnvironment) {
            wanted = fromEnvironment;
            reason = "asked for by EARTHSHINE_DEVICE";
        }
    const DeviceCaps* chosen = nullptr;
    if (!wanted.empty()) {
        const bool isNumber =
            std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c); });
        const bool isIndex = isNumber && wanted.size() < 6 && std::stoul(wanted) < all.size();  // "4090" may be a name
        chosen = isIndex ? &all[std::stoul(wanted)] : &byName(all, wanted);
        if (!chosen->unusable.empty())
            throw DeviceError(fmt::format("device: \"{}\" cannot be used: {}", chosen->name, chosen->unusable));
    } else {
        for (const char* type : {"GPU", "CPU", ""}) {
            for (const DeviceCaps& caps : all)
                if (!chosen && caps.unusable.empty() && (!*type || caps.type == type)) chosen = &caps;
        }
        if (!chosen)
            throw DeviceError(fmt::format("device: none can be used; \"{}\": {}", all[0].name, all[0].unusable));
        reason = chosen->type == "GPU"   ? "the first GPU"
                 : chosen->type == "CPU" ? "the first CPU; there is no usable GPU"
                                         : "the first that works; there is no usable GPU or CPU";
    }
    if (why) *why = reason;
    return *chosen;
}

Device::Device(const DeviceCaps& caps, const DeviceOptions& options) : impl_(std::make_shared<Impl>()) {
    impl_->caps = caps;
    impl_->options = options;
    if (impl_->options.kernelFolder.empty())
        if (const char* folder = std::getenv("EARTHSHINE_KERNELS")) impl_->options.kernelFolder = folder;
    impl_->tuning = tuningFor(caps, options);
    impl_->cacheFolder = cacheFolderFor(options.cacheFolder);
    const std::vector<Found> all = findDevices();
    if (std::size_t(caps.index) >= all.size() || all[std::size_t(caps.index)].caps.name != caps.name)
        throw DeviceError(fmt::format("device: \"{}\" is no longer number {}", caps.name, caps.index));
    impl_->checked("opening the device", [&] {
        impl_->device = all[std::size_t(caps.index)].device;
        std::vector<cl_context_properties> properties(options.contextProperties.begin(),
                                                      options.contextProperties.end());
        if (!properties.empty()) {
            const cl_platform_id platform = impl_->device.getInfo<CL_DEVICE_PLATFORM>();
            properties.insert(properties.end(), {CL_CONTEXT_PLATFORM, reinterpret_cast<std::intptr_t>(platform), 0});
        }
        impl_->context = cl::Context(impl_->device, properties.empty() ? nullptr : properties.data());
        impl_->queue = cl::CommandQueue(impl_->context, impl_->device,
                                        options.profiling ? cl::QueueProperties::Profiling : cl::QueueProperties::None);
        impl_->timesByClock = options.profiling && tellsNoTimes(impl_->context, impl_->queue);
        return 0;
    });
    log(LogLevel::Debug,
        fmt::format("device: \"{}\": {} lanes, {} storage, {} x {} work-items a group", caps.name, impl_->tuning.lanes,
                    storageName(impl_->tuning.storage), impl_->tuning.localSizePx[0], impl_->tuning.localSizePx[1]));
}

const DeviceCaps& Device::caps() const noexcept {
    return impl_->caps;
}
const Tuning& Device::tuning() const noexcept {
    return impl_->tuning;
}

std::size_t Device::allocatedBytes() const noexcept {
    return impl_->allocatedBytes;
}

cl::Buffer Device::Impl::makeBuffer(std::size_t bytes, cl_mem_flags flags) {
    allocatedBytes += bytes;
    return checked(fmt::format("a buffer of {} bytes", bytes),
                   [&] { return cl::Buffer(context, flags, std::max<std::size_t>(bytes, 16)); });
}

}  // namespace earthshine
