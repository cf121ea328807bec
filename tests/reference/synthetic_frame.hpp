#pragma once
// A frame made of random numbers: every texel its own surface, so that a wrong index, lane or channel cannot hide.

#include <cstdint>
#include <vector>

#include "earthshine/pipeline.hpp"

namespace earthshine::reference {

struct SyntheticOptions {
    Extent extent{37, 11};
    int rsmSizePx = 12;
    Extent shadowExtent{20, 14};
    int lightCount = 3;  ///< directional, spot, directional, ...
    bool emission = true;
    double skyFraction = 0.2;
};

/// The same frame for the same options on every machine.
FrameImages makeSyntheticFrame(const SyntheticOptions& options = {});

}  // namespace earthshine::reference
