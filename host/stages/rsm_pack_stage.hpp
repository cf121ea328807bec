#pragma once
// Three maps into one record a texel: the host half of kernels/rsm_pack.cl.

#include "rsm_pack_params.h"
#include "stages/rsm_view.hpp"

namespace earthshine {

/// Fills RsmView::records from its surfaces. Thread-compatible; owns its program, no images.
class RsmPackStage {
public:
    explicit RsmPackStage(const Device& device) : kernel_(device, "rsm_pack") {}
    void enqueue(const RsmView& rsm, const cl::Buffer& lights);

private:
    Kernel kernel_;
};

}  // namespace earthshine
