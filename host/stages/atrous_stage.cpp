#include "stages/atrous_stage.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "earthshine/error.hpp"

namespace earthshine {

namespace {

int dividedUp(int a, int b) {
    return (a + b - 1) / b;
}

}  // namespace

bool AtrousStage::canPair(const AtrousParams& params) const {
    if (params.weights != ATROUS_WEIGHTS_PLANE || params.luminanceTolerance > 0.0f) return false;
    const DeviceCaps& caps = device_.caps();
    return lanes() > 1 || (params.stepPx <= ATROUS_PAIR_MOST_STEP && caps.maxWorkGroupSize >= ATROUS_PAIR_GROUP(1) &&
                           caps.localMemoryBytes >= ATROUS_PAIR_LOCAL_BYTES);
}

// Each item filters four rows beside its own, so items are as long as they can be, or up to twice that: on a CPU much
// longer than four rows; on a GPU so long that all groups run at once, four a unit (what the kernel's registers allow
// on an H100).
int AtrousStage::wantedRows(Extent extent) const {
    constexpr int kLeastRows = 8, kStripRows = 64, kGroupsPerUnit = 4;
    if (lanes() > 1) return kStripRows;
    const int groups = kGroupsPerUnit * device_.caps().computeUnits;
    return std::clamp(dividedUp(extent.heightPx * dividedUp(extent.widthPx, ATROUS_PAIR_GROUP(1)), groups), kLeastRows,
                      kStripRows);
}

void AtrousStage::set(Kernel& kernel, const Images& images, const AtrousParams& params) {
    constexpr int kMaxLanes = 16, kMaxRadius = 2;
    const Extent extent = images.outIrradiance.extent();
    requireExtent("atrous", "inIrradiance", images.irradiance, extent);
    requireExtent("atrous", "inNormalWs", images.normalWs, extent);
    requireExtent("atrous", "inDepth", images.depth, extent);
    requireExtent("atrous", "inLength", images.length, extent);
    if (params.luminanceTolerance > 0.0f) requireExtent("atrous", "inMoment", images.moment, extent);
    if (params.stepPx < 1 || kMaxRadius * params.stepPx > SURFACE_GUARD - kMaxLanes)
        throw DeviceError(fmt::format("atrous: a step of {} px is not in [1; {}]", params.stepPx,
                                      (SURFACE_GUARD - kMaxLanes) / kMaxRadius));
    kernel.set("inIrradiance", images.irradiance).set("inNormalWs", images.normalWs).set("inDepth", images.depth);
    kernel.set("inLength", images.length);
    kernel.set("outIrradiance", images.outIrradiance).setParams("params", params);
}

void AtrousStage::enqueue(const Images& images, const AtrousParams& params) {
    set(kernel_, images, params);
    kernel_.set("inMoment", params.luminanceTolerance > 0.0f ? images.moment : images.length);  // else bound, not read
    kernel_.enqueue(images.outIrradiance.extent());
}

void AtrousStage::enqueuePair(const Images& images, const AtrousParams& params) {
    if (!canPair(params))
        throw DeviceError(fmt::format(
            "atrous_pair: by planes alone; with one lane, steps of up to {} px (not {}), groups of {} items "
            "and {} bytes of local memory (here {}, {})",
            ATROUS_PAIR_MOST_STEP, params.stepPx, ATROUS_PAIR_GROUP(1), ATROUS_PAIR_LOCAL_BYTES,
            device_.caps().maxWorkGroupSize, device_.caps().localMemoryBytes));
    const Extent extent = images.outIrradiance.extent();
    const int rows = dividedUp(extent.heightPx, params.stepPx);  // of each remainder of the step
    const int pieces = std::max(rows / wantedRows(extent), 1);
    AtrousParams pair = params;
    pair.pairRows = dividedUp(rows, pieces);
    pair_.define("LIMITS_LONE", params.limitsLone);
    set(pair_, images, pair);
    pair_.enqueueItems(std::size_t(dividedUp(extent.widthPx, ATROUS_PAIR_STRIP(lanes()) * lanes())),
                       std::size_t(pieces * params.stepPx));
}

}  // namespace earthshine
