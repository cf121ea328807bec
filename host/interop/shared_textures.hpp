#pragma once
// What the transports that share textures have in common: which image stands for which texture, and how a frame of them
// becomes surfaces.

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "earthshine/frame.hpp"
#include "earthshine/transport.hpp"
#include "interop/frame_surfaces.hpp"
#include "interop/gl_api.hpp"
#include "stages/import_image_stage.hpp"

namespace earthshine {

/// One texture, seen from both sides.
struct SharedImage {
    unsigned texture = 0;
    cl::Image2D image;
};

/// Textures of the current GL context as images of a device. Thread-compatible; the context must be current.
class SharedTextures : public GlTextureStorage {
public:
    /// `name`: of the transport, the first word of every message.
    SharedTextures(const char* name, const Device& device, const GlContextHandle& gl);

    const GlApi& api() const { return api_; }

    /// What one exchange holds: between these two OpenCL may touch the images, and GL may not touch the textures.
    /// Every image comes from image(). Costs are added up.
    virtual void acquire(const std::vector<SharedImage>& images, TransportCost& cost) = 0;
    virtual void release(const std::vector<SharedImage>& images, TransportCost& cost) = 0;

    /// The image that stands for a texture; made when first asked for, and kept until forget().
    SharedImage image(const GlTexture& texture);

    /// Enqueues everything that brings the textures of `frame` into `surfaces`, and hands the textures back.
    void enqueue(const GlFrame& frame, const std::vector<Light>& lights, FrameSurfaces& surfaces, TransportCost& cost);

    void forget(unsigned name) noexcept override;

protected:
    virtual cl::Image2D share(const GlTexture& texture) = 0;
    Device::Impl& device() const { return device_.impl(); }
    /// The images alone, as OpenCL takes them.
    static std::vector<cl::Memory> memories(const std::vector<SharedImage>& images);

private:
    struct Known {
        GlTexture texture;
        cl::Image2D image;
    };
    Device device_;
    GlApi api_;
    std::map<unsigned, Known> shared_;
    std::optional<ImportImageStage> import_;  ///< built by the first frame: a probe needs none
};

/// Milliseconds that `body` takes.
double timedMs(const std::function<void()>& body);

}  // namespace earthshine
