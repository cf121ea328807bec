#pragma once
// The whole OpenCL half of a frame: plain images in, light out.

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "earthshine/device.hpp"
#include "earthshine/frame.hpp"
#include "earthshine/gl.hpp"
#include "earthshine/settings.hpp"
#include "earthshine/transport.hpp"

namespace earthshine {

/// What a frame leaves behind. All but Display are RGBA32F with w = 1, or w = 0 on sky.
enum class Output {
    DirectIrradiance,    ///< lux
    IndirectIrradiance,  ///< lux
    Direct,              ///< cd/m^2: albedo / pi x direct irradiance + emission
    Indirect,            ///< cd/m^2: albedo / pi x indirect irradiance
    Color,               ///< cd/m^2: Direct + Indirect
    Display,             ///< RGBA8, sRGB-encoded, alpha 255: Color through exposure and tone curve
};
inline constexpr const char* kOutputNames[] = {
    "direct-irradiance", "indirect-irradiance", "direct", "indirect", "color", "display"};

struct StageTime {
    std::string stage;  ///< the kernel's name
    double ms = 0;      ///< on the device, by profiling events; 0 unless DeviceOptions::profiling
};

/// Runs frames on one device. Each kernel is built by the first run that needs it (slow, cached; the log hears of it);
/// surfaces are allocated by the first frame and whenever an extent changes. Thread-compatible; pipelines on one Device
/// share its queue, and so its thread.
class Pipeline {
public:
    explicit Pipeline(const Device& device);
    ~Pipeline();
    Pipeline(Pipeline&&) noexcept;
    Pipeline& operator=(Pipeline&&) noexcept;

    /// Hands over a frame. Every run() reads its images, until the next setFrame(); those whose memory is aligned to
    /// 4096 bytes (as HostImage's is) are used in place where the device shares the host's memory. Throws InputError
    /// naming the image, camera or light that is not as frame.hpp says.
    void setFrame(const FrameInputs& frame);

    /// Hands over a frame that is in the textures of the GL context that `transport` was opened for. Every run() brings
    /// them over, and needs that context current; the transport, whose device this pipeline's is, and the textures stay
    /// until the next setFrame(). Throws InputError or UsageError as the other.
    void setFrame(Transport& transport, const GlFrame& frame, const Camera& camera, const std::vector<Light>& lights);

    /// Computes the outputs of the frame that was set, and waits. `progress`, if given, hears fractions in [0; 1].
    /// Throws UsageError for settings out of range, DeviceError if the device fails. Each run that ends well is the
    /// next frame of the noise (Settings::animatesNoise): a pipeline's n-th run gives the same on every machine, to
    /// rounding.
    void run(const Settings& settings, const std::function<void(double)>& progress = {});

    /// The next run() begins anew, as a new pipeline's first, with the first frame's noise: after a cut, when nothing
    /// of the previous frame is of use. Without it, a run that accumulates takes the frame before as what its motion
    /// vectors point to.
    void forgetHistory();

    /// Copies an output of the last run to the host.
    HostImage read(Output output);

    /// The display transform of Color applied to any RGBA32F picture of the frame's extent, with the exposure of the
    /// last run, so that pictures side by side compare: RGBA8, sRGB.
    HostImage toDisplay(const ImageView& radiance);

    /// How many pixels of the last run interpolation left to be gathered in full; 0 unless Upsampling::Interpolate.
    int gatheredPixels() const;

    /// The factor from cd/m^2 to display-linear that the last run used.
    float exposure() const;

    /// The stages of the last run in order; a stage that ran more than once is summed.
    std::vector<StageTime> stageTimes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The images of a frame, owned: what the `host` transport reads back from GL, what a folder of inputs holds.
struct FrameImages {
    Camera camera;
    HostImage albedo, normalWs, depth, motion, emission;
    std::vector<Light> lights;
    HostImage rsmDepth, rsmNormalWs, rsmFlux, shadowDepth;  ///< one light's map below another's

    /// Views of it all, for Pipeline::setFrame; valid while this lives and is not moved.
    FrameInputs inputs() const;
};

/// Transport `host`: reads every texture of `frame` back into memory that OpenCL uses in place. The GL context that
/// owns the textures must be current; its state is left as it was. Throws DeviceError on a GL error, or if a texture is
/// not of the extent that `frame` says.
FrameImages readBack(const GlFrame& frame, const Camera& camera, const std::vector<Light>& lights,
                     const GlGetProcAddress& getProcAddress);

}  // namespace earthshine
