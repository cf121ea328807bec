#pragma once
// Transport `external-memory`: OpenGL and OpenCL import the same images, which Vulkan allocated; semaphores order them.

#include <map>
#include <vector>

#include "interop/shared_textures.hpp"
#include "interop/vulkan_exporter.hpp"

namespace earthshine {

/// Functions of GL_EXT_memory_object(_fd) and GL_EXT_semaphore(_fd). X(name without "gl", result, arguments)
#define EARTHSHINE_GL_EXTERNAL(X)                                                                                  \
    X(CreateMemoryObjectsEXT, void, (int, unsigned*))                                                              \
    X(DeleteMemoryObjectsEXT, void, (int, const unsigned*))                                                        \
    X(MemoryObjectParameterivEXT, void, (unsigned, unsigned, const int*))                                          \
    X(ImportMemoryFdEXT, void, (unsigned, std::uint64_t, unsigned, int))                                           \
    X(TexStorageMem2DEXT, void, (unsigned, int, unsigned, int, int, unsigned, std::uint64_t))                      \
    X(GenSemaphoresEXT, void, (int, unsigned*))                                                                    \
    X(DeleteSemaphoresEXT, void, (int, const unsigned*))                                                           \
    X(ImportSemaphoreFdEXT, void, (unsigned, unsigned, int))                                                       \
    X(SignalSemaphoreEXT, void, (unsigned, unsigned, const unsigned*, unsigned, const unsigned*, const unsigned*)) \
    X(WaitSemaphoreEXT, void, (unsigned, unsigned, const unsigned*, unsigned, const unsigned*, const unsigned*))   \
    X(GetUnsignedBytei_vEXT, void, (unsigned, unsigned, unsigned char*))

/// A frame goes: GL draws, signals `drawn`; OpenCL waits for it, reads, signals `read`; GL waits for that before it
/// draws again. Both waits are the device's: no glFinish, no clFinish. Every depth of a frame is a colour (R32F).
class ExternalMemoryTransport final : public SharedTextures {
public:
    /// Throws DeviceError with the first thing that is missing: an extension of OpenCL or OpenGL, Vulkan, or a device
    /// that is the same for all three.
    ExternalMemoryTransport(const Device& device, const GlContextHandle& gl);
    ~ExternalMemoryTransport() override;

    bool allocate(const GlTexture& texture) override;
    void forget(unsigned name) noexcept override;
    void acquire(const std::vector<SharedImage>& images, TransportCost& cost) override;
    void release(const std::vector<SharedImage>& images, TransportCost& cost) override;

private:
    // What of OpenCL 3.0 and of extensions is called.
    struct ClFunctions {
        cl_mem (*createImageWithProperties)(cl_context, const cl_ulong* properties, cl_mem_flags,
                                            const cl_image_format*, const cl_image_desc*, void*, cl_int*) = nullptr;
        clEnqueueAcquireExternalMemObjectsKHR_fn acquireMemory = nullptr;
        clEnqueueReleaseExternalMemObjectsKHR_fn releaseMemory = nullptr;
        clCreateSemaphoreWithPropertiesKHR_fn createSemaphore = nullptr;
        clReleaseSemaphoreKHR_fn releaseSemaphore = nullptr;
        clEnqueueWaitSemaphoresKHR_fn wait = nullptr;
        clEnqueueSignalSemaphoresKHR_fn signal = nullptr;
    };
    struct GlExternal {
#define EARTHSHINE_GL_MEMBER(NAME, RESULT, ARGUMENTS) RESULT(*NAME) ARGUMENTS = nullptr;
        EARTHSHINE_GL_EXTERNAL(EARTHSHINE_GL_MEMBER)
#undef EARTHSHINE_GL_MEMBER
    };
    struct Allocation {
        VulkanExporter::Image image;
        unsigned glMemory = 0;
    };
    struct Semaphore {
        unsigned gl = 0;
        cl_semaphore_khr cl = nullptr;
    };
    struct Barrier {
        std::vector<unsigned> textures, layouts;
    };

    void loadCl();
    void loadGl(const GlGetProcAddress& find);
    DeviceUuid deviceUuid() const;
    Semaphore importSemaphore();
    cl::Image2D share(const GlTexture& texture) override;
    cl_mem importImage(const GlTexture& texture, int fd) const;
    void freeRetired() noexcept;
    static Barrier barrierOf(const std::vector<SharedImage>& images);

    ClFunctions cl_;
    GlExternal ext_;
    std::unique_ptr<VulkanExporter> vulkan_;
    std::map<unsigned, Allocation> allocations_;
    std::vector<Allocation> retired_;  ///< of textures that are about to be deleted: GL's memory objects outlive them
    Semaphore drawn_, read_;
};

}  // namespace earthshine
