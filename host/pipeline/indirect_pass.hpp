#pragma once
// From RSMs to clean irradiance: gathers, accumulates over time, filters. Owns history.

#include <functional>
#include <optional>

#include "interop/frame_surfaces.hpp"
#include "pipeline/lower_resolution.hpp"
#include "pipeline/make_params.hpp"
#include "stages/atrous_stage.hpp"
#include "stages/history_check_stage.hpp"
#include "stages/rsm_choose_stage.hpp"
#include "stages/rsm_gather_coherent_stage.hpp"
#include "stages/rsm_gather_stage.hpp"
#include "stages/rsm_minify_stage.hpp"
#include "stages/rsm_pack_stage.hpp"
#include "stages/rsm_sum_stage.hpp"
#include "stages/temporal_stage.hpp"
#include "stages/tile_average_stage.hpp"

namespace earthshine {

/// The stages of indirect light in order. Thread-compatible.
class IndirectPass {
public:
    explicit IndirectPass(const Device& device);

    /// Did the previous frame leave a history that a frame of this extent can use, and was that checked?
    bool hasHistory(Extent extent, const Settings& settings) const {
        return hasHistory_ && divisor_ == settings.divisor && extent_ == extent &&
               (hasMoment_ || !keepsMoment(settings));
    }
    bool hasConfidence() const { return hasConfidence_; }
    /// The next frame begins anew.
    void forget() { hasHistory_ = hasConfidence_ = false; }

    /// Enqueues a frame. `previous` are the previous frame's normal and depth; read only if there is history.
    /// `progress`, if given, waits for the device between parts of a full sum and hears of each.
    void enqueue(const FrameSurfaces& inputs, const FrameSurfaces& previous, const FrameParams& params,
                 const std::function<void(double)>& progress);

    /// lx: what the last frame made.
    const Surface& irradiance() const { return irradiance_; }

    /// How many pixels interpolation left to be gathered in full; 0 without it. Waits for the device.
    int gatheredPixels() const { return interpolated_ ? lower_->gatheredPixels() : 0; }

private:
    void allocate(Extent extent, const FrameParams& params);
    void uploadPattern(int count, DiskPattern kind);
    void gather(const FrameSurfaces& inputs, const FrameParams& params, const std::function<void(double)>& progress);
    void gatherShared(const FrameSurfaces& inputs, const RsmChooseParams& params);
    void sumInBands(const FrameSurfaces& inputs, const RsmSumParams& params,
                    const std::function<void(double)>& progress);
    void denoise(const FrameSurfaces& inputs, const FrameSurfaces& previous, const FrameParams& params);

    Device device_;
    RsmPackStage rsmPack_;
    RsmMinifyStage rsmMinify_;
    RsmGatherStage rsmGather_;
    RsmChooseStage rsmChoose_;
    RsmGatherCoherentStage rsmGatherCoherent_;
    RsmSumStage rsmSum_;
    TemporalStage temporal_;
    HistoryCheckStage historyCheck_;
    AtrousStage atrous_;

    std::optional<TileAverageStage> tileAverage_;  ///< once it was asked for
    std::optional<LowerResolution> lower_;         ///< the same

    cl::Buffer noise_, pattern_, confidence_, choices_;
    std::size_t choicesSize_ = 0;
    int patternSize_ = 0;
    DiskPattern patternKind_ = DiskPattern::Hammersley;
    Extent extent_;  ///< of the full picture
    int divisor_ = 1;
    bool interpolated_ = false;
    Surface sampled_;                 ///< this frame's estimate
    Surface averaged_;                ///< its mean over tiles
    Surface accumulated_;             ///< temporal's output, where history takes a filtered picture instead
    Surface filtered_[2];             ///< the filter's passes in turn
    Surface change_;                  ///< from history to this frame's estimate
    HistorySurfaces history_, next_;  ///< what the previous frame left; what this one leaves
    bool hasHistory_ = false, hasConfidence_ = false, hasMoment_ = false;
    Surface irradiance_;  ///< one of the above
};

}  // namespace earthshine
