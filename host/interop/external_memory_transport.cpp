#include "interop/external_memory_transport.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>
#include <type_traits>
#include <utility>

#include "earthshine/error.hpp"

namespace earthshine {

namespace {

constexpr unsigned kDedicatedMemoryObject = 0x9581, kHandleTypeOpaqueFd = 0x9586, kLayoutGeneral = 0x958D,
                   kDeviceUuid = 0x9597;

/// Throws cl::Error, so that Device::Impl::checked names the call and the device.
void checkCl(cl_int code, const char* call) {
    if (code != CL_SUCCESS) throw cl::Error(code, call);
}

}  // namespace

ExternalMemoryTransport::ExternalMemoryTransport(const Device& device, const GlContextHandle& gl)
    : SharedTextures("external-memory", device, gl) {
    loadCl();
    loadGl(gl.getProcAddress);
    vulkan_ = std::make_unique<VulkanExporter>(deviceUuid());
    try {
        drawn_ = importSemaphore();
        read_ = importSemaphore();
    } catch (...) {
        if (drawn_.cl) cl_.releaseSemaphore(drawn_.cl);
        if (drawn_.gl) ext_.DeleteSemaphoresEXT(1, &drawn_.gl);
        throw;
    }
}

ExternalMemoryTransport::~ExternalMemoryTransport() {
    while (!allocations_.empty()) forget(allocations_.begin()->first);
    freeRetired();
    for (const Semaphore& semaphore : {drawn_, read_}) {
        cl_.releaseSemaphore(semaphore.cl);
        ext_.DeleteSemaphoresEXT(1, &semaphore.gl);
    }
}

void ExternalMemoryTransport::loadCl() {
    const cl::Device& clDevice = device().device;
    for (const char* extension : {"cl_khr_external_memory_opaque_fd", "cl_khr_external_semaphore_opaque_fd"})
        if (!hasExtension(clDevice, extension))
            throw DeviceError(fmt::format("no {} on \"{}\"", extension, device().caps.name));
    const cl_platform_id platform = clDevice.getInfo<CL_DEVICE_PLATFORM>();
    const auto load = [&](auto& function, const char* name, void* address) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(address);
        if (!function) throw DeviceError(fmt::format("OpenCL of \"{}\" has no {}", device().caps.name, name));
    };
    const auto extension = [&](auto& function, const char* name) {
        load(function, name, ::clGetExtensionFunctionAddressForPlatform(platform, name));
    };
    // Of OpenCL 3.0, and so of the loader, which may be older than the device.
    load(cl_.createImageWithProperties, "clCreateImageWithProperties (the loader is older than OpenCL 3.0)",
         ::dlsym(RTLD_DEFAULT, "clCreateImageWithProperties"));
    extension(cl_.acquireMemory, "clEnqueueAcquireExternalMemObjectsKHR");
    extension(cl_.releaseMemory, "clEnqueueReleaseExternalMemObjectsKHR");
    extension(cl_.createSemaphore, "clCreateSemaphoreWithPropertiesKHR");
    // Drafts of the extension, and drivers of their time, have another name for it.
    const char* releaseName = "clReleaseSemaphoreKHR";
    if (!::clGetExtensionFunctionAddressForPlatform(platform, releaseName)) releaseName = "clReleaseSemaphoreObjectKHR";
    extension(cl_.releaseSemaphore, releaseName);
    extension(cl_.wait, "clEnqueueWaitSemaphoresKHR");
    extension(cl_.signal, "clEnqueueSignalSemaphoresKHR");
}

void ExternalMemoryTransport::loadGl(const GlGetProcAddress& find) {
    // By name first: eglGetProcAddress gives an address for any function that it has heard of.
    for (const char* extension :
         {"GL_EXT_memory_object", "GL_EXT_memory_object_fd", "GL_EXT_semaphore", "GL_EXT_semaphore_fd"})
        if (!api().hasExtension(extension)) throw DeviceError(fmt::format("this OpenGL has no {}", extension));
    const auto load = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(find(name));
        if (!function) throw DeviceError(fmt::format("this OpenGL has no {}", name));
    };
#define EARTHSHINE_GL_LOAD(NAME, RESULT, ARGUMENTS) load(ext_.NAME, "gl" #NAME);
    EARTHSHINE_GL_EXTERNAL(EARTHSHINE_GL_LOAD)
#undef EARTHSHINE_GL_LOAD
}

/// OpenGL's, which must be OpenCL's too if that has one.
DeviceUuid ExternalMemoryTransport::deviceUuid() const {
    api().forgetErrors();
    DeviceUuid ofGl{};
    ext_.GetUnsignedBytei_vEXT(kDeviceUuid, 0, ofGl.data());
    api().check("glGetUnsignedBytei_vEXT(GL_DEVICE_UUID_EXT)");
    DeviceUuid ofCl{};
    if (hasExtension(device().device, "cl_khr_device_uuid") &&
        ::clGetDeviceInfo(device().device(), CL_DEVICE_UUID_KHR, ofCl.size(), ofCl.data(), nullptr) == CL_SUCCESS &&
        ofCl != ofGl)
        throw DeviceError(fmt::format("OpenGL draws on another device than \"{}\": {:02x}, not {:02x}",
                                      device().caps.name, fmt::join(ofGl, ""), fmt::join(ofCl, "")));
    return ofGl;
}

ExternalMemoryTransport::Semaphore ExternalMemoryTransport::importSemaphore() {
    VulkanExporter::Semaphore exported = vulkan_->makeSemaphore();
    Semaphore semaphore;
    api().forgetErrors();
    ext_.GenSemaphoresEXT(1, &semaphore.gl);
    try {
        ext_.ImportSemaphoreFdEXT(semaphore.gl, kHandleTypeOpaqueFd, exported.forGl.get());
        api().check("glImportSemaphoreFdEXT");
        exported.forGl.disown();
        device().checked("importing a semaphore", [&] {
            // No list of devices: the context has one, and versions of the extension spell it differently.
            const cl_semaphore_properties_khr properties[] = {CL_SEMAPHORE_TYPE_KHR, CL_SEMAPHORE_TYPE_BINARY_KHR,
                                                              CL_SEMAPHORE_HANDLE_OPAQUE_FD_KHR,
                                                              cl_semaphore_properties_khr(exported.forCl.get()), 0};
            cl_int code = CL_SUCCESS;
            semaphore.cl = cl_.createSemaphore(device().context(), properties, &code);
            checkCl(code, "clCreateSemaphoreWithPropertiesKHR");
            exported.forCl.disown();
            return 0;
        });
    } catch (...) {
        ext_.DeleteSemaphoresEXT(1, &semaphore.gl);
        throw;
    }
    return semaphore;
}

bool ExternalMemoryTransport::allocate(const GlTexture& texture) {
    freeRetired();
    Allocation allocation{vulkan_->makeImage(texture.format, texture.extent), 0};
    api().forgetErrors();
    try {
        ext_.CreateMemoryObjectsEXT(1, &allocation.glMemory);
        const int isDedicated = 1;
        ext_.MemoryObjectParameterivEXT(allocation.glMemory, kDedicatedMemoryObject, &isDedicated);
        ext_.ImportMemoryFdEXT(allocation.glMemory, allocation.image.sizeBytes, kHandleTypeOpaqueFd,
                               allocation.image.forGl.get());
        api().check("glImportMemoryFdEXT");
        allocation.image.forGl.disown();
        ext_.TexStorageMem2DEXT(gl::kTexture2d, 1, glPixels(texture.format).internalFormat, texture.extent.widthPx,
                                texture.extent.heightPx, allocation.glMemory, 0);
        api().check(fmt::format("glTexStorageMem2DEXT of {} x {} {}", texture.extent.widthPx, texture.extent.heightPx,
                                formatName(texture.format)));
    } catch (...) {
        retired_.push_back(std::move(allocation));
        freeRetired();
        throw;
    }
    forget(texture.name);
    allocations_[texture.name] = std::move(allocation);
    return true;
}

cl::Image2D ExternalMemoryTransport::share(const GlTexture& texture) {
    const auto found = allocations_.find(texture.name);
    if (found == allocations_.end())
        throw DeviceError(
            fmt::format("texture {} is in memory of OpenGL's own: who made it did not ask "
                        "Transport::allocate()",
                        texture.name));
    Fd& fd = found->second.image.forCl;
    const std::string what = fmt::format("importing a texture of {} x {} {}", texture.extent.widthPx,
                                         texture.extent.heightPx, formatName(texture.format));
    return device().checked(what, [&] {
        const cl_mem image = importImage(texture, fd.get());
        fd.disown();
        return cl::Image2D(image);
    });
}

cl_mem ExternalMemoryTransport::importImage(const GlTexture& texture, int fd) const {
    const auto handle = reinterpret_cast<std::uintptr_t>(device().device());
    const cl_ulong properties[] = {CL_EXTERNAL_MEMORY_HANDLE_OPAQUE_FD_KHR,
                                   cl_ulong(fd),
                                   CL_DEVICE_HANDLE_LIST_KHR,
                                   handle,
                                   CL_DEVICE_HANDLE_LIST_END_KHR,
                                   0};
    const cl::ImageFormat format = clImageFormat(texture.format);
    cl_image_desc desc{};
    desc.image_type = CL_MEM_OBJECT_IMAGE2D;
    desc.image_width = std::size_t(texture.extent.widthPx);
    desc.image_height = std::size_t(texture.extent.heightPx);
    const auto create = [&](cl_int& code) {
        return cl_.createImageWithProperties(device().context(), properties, CL_MEM_READ_WRITE, &format, &desc, nullptr,
                                             &code);
    };
    cl_int code = CL_SUCCESS;
    cl_mem image = create(code);
    if (code == CL_SUCCESS) return image;
    // The standard's word for "no mipmaps" is 0, the conformance test's for external images 1: a driver may take that
    // alone.
    desc.num_mip_levels = 1;
    cl_int secondCode = CL_SUCCESS;
    image = create(secondCode);
    if (secondCode != CL_SUCCESS) checkCl(code, "clCreateImageWithProperties");
    return image;
}

void ExternalMemoryTransport::forget(unsigned name) noexcept {
    SharedTextures::forget(name);
    const auto found = allocations_.find(name);
    if (found == allocations_.end()) return;
    retired_.push_back(std::move(found->second));
    allocations_.erase(found);
}

void ExternalMemoryTransport::freeRetired() noexcept {
    for (const Allocation& allocation : retired_) {
        if (allocation.glMemory) ext_.DeleteMemoryObjectsEXT(1, &allocation.glMemory);
        vulkan_->free(allocation.image.id);
    }
    retired_.clear();
}

ExternalMemoryTransport::Barrier ExternalMemoryTransport::barrierOf(const std::vector<SharedImage>& images) {
    Barrier barrier;
    for (const SharedImage& shared : images) barrier.textures.push_back(shared.texture);
    barrier.layouts.assign(images.size(), kLayoutGeneral);
    return barrier;
}

void ExternalMemoryTransport::acquire(const std::vector<SharedImage>& images, TransportCost& cost) {
    cost.acquireMs += timedMs([&] {
        const Barrier barrier = barrierOf(images);
        api().forgetErrors();
        ext_.SignalSemaphoreEXT(drawn_.gl, 0, nullptr, unsigned(images.size()), barrier.textures.data(),
                                barrier.layouts.data());
        api().Flush();  // OpenCL must not wait for what is never submitted
        api().check("glSignalSemaphoreEXT");
        const std::vector<cl::Memory> objects = memories(images);
        std::vector<cl_mem> handles;
        for (const cl::Memory& object : objects) handles.push_back(object());
        device().checked("acquiring textures", [&] {
            const cl_command_queue queue = device().queue();
            checkCl(cl_.wait(queue, 1, &drawn_.cl, nullptr, 0, nullptr, nullptr), "clEnqueueWaitSemaphoresKHR");
            checkCl(cl_.acquireMemory(queue, cl_uint(handles.size()), handles.data(), 0, nullptr, nullptr),
                    "clEnqueueAcquireExternalMemObjectsKHR");
            return 0;
        });
    });
}

void ExternalMemoryTransport::release(const std::vector<SharedImage>& images, TransportCost& cost) {
    cost.releaseMs += timedMs([&] {
        std::vector<cl_mem> handles;
        for (const SharedImage& shared : images) handles.push_back(shared.image());
        device().checked("releasing textures", [&] {
            const cl_command_queue queue = device().queue();
            checkCl(cl_.releaseMemory(queue, cl_uint(handles.size()), handles.data(), 0, nullptr, nullptr),
                    "clEnqueueReleaseExternalMemObjectsKHR");
            checkCl(cl_.signal(queue, 1, &read_.cl, nullptr, 0, nullptr, nullptr), "clEnqueueSignalSemaphoresKHR");
            device().queue.flush();  // GL must not wait for what is never submitted
            return 0;
        });
        const Barrier barrier = barrierOf(images);
        api().forgetErrors();
        ext_.WaitSemaphoreEXT(read_.gl, 0, nullptr, unsigned(images.size()), barrier.textures.data(),
                              barrier.layouts.data());
        api().check("glWaitSemaphoreEXT");
    });
}

}  // namespace earthshine
