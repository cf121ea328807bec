// modulate, luminance_sum, exposure, tone_map: from irradiance to the display.

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "room.hpp"
#include "row.hpp"
#include "stages/exposure_stage.hpp"
#include "stages/modulate_stage.hpp"
#include "stages/tone_map_stage.hpp"

namespace earthshine::bench {

namespace {

// bytes: albedo, irradiance and, if added, what is added in; radiance out.
Row modulate(const Variant& variant, Extent extent, bool adds) {
    const Room room(variant, extent);
    const Surface irradiance = room.noisy(), addend = room.noisy(), out = room.three();
    const auto stage = std::make_shared<ModulateStage>(room.device);
    return {.device = room.device,
            .run = launches(room.device,
                            [=] {
                                stage->enqueue({room.inputs.albedo, irradiance, adds ? &addend : nullptr, out});
                            }),
            .work = {.bytes = room.bytes({room.inputs.albedo, irradiance, out}) + (adds ? room.bytes({addend}) : 0.0),
                     .flops = (kScale3 + kMul3 + (adds ? kAdd3 : 0.0)) * room.pixels}};
}

// luminance_sum: bytes: radiance and depth; a pixel: luminance and its logarithm, two sums. exposure: bytes: the cells;
// two sums each, 2^x.
Row exposure(const Variant& variant, Extent extent, bool isExposure) {
    constexpr double kPixel = kLuminance + 1 + kLog2 + 2, kCells = LUMINANCE_CELLS_X * LUMINANCE_CELLS_Y;
    const Room room(variant, extent);
    const Surface radiance = room.noisy();
    const cl::Buffer factor = room.device.impl().makeBuffer(sizeof(float));
    const ExposureParams params = room.params(Settings()).exposure;
    const auto stage = std::make_shared<ExposureStage>(room.device);
    return {.device = room.device,
            .run = launches(
                room.device,
                [=] {
                    stage->enqueue({radiance, room.inputs.depth, factor}, params);
                },
                isExposure ? "exposure" : "luminance_sum"),
            .work = isExposure ? Work{8 * kCells + 4, 2 * kCells + kExp2}
                               : Work{room.bytes({radiance, room.inputs.depth}) + 8 * kCells, kPixel * room.pixels}};
}

// bytes: radiance in, four a pixel out. A channel: max; the curve (a limit, 8); min; the transfer function; the byte.
Row toneMap(const Variant& variant, Extent extent, ToneCurve curve) {
    constexpr double kCurve = 1 + (kFma + 1 + 2 * kFma + 1), kChannel = 1 + 1 + (1 + kPow + kFma) + kFma;
    const Room room(variant, extent);
    const Surface radiance = room.noisy();
    const cl::Buffer factor = room.device.impl().upload(std::vector<float>{1e-3f});
    const cl::Buffer display = room.device.impl().makeBuffer(std::size_t(4 * room.pixels));
    Settings settings;
    settings.toneCurve = curve;
    const ToneMapParams params = room.params(settings).toneMap;
    const auto stage = std::make_shared<ToneMapStage>(room.device);
    const double channel = kChannel + (curve == ToneCurve::Filmic ? kCurve : 0.0);
    return {
        .device = room.device,
        .run = launches(room.device,
                        [=] {
                            stage->enqueue({radiance, factor, display}, params);
                        }),
        .work = {.bytes = room.bytes({radiance}) + 4 * room.pixels, .flops = (kScale3 + 3 * channel) * room.pixels}};
}

}  // namespace

void addDisplayRows() {
    addRows("modulate", usualExtents(), "plain",
            [](const Variant& variant, Extent extent) { return modulate(variant, extent, false); });
    addRows("modulate", usualExtents(), "addend",
            [](const Variant& variant, Extent extent) { return modulate(variant, extent, true); });
    addRows("luminance_sum", usualExtents(), "",
            [](const Variant& variant, Extent extent) { return exposure(variant, extent, false); });
    // Microseconds of the device's after milliseconds of luminance_sum: by its own time alone it would run for minutes.
    constexpr int kRuns = 100;
    addRows(
        "exposure", usualExtents(), "",
        [](const Variant& variant, Extent extent) { return exposure(variant, extent, true); }, kRuns);
    addRows("tone_map", usualExtents(), "filmic",
            [](const Variant& variant, Extent extent) { return toneMap(variant, extent, ToneCurve::Filmic); });
    addRows("tone_map", usualExtents(), "srgb",
            [](const Variant& variant, Extent extent) { return toneMap(variant, extent, ToneCurve::Srgb); });
}

}  // namespace earthshine::bench
