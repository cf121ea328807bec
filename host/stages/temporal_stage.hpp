#pragma once
// This frame averaged with history: the host half of kernels/temporal.cl.

#include "compute/kernel.hpp"
#include "temporal_params.h"

namespace earthshine {

/// What is remembered of every pixel, and what the next frame finds.
struct HistorySurfaces {
    Surface irradiance;  ///< lx, three numbers a pixel
    Surface length;      ///< frames
    Surface moment;      ///< lx^2: mean squared luminance of the samples; empty if nobody asks
};

/// Blends an estimate of irradiance into reprojected history. Thread-compatible; owns its program, no images.
class TemporalStage {
public:
    struct Images {
        const Surface& irradiance;
        const Surface& normalWs;
        const Surface& depth;
        const Surface* motion;  ///< may be null: nothing moved
        const Surface& prevNormalWs;
        const Surface& prevDepth;
        const HistorySurfaces& history;
        const cl::Buffer& confidence;  ///< HistoryCheckStage's
        const Surface& outIrradiance;
        const Surface& outLength;
        const Surface& outMoment;  ///< may be empty: then moments are neither read nor written
        const Surface& outChange;
    };
    explicit TemporalStage(const Device& device) : kernel_(device, "temporal") {}
    /// `params.hasMotion` and `keepsMoment` are set from `images`.
    void enqueue(const Images& images, TemporalParams params);

private:
    Kernel kernel_;
};

}  // namespace earthshine
