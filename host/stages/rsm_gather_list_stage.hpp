#pragma once
// One bounce at the pixels of a list: the host half of kernels/rsm_gather_list.cl.

#include "stages/rsm_gather_stage.hpp"

namespace earthshine {

/// Estimates one-bounce irradiance (lx) as RsmGatherStage does, where InterpolateStage left it out; other pixels stay.
/// Thread-compatible; owns its program, no images.
class RsmGatherListStage {
public:
    explicit RsmGatherListStage(const Device& device) : device_(device), kernel_(device, "rsm_gather_list") {}
    /// `pixels` and `count` are InterpolateStage's.
    void enqueue(const RsmGatherStage::Images& images, const cl::Buffer& pixels, const cl::Buffer& count,
                 const RsmGatherParams& params);

private:
    Device device_;
    Kernel kernel_;
};

}  // namespace earthshine
