// atrous: passes of the filter, each with all its taps: history of one frame, which fades nothing (kernels/atrous.cl).

#include <memory>
#include <string>

#include "benches.hpp"
#include "flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/atrous_stage.hpp"

namespace earthshine::bench {

namespace {

// A pixel: 1 / length and fade; its ray, how far that runs along the normal; the reach, what few frames make of it, 1 /
// reach; slope and offset of its plane at no tap.
constexpr double kPixel = 4 + kMad3 + kDot3 + (kFma + 1) + 3 + 2 + (2 + 1);
// What a pass makes of it: the weights' sum, the mean.
constexpr double kMean = kFma + kScale3 + kMad3 + 1 + kScale3;
// A direction that it has taps in: slope and offset a step, and at the first tap.
constexpr double kDirection = 2 * (kDot3 + 1) + 2 * 2;
// A tap: its slope and offset; how its normal turned (a product, a mad, a bound); distance from the plane; 1 - t of
// both; its square; its share; sums.
constexpr double kTap = 2 + (kDot3 + kFma + 1) + kFma + (1 + kFma) + 1 + 1 + 1 + 1 + kMad3;
// atrous.cl, whose luminance guides nothing here, takes the difference all the same, of each tap and a pixel.
constexpr double kGuideTap = kLuminance + 1 + 2 + kFma, kGuide = kLuminance;
// In the first iteration, a lone pixel's limit: a tap's luminance, one more tap; a pixel's shares, its luminance times
// the taps, the limit times them. (Few are above it.)
constexpr double kLimitTap = kLuminance + 2, kLimit = 2 + (kLuminance + 1) + (1 + kFma + 1);

// bytes: depth and out at every pixel; irradiance, normals and length where there is no sky, though pairs read all.
Row atrous(const Variant& variant, Extent extent, FilterKernel kernel, std::size_t pass, bool isPair = false) {
    const Room room(variant, extent);
    const Surface in = room.noisy(), out = room.three(), length = room.constant(1.0f);
    Settings settings = settingsOf(Preset::Balanced);
    settings.filterKernel = kernel;
    const AtrousParams params = room.params(settings, true).filterPasses.at(pass);
    const int taps = isPair ? 8 : (2 * params.radiusX + 1) * (2 * params.radiusY + 1) - 1;
    const int directions = isPair ? 2 : (params.radiusX > 0) + (params.radiusY > 0);
    const int passes = isPair ? 2 : 1;
    const double guide = isPair ? 0.0 : kGuide + taps * kGuideTap;
    const double limit = params.limitsLone ? passes * kLimit + taps * kLimitTap : 0.0;
    const auto stage = std::make_shared<AtrousStage>(room.device);
    return {.device = room.device,
            .run = launches(room.device,
                            [=] {
                                const FrameSurfaces& i = room.inputs;
                                const AtrousStage::Images images{in, i.normalWs, i.depth, length, Surface(), out};
                                isPair ? stage->enqueuePair(images, params) : stage->enqueue(images, params);
                            }),
            .work = {.bytes = room.bytes({room.inputs.depth, out}, {in, room.inputs.normalWs, length}),
                     .flops = (kPixel + passes * kMean + directions * kDirection + taps * kTap + guide + limit) *
                              room.seenPixels}};
}

}  // namespace

void addAtrousRows() {
    const auto add = [](const char* setting, FilterKernel kernel, std::size_t pass) {
        addRows("atrous", usualExtents(), setting,
                [=](const Variant& variant, Extent extent) { return atrous(variant, extent, kernel, pass); });
    };
    for (const std::size_t iteration : {0u, 2u})
        addRows("atrous_pair", usualExtents(), "step" + std::to_string(1 << iteration),
                [=](const Variant& variant, Extent extent) {
                    return atrous(variant, extent, FilterKernel::Separable, 2 * iteration, true);
                });
    add("row_step1", FilterKernel::Separable, 0);
    add("column_step1", FilterKernel::Separable, 1);
    add("row_step4", FilterKernel::Separable, 4);
    add("column_step4", FilterKernel::Separable, 5);
    add("3x3_step1", FilterKernel::Square3x3, 0);
    add("5x5_step1", FilterKernel::Square5x5, 0);
}

}  // namespace earthshine::bench
