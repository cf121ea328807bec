#pragma once
// A frame as stages read it, whatever way it came.

#include "compute/surface.hpp"
#include "rsm_pack_params.h"
#include "stages/rsm_view.hpp"

namespace earthshine {

/// Surfaces of the G-buffer and of all lights' maps; what frame.hpp says of each image holds here.
struct FrameSurfaces {
    Surface albedo, normalWs, depth;
    Surface motion, emission;  ///< may be empty
    RsmView rsm;
    Surface shadowDepth;
    Extent shadowExtent;  ///< of one light's map
    cl::Buffer lights;    ///< LightParams
};

}  // namespace earthshine
