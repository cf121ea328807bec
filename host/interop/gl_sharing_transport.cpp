#include "interop/gl_sharing_transport.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "earthshine/error.hpp"

namespace earthshine {

namespace {

std::vector<std::intptr_t> sharingProperties(const GlContextHandle& gl) {
    return {CL_GL_CONTEXT_KHR, reinterpret_cast<std::intptr_t>(gl.context),
            gl.platform == GlPlatformKind::Glx ? CL_GLX_DISPLAY_KHR : CL_EGL_DISPLAY_KHR,
            reinterpret_cast<std::intptr_t>(gl.display)};
}

template <class Function>
Function extensionFunction(const cl::Device& device, const char* name) {
    const cl_platform_id platform = device.getInfo<CL_DEVICE_PLATFORM>();
    return reinterpret_cast<Function>(::clGetExtensionFunctionAddressForPlatform(platform, name));
}

/// The devices of the platform that can share with the context, that which draws first. Empty: none.
std::vector<cl_device_id> devicesOf(const cl::Device& device, const GlContextHandle& gl) {
    const auto getInfo = extensionFunction<clGetGLContextInfoKHR_fn>(device, "clGetGLContextInfoKHR");
    if (!getInfo) throw DeviceError("the driver has cl_khr_gl_sharing, but no clGetGLContextInfoKHR");
    std::vector<cl_context_properties> properties = sharingProperties(gl);
    const cl_platform_id platform = device.getInfo<CL_DEVICE_PLATFORM>();
    properties.insert(properties.end(), {CL_CONTEXT_PLATFORM, reinterpret_cast<std::intptr_t>(platform), 0});
    std::vector<cl_device_id> all;
    for (const cl_gl_context_info what : {CL_CURRENT_DEVICE_FOR_GL_CONTEXT_KHR, CL_DEVICES_FOR_GL_CONTEXT_KHR}) {
        std::size_t bytes = 0;
        cl_int code = getInfo(properties.data(), what, 0, nullptr, &bytes);
        std::vector<cl_device_id> some(bytes / sizeof(cl_device_id));
        if (code == CL_SUCCESS && !some.empty()) code = getInfo(properties.data(), what, bytes, some.data(), nullptr);
        if (code != CL_SUCCESS) throw cl::Error(code, "clGetGLContextInfoKHR");
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

}  // namespace

Device openWithGlSharing(const Device& plain, const DeviceOptions& options, const GlContextHandle& gl) {
    Device::Impl& impl = plain.impl();
    if (!hasExtension(impl.device, "cl_khr_gl_sharing"))
        throw DeviceError(fmt::format("no cl_khr_gl_sharing on \"{}\"", impl.caps.name));
    if (gl.platform == GlPlatformKind::Other || !gl.context || !gl.display)
        throw DeviceError(
            fmt::format("OpenCL can share with contexts of EGL and GLX, not with this one of \"{}\"", gl.renderer));
    return impl.checked("sharing with OpenGL", [&] {
        const std::vector<cl_device_id> devices = devicesOf(impl.device, gl);
        if (std::find(devices.begin(), devices.end(), impl.device()) == devices.end()) {
            const std::string other =
                devices.empty() ? "no device of its platform"
                                : fmt::format("\"{}\"", cl::Device(devices[0], true).getInfo<CL_DEVICE_NAME>().c_str());
            throw DeviceError(fmt::format("OpenGL draws on \"{}\", for which OpenCL names {}, not \"{}\"", gl.renderer,
                                          other, impl.caps.name));
        }
        DeviceOptions sharing = options;
        sharing.contextProperties = sharingProperties(gl);
        return Device(impl.caps, sharing);
    });
}

GlSharingTransport::GlSharingTransport(const Device& device, const GlContextHandle& gl)
    : SharedTextures("gl-sharing", device, gl) {
    const cl::Device& clDevice = device.impl().device;
    if (!hasExtension(clDevice, "cl_khr_gl_event")) return;
    createEventFromGlSync_ =
        extensionFunction<decltype(createEventFromGlSync_)>(clDevice, "clCreateEventFromGLsyncKHR");
    if (createEventFromGlSync_ && api().hasExtension("GL_ARB_cl_event"))
        createSyncFromClEvent_ =
            reinterpret_cast<decltype(createSyncFromClEvent_)>(gl.getProcAddress("glCreateSyncFromCLeventARB"));
}

GlSharingTransport::~GlSharingTransport() {
    deleteFence();
}

void GlSharingTransport::deleteFence() noexcept {
    if (fence_) api().DeleteSync(fence_);
    fence_ = nullptr;
}

cl::Image2D GlSharingTransport::share(const GlTexture& texture) {
    return device().checked(fmt::format("sharing a texture of {} x {} {}", texture.extent.widthPx,
                                        texture.extent.heightPx, formatName(texture.format)),
                            [&] {
                                cl_int code = CL_SUCCESS;
                                const cl_mem image = ::clCreateFromGLTexture(device().context(), CL_MEM_READ_WRITE,
                                                                             gl::kTexture2d, 0, texture.name, &code);
                                if (code != CL_SUCCESS) throw cl::Error(code, "clCreateFromGLTexture");
                                return cl::Image2D(image);
                            });
}

void GlSharingTransport::acquire(const std::vector<SharedImage>& images, TransportCost& cost) {
    const std::vector<cl::Memory> objects = memories(images);
    device().checked("acquiring textures", [&] {
        std::vector<cl::Event> drawn;
        if (createEventFromGlSync_) {
            cost.acquireMs += timedMs([&] {
                deleteFence();
                fence_ = api().FenceSync(gl::kSyncGpuCommandsComplete, 0);
                api().Flush();
                cl_int code = CL_SUCCESS;
                const cl_event event =
                    createEventFromGlSync_(device().context(), static_cast<cl_GLsync>(fence_), &code);
                if (code != CL_SUCCESS) throw cl::Error(code, "clCreateEventFromGLsyncKHR");
                drawn.emplace_back(event);
            });
        } else {
            cost.waitMs += timedMs([&] { api().Finish(); });
        }
        cost.acquireMs += timedMs(
            [&] { device().queue.enqueueAcquireGLObjects(&objects, drawn.empty() ? nullptr : &drawn, nullptr); });
        return 0;
    });
}

void GlSharingTransport::release(const std::vector<SharedImage>& images, TransportCost& cost) {
    const std::vector<cl::Memory> objects = memories(images);
    device().checked("releasing textures", [&] {
        cost.releaseMs += timedMs([&] {
            cl::Event released;
            device().queue.enqueueReleaseGLObjects(&objects, nullptr, &released);
            if (!createSyncFromClEvent_) {
                released.wait();
                return;
            }
            device().queue.flush();
            void* sync = createSyncFromClEvent_(device().context(), released(), 0);
            if (!sync) {
                // A driver may list the extension and yet take no events of this context: it is not asked again, and
                // its error is not of what comes next.
                createSyncFromClEvent_ = nullptr;
                api().forgetErrors();
                released.wait();
                return;
            }
            api().WaitSync(sync, 0, gl::kTimeoutIgnored);
            api().DeleteSync(sync);
        });
        return 0;
    });
}

}  // namespace earthshine
