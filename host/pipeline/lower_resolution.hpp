#pragma once
// Indirect light at a half or a fourth of the picture's width and height: the G-buffer that it is computed on, and the
// way back to every pixel.

#include "interop/frame_surfaces.hpp"
#include "pipeline/make_params.hpp"
#include "stages/bilateral_upsample_stage.hpp"
#include "stages/downsample_stage.hpp"
#include "stages/interpolate_stage.hpp"
#include "stages/rsm_gather_list_stage.hpp"

namespace earthshine {

/// Thread-compatible; owns the picked surfaces of this frame and the one before.
class LowerResolution {
public:
    explicit LowerResolution(const Device& device);

    /// Picks normal, depth and motion of a frame; what was picked of the frame before becomes `previous`.
    void pick(const FrameSurfaces& full, int divisor);
    /// The frame with picked surfaces in place of its own.
    const FrameSurfaces& picked() const { return picked_; }
    const FrameSurfaces& previous() const { return previous_; }

    /// Brings irradiance of picked() to every pixel of `full`.
    const Surface& upsample(const FrameSurfaces& full, const Surface& irradiance, const FrameParams& params);
    /// The same where surfaces agree; the other pixels are gathered in full.
    const Surface& interpolate(const FrameSurfaces& full, const Surface& irradiance, const FrameParams& params,
                               const cl::Buffer& pattern, const cl::Buffer& noise);
    /// How many pixels the last interpolate() gathered in full. Waits for the device.
    int gatheredPixels() const;

private:
    void allocate(Extent extent);

    Device device_;
    DownsampleStage downsample_;
    BilateralUpsampleStage upsample_;
    InterpolateStage interpolate_;
    RsmGatherListStage gatherList_;
    FrameSurfaces picked_, previous_;
    Surface irradiance_;
    cl::Buffer pixels_, count_;
};

}  // namespace earthshine
