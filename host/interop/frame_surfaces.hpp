#pragma once
// A frame as stages read it, whatever way it came.

#include <vector>

#include "compute/surface.hpp"
#include "earthshine/frame.hpp"
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

/// What of a frame decides which surfaces it needs.
struct FrameShape {
    Extent extent;
    Extent rsm, shadow;  ///< of one light's map; without a light, anything
    bool hasMotion = false, hasEmission = false;
};

/// Makes the surfaces of a frame, anew where they are not of its shape, and uploads its lights (waits for that). The
/// pixels are still to come. Throws DeviceError for maps that are more than the device can hold.
void prepareSurfaces(const Device& device, const FrameShape& shape, const std::vector<Light>& lights,
                     FrameSurfaces& out);

}  // namespace earthshine
