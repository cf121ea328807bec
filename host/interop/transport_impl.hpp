#pragma once
// A transport as the pipeline sees it.

#include "earthshine/error.hpp"
#include "earthshine/pipeline.hpp"
#include "earthshine/transport.hpp"
#include "interop/shared_textures.hpp"

namespace earthshine {

/// Throws InputError or UsageError naming what of a frame is not as frame.hpp and gl.hpp say.
void checkFrame(const GlFrame& frame, const Camera& camera, const std::vector<Light>& lights);

struct Transport::Impl {
    Device device;
    GlContextHandle gl;
    TransportKind kind = TransportKind::Host;
    std::string reason;
    bool fallsBack = true;                   ///< to host, when `shared` fails
    std::unique_ptr<SharedTextures> shared;  ///< null: host. Kept after a failure: textures may live in its memory
    FrameImages images;
    TransportCost cost;

    /// Brings a frame over. True: into `surfaces`. False: `inputs` now holds its images, which live here until the next
    /// frame. `inputs` has the frame's camera and lights. Throws DeviceError.
    bool enqueue(const GlFrame& frame, FrameInputs& inputs, FrameSurfaces& surfaces);

    /// Host from now on, with a warning that says why.
    void fallBack(const DeviceError& error);

private:
    void readBackInto(const GlFrame& frame, FrameInputs& inputs);
};

}  // namespace earthshine
