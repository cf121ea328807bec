#pragma once
// From what a user sets to what kernels are given: one pure function, so that no setting can go unread.

#include <vector>

#include "direct_light_params.h"
#include "earthshine/image.hpp"
#include "earthshine/settings.hpp"
#include "exposure_params.h"
#include "rsm_gather_params.h"
#include "rsm_pack_params.h"
#include "rsm_sum_params.h"
#include "tone_map_params.h"

namespace earthshine {

/// What of a frame the parameters depend on.
struct FrameGeometry {
    ViewRays cameraRays{};
    int rsmSizePx = 0;
    int lightCount = 0;
    Extent shadowExtent;
    int frameIndex = 0;  ///< counts frames, from any number on
};

/// The parameters of every stage of a frame.
struct FrameParams {
    Estimator estimator = Estimator::Disk;
    DiskPattern pattern = DiskPattern::Hammersley;
    RsmPackParams pack{};
    RsmGatherParams gather{};
    RsmSumParams sum{};  ///< firstRowPx is each launch's own
    DirectLightParams directLight{};
    ExposureParams exposure{};
    ToneMapParams toneMap{};
};

FrameParams makeParams(const Settings& settings, const FrameGeometry& frame);

}  // namespace earthshine
