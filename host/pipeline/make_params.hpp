#pragma once
// From what a user sets to what kernels are given: one pure function, so that no setting can go unread.

#include <vector>

#include "atrous_params.h"
#include "direct_light_params.h"
#include "earthshine/image.hpp"
#include "earthshine/settings.hpp"
#include "exposure_params.h"
#include "history_check_params.h"
#include "rsm_choose_params.h"
#include "rsm_gather_params.h"
#include "rsm_pack_params.h"
#include "rsm_sum_params.h"
#include "temporal_params.h"
#include "tile_average_params.h"
#include "tone_map_params.h"

namespace earthshine {

/// What of a frame the parameters depend on.
struct FrameGeometry {
    ViewRays cameraRays{};  ///< of the full picture, as previousRays
    Extent extent{1, 1};
    int rsmSizePx = 0;
    int lightCount = 0;
    Extent shadowExtent;
    int frameIndex = 0;          ///< counts frames, from any number on
    ViewRays previousRays{};     ///< of the previous frame's camera
    bool hasHistory = false;     ///< a previous frame of the same extent left its history
    bool hasConfidence = false;  ///< and had it checked
};

/// The parameters of every stage of a frame.
struct FrameParams {
    Estimator estimator = Estimator::Disk;
    DiskPattern pattern = DiskPattern::Hammersley;
    int divisor = 1;
    Upsampling upsampling = Upsampling::Bilateral;
    ViewRays fullRays{};  ///< gather, sum, temporal and filter have those of the picture at 1 / divisor
    RsmPackParams pack{};
    RsmGatherParams gather{};
    bool sharesTexels = false;  ///< by choose in place of gather
    RsmChooseParams choose{};   ///< firstRowPx and rowCount are each launch's own
    RsmSumParams sum{};         ///< firstRowPx is each launch's own
    bool averagesTile = false;  ///< after the gather
    TileAverageParams tileAverage{};
    bool denoises = false;      ///< temporal runs: it also readies a single frame for the filter
    bool accumulates = false;   ///< and its output is kept for the next frame
    TemporalParams temporal{};  ///< hasMotion is the stage's own
    bool keepsMoment = false;   ///< the filter is guided by luminance
    bool checksHistory = false;
    HistoryCheckParams historyCheck{};
    std::vector<AtrousParams> filterPasses;  ///< in order
    int feedbackPasses = 0;                  ///< history remembers the output of this many of them
    DirectLightParams directLight{};
    ExposureParams exposure{};
    ToneMapParams toneMap{};
};

/// Do these settings guide the filter by luminance, and so need moments in history?
bool keepsMoment(const Settings& settings);

FrameParams makeParams(const Settings& settings, const FrameGeometry& frame);

}  // namespace earthshine
