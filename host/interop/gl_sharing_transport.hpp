#pragma once
// Transport `gl-sharing`: cl_khr_gl_sharing, OpenCL reads OpenGL's own textures.

#include <cstdint>
#include <vector>

#include "interop/shared_textures.hpp"

namespace earthshine {

/// Opens the device of `plain` once more, in a context that shares with `gl`. Throws DeviceError that says why that
/// cannot be: no such extension, a GL context of a kind that OpenCL does not know, or one that draws on another device.
Device openWithGlSharing(const Device& plain, const DeviceOptions& options, const GlContextHandle& gl);

/// GL waits for OpenCL, and OpenCL for GL: with cl_khr_gl_event by a fence, without it by glFinish; back by
/// GL_ARB_cl_event where it is, else by waiting for the release. Every depth of a frame is a colour (R32F), so that
/// cl_khr_gl_depth_images is not needed.
class GlSharingTransport final : public SharedTextures {
public:
    /// `device` is of openWithGlSharing(). Throws DeviceError.
    GlSharingTransport(const Device& device, const GlContextHandle& gl);
    ~GlSharingTransport() override;

    bool allocate(const GlTexture&) override { return false; }
    void acquire(const std::vector<SharedImage>& images, TransportCost& cost) override;
    void release(const std::vector<SharedImage>& images, TransportCost& cost) override;

private:
    cl::Image2D share(const GlTexture& texture) override;
    void deleteFence() noexcept;

    cl_event (*createEventFromGlSync_)(cl_context, cl_GLsync, cl_int*) = nullptr;     ///< null: glFinish
    void* (*createSyncFromClEvent_)(cl_context, cl_event, unsigned flags) = nullptr;  ///< null: wait for the release
    void* fence_ = nullptr;  ///< that the last acquire waits for
};

}  // namespace earthshine
