#include "pipeline/indirect_pass.hpp"

#include <algorithm>
#include <utility>

#include "compute/tuning.hpp"
#include "stages/blue_noise.hpp"
#include "stages/frame_params.hpp"

namespace earthshine {

IndirectPass::IndirectPass(const Device& device)
    : device_(device),
      rsmPack_(device),
      rsmMinify_(device),
      rsmGather_(device),
      rsmChoose_(device),
      rsmGatherCoherent_(device),
      rsmSum_(device),
      temporal_(device),
      historyCheck_(device),
      atrous_(device),
      noise_(device.impl().upload(makeRotationNoise())),
      confidence_(device.impl().makeBuffer(sizeof(float))) {}

void IndirectPass::allocate(Extent extent, const FrameParams& params) {
    if (sampled_.extent() != extent) {
        forget();
        ensure(device_, sampled_, PixelFormat::RGBA32F, extent);
        const Extent tiles = HistoryCheckStage::tiles(extent);
        confidence_ =
            device_.impl().makeBuffer(sizeof(float) * std::size_t(tiles.widthPx) * std::size_t(tiles.heightPx));
    }
    if (!params.denoises) return;
    for (HistorySurfaces* h : {&history_, &next_}) {
        ensure(device_, h->irradiance, PixelFormat::RGBA32F, extent);
        ensure(device_, h->length, PixelFormat::R32F, extent);
        if (params.keepsMoment)
            ensure(device_, h->moment, PixelFormat::R32F, extent);
        else
            h->moment = {};
    }
    ensure(device_, change_, PixelFormat::R32F, extent);
    if (params.feedbackPasses > 0) ensure(device_, accumulated_, PixelFormat::RGBA32F, extent);
    if (!params.filterPasses.empty())
        for (Surface& surface : filtered_) ensure(device_, surface, PixelFormat::RGBA32F, extent);
}

void IndirectPass::uploadPattern(int count, DiskPattern kind) {
    if (patternSize_ == count && patternKind_ == kind) return;
    pattern_ = device_.impl().upload(makeDiskPattern(count, kind));
    patternSize_ = count;
    patternKind_ = kind;
}

// Bands of whole groups of rows, of about this many pairs of pixel and texel: some tenths of a second on two CPU
// cores, so that progress shows and a GPU's display stays alive.
void IndirectPass::sumInBands(const FrameSurfaces& inputs, const RsmSumParams& params,
                              const std::function<void(double)>& progress) {
    constexpr double kPairsPerLaunch = 5e8;
    const Extent extent = sampled_.extent();
    const int groupRows = localSizeOf(device_.tuning(), "rsm_sum")[1];
    const double pairsPerRow =
        double(extent.widthPx) * params.rsmSizePx * double(params.rsmSizePx) * std::max(inputs.rsm.lightCount, 1);
    const int rows =
        std::max(int(std::min(kPairsPerLaunch / pairsPerRow, double(extent.heightPx))) / groupRows, 1) * groupRows;
    for (int first = 0; first < extent.heightPx; first += rows) {
        RsmSumParams band = params;
        band.firstRowPx = first;
        rsmSum_.enqueue({inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights, sampled_}, band,
                        std::min(rows, extent.heightPx - first));
        if (progress) {
            device_.impl().finish();
            progress(double(std::min(first + rows, extent.heightPx)) / extent.heightPx);
        }
    }
}

// In bands of rows whose choices take no more memory than this: all rows at the usual numbers of samples.
void IndirectPass::gatherShared(const FrameSurfaces& inputs, const RsmChooseParams& params) {
    constexpr std::size_t kChoices = std::size_t(1) << 23;
    const Extent extent = sampled_.extent();
    const std::size_t perRow =
        choicesInRow(extent.widthPx, params.gather.sampleCount) * std::size_t(std::max(inputs.rsm.lightCount, 1));
    const int rows = std::clamp(int(kChoices / perRow), 1, extent.heightPx);
    if (const std::size_t size = perRow * std::size_t(rows); choicesSize_ < size) {
        choices_ = device_.impl().makeBuffer(sizeof(RsmChoice) * size);
        choicesSize_ = size;
    }
    for (int first = 0; first < extent.heightPx; first += rows) {
        RsmChooseParams band = params;
        band.firstRowPx = first;
        band.rowCount = std::min(rows, extent.heightPx - first);
        rsmChoose_.enqueue({inputs.depth, inputs.lights, pattern_, noise_, choices_}, band);
        rsmGatherCoherent_.enqueue({inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights, choices_, sampled_},
                                   band);
    }
}

void IndirectPass::gather(const FrameSurfaces& inputs, const FrameParams& params,
                          const std::function<void(double)>& progress) {
    if (device_.tuning().rsmRecords && inputs.rsm.lightCount > 0) {
        if (params.pack.minify > 1)
            rsmMinify_.enqueue(inputs.rsm, inputs.lights, params.pack);
        else
            rsmPack_.enqueue(inputs.rsm, inputs.lights);
    }
    if (params.estimator == Estimator::Sum) {
        sumInBands(inputs, params.sum, progress);
        return;
    }
    uploadPattern(params.gather.sampleCount, params.pattern);
    if (params.sharesTexels) {
        gatherShared(inputs, params.choose);
        return;
    }
    rsmGather_.enqueue({inputs.normalWs, inputs.depth, inputs.rsm, inputs.lights, pattern_, noise_, sampled_},
                       params.gather);
    if (!params.averagesTile) return;
    if (!tileAverage_) tileAverage_.emplace(device_);
    ensure(device_, averaged_, PixelFormat::RGBA32F, sampled_.extent());
    tileAverage_->enqueue({sampled_, inputs.normalWs, inputs.depth, averaged_}, params.tileAverage);
    irradiance_ = averaged_;
}

void IndirectPass::denoise(const FrameSurfaces& inputs, const FrameSurfaces& previous, const FrameParams& params) {
    const Surface& accumulated = params.feedbackPasses > 0 ? accumulated_ : next_.irradiance;
    temporal_.enqueue({irradiance_, inputs.normalWs, inputs.depth, inputs.motion.empty() ? nullptr : &inputs.motion,
                       hasHistory_ ? previous.normalWs : inputs.normalWs, hasHistory_ ? previous.depth : inputs.depth,
                       history_, confidence_, accumulated, next_.length, next_.moment, change_},
                      params.temporal);
    if (params.checksHistory) historyCheck_.enqueue({change_, confidence_}, params.historyCheck);

    const Surface* filtered = &accumulated;
    const std::vector<AtrousParams>& passes = params.filterPasses;
    for (std::size_t done = 0; done < passes.size();) {
        const AtrousParams& pass = passes[done];
        const bool isPair =
            device_.tuning().filterPairs && atrous_.canPair(pass) && pass.radiusY == 0;  // a column follows each row
        done += isPair ? 2 : 1;
        const Surface& free = filtered == &filtered_[0] ? filtered_[1] : filtered_[0];
        const Surface& out = int(done) == params.feedbackPasses ? next_.irradiance : free;
        const AtrousStage::Images images{*filtered, inputs.normalWs, inputs.depth, next_.length, next_.moment, out};
        if (isPair)
            atrous_.enqueuePair(images, pass);
        else
            atrous_.enqueue(images, pass);
        filtered = &out;
    }
    irradiance_ = *filtered;
    std::swap(history_, next_);
    hasHistory_ = params.accumulates;
    hasConfidence_ = params.checksHistory;
    hasMoment_ = params.keepsMoment;
}

void IndirectPass::enqueue(const FrameSurfaces& inputs, const FrameSurfaces& previous, const FrameParams& params,
                           const std::function<void(double)>& progress) {
    if (extent_ != inputs.depth.extent() || divisor_ != params.divisor) forget();
    extent_ = inputs.depth.extent();
    divisor_ = params.divisor;
    const bool isLower = params.divisor > 1;
    if (isLower) {
        if (!lower_) lower_.emplace(device_);
        lower_->pick(inputs, params.divisor);
    }
    const FrameSurfaces& seen = isLower ? lower_->picked() : inputs;
    allocate(seen.depth.extent(), params);
    irradiance_ = sampled_;
    gather(seen, params, progress);
    if (params.denoises)
        denoise(seen, isLower ? lower_->previous() : previous, params);
    else
        forget();
    interpolated_ = isLower && params.upsampling == Upsampling::Interpolate;
    if (interpolated_)
        irradiance_ = lower_->interpolate(inputs, irradiance_, params, pattern_, noise_);
    else if (isLower)
        irradiance_ = lower_->upsample(inputs, irradiance_, params);
}

}  // namespace earthshine
