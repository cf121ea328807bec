#pragma once
// How pixels get from OpenGL to OpenCL: three transports behind one interface.

#include <cstddef>
#include <memory>
#include <string>

#include "earthshine/device.hpp"
#include "earthshine/gl.hpp"

namespace earthshine {

struct FrameImages;

enum class TransportKind {
    Host,           ///< textures are read back into host memory, which OpenCL uses in place where it can: runs anywhere
    GlSharing,      ///< cl_khr_gl_sharing: OpenCL reads GL's own textures
    ExternalMemory  ///< both read memory that Vulkan allocated and exported; semaphores order them
};
inline constexpr const char* kTransportNames[] = {"host", "gl-sharing", "external-memory"};

/// What it cost to bring one frame from OpenGL to OpenCL: wall-clock time of the calling thread.
struct TransportCost {
    double waitMs = 0;     ///< until OpenGL had drawn; 0 where a semaphore or a fence makes the device wait instead
    double acquireMs = 0;  ///< host: reading the textures back; else handing them to OpenCL
    double releaseMs = 0;  ///< handing them back, with the wait until OpenCL had read them, where there is one
    std::size_t hostBytes = 0;  ///< copied through the host's memory
};

/// A way from one GL context to one OpenCL device. Use it where the context is current; destroy it before the context.
/// It is also the storage of the textures that the frames are drawn into: a renderer asks allocate() before it makes
/// one, and says forget() before it deletes one.
class Transport final : public GlTextureStorage {
public:
    struct Impl;
    explicit Transport(std::unique_ptr<Impl> impl);
    ~Transport() override;
    Transport(Transport&&) noexcept;
    Transport& operator=(Transport&&) noexcept;

    TransportKind kind() const noexcept;
    const char* name() const noexcept { return kTransportNames[int(kind())]; }
    const std::string& reason() const noexcept;  ///< one line: why this one and none of the others
    const TransportCost& cost() const noexcept;  ///< of the last frame
    /// The last frame in host memory, if it came that way; else null.
    const FrameImages* hostImages() const noexcept;

    bool allocate(const GlTexture& texture) override;
    void forget(unsigned name) noexcept override;

    Impl& impl() const noexcept { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

/// A device that a GL context can reach, and the way to it.
struct GlDevice {
    Device device;
    Transport transport;
};

/// Opens a device for the frames of a GL context, which must be current. `transport`: a name of kTransportNames, or
/// "auto" for the first of external-memory, gl-sharing and host that is there and passes a round trip: a pattern that
/// GL writes and OpenCL reads, and one the other way, in each format of a frame. Logs the choice and its reason in one
/// line. With "auto", a transport that fails later, on some frame, is given up for host with one warning.
/// Throws DeviceError with one line if the transport that was asked for cannot be had, UsageError for another word; and
/// as Device's constructor.
GlDevice openForGl(const DeviceCaps& caps, const DeviceOptions& options, const GlContextHandle& gl,
                   const std::string& transport = "auto");

}  // namespace earthshine
