#pragma once
// Three maps into one record a block of texels: the host half of kernels/rsm_minify.cl.

#include "rsm_pack_params.h"
#include "stages/rsm_view.hpp"

namespace earthshine {

/// Fills RsmView::records from its surfaces, in rows of minifiedSizePx. Thread-compatible; owns its program, no images.
class RsmMinifyStage {
public:
    explicit RsmMinifyStage(const Device& device) : kernel_(device, "rsm_minify") {}
    void enqueue(const RsmView& rsm, const cl::Buffer& lights, const RsmPackParams& params);

private:
    Kernel kernel_;
};

/// Blocks a side of a map.
inline int minifiedSizePx(int sizePx, int minify) {
    return (sizePx + minify - 1) / minify;
}

}  // namespace earthshine
