#pragma once
// Transport `host`, the OpenCL half: plain images into surfaces, in place where the device shares the host's memory.

#include <vector>

#include "earthshine/frame.hpp"
#include "interop/frame_surfaces.hpp"
#include "stages/unpack_stage.hpp"

namespace earthshine {

/// Throws InputError naming the first image of `frame` whose format or extent is not that of frame.hpp.
void checkInputs(const FrameInputs& frame);

class HostTransport {
public:
    explicit HostTransport(const Device& device);

    /// Enqueues everything that brings `frame` into `surfaces`, which are allocated anew where extents changed.
    /// The frame's memory must stay until the queue is done; release() then lets go of it.
    void enqueue(const FrameInputs& frame, FrameSurfaces& surfaces);
    void release() { borrowed_.clear(); }

    /// One image into rows of a surface. Same rule for its memory.
    void enqueueImage(const ImageView& image, const Surface& surface, int firstRowPx);

private:
    void enqueueMaps(const std::vector<LightMaps>& maps, ImageView LightMaps::*member, const Surface& surface);
    cl::Buffer borrow(const ImageView& image);

    Device device_;
    UnpackStage unpack_;
    std::vector<cl::Buffer> borrowed_;
};

}  // namespace earthshine
