#include "cli/error_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace earthshine::cli {

nlohmann::ordered_json errorsJson(const PictureErrors& e) {
    nlohmann::ordered_json json = {{"pixels", e.pixels},
                                   {"maskedPixels", e.maskedPixels},
                                   {"nonFiniteTestPixels", e.nonFiniteTestPixels},
                                   {"nonFiniteReferencePixels", e.nonFiniteReferencePixels},
                                   {"testMean", e.testMean},
                                   {"referenceMean", e.referenceMean},
                                   {"meanError", e.meanError},
                                   {"channelMeanErrors", e.channelMeanErrors},
                                   {"relMse", e.relMse},
                                   {"mae", e.mae},
                                   {"mse", e.mse},
                                   {"exposure", e.exposure},
                                   {"psnrDb", e.psnrDb},
                                   {"ssim", e.ssim},
                                   {"ldrFlip", e.ldrFlip}};
    if (e.hdrFlip) {
        json["hdrFlip"] = e.hdrFlipMean;
        json["hdrFlipExposures"] = {{"startStops", e.hdrFlip->startExposureStops},
                                    {"stopStops", e.hdrFlip->stopExposureStops},
                                    {"count", e.hdrFlip->exposureCount}};
    }
    return json;
}

std::string errorsTable(const PictureErrors& e) {
    std::string text;
    const auto line = [&text](const char* name, const std::string& value) {
        text += fmt::format("{:<12} {}\n", name, value);
    };
    line("pixels", fmt::format("{} ({} masked; not finite: {} of the test, {} of the reference)", e.pixels,
                               e.maskedPixels, e.nonFiniteTestPixels, e.nonFiniteReferencePixels));
    line("mean", fmt::format("{:.6g}, reference {:.6g}: {:+.3f} % (R {:+.3f} %, G {:+.3f} %, B {:+.3f} %)", e.testMean,
                             e.referenceMean, 100 * e.meanError, 100 * e.channelMeanErrors[0],
                             100 * e.channelMeanErrors[1], 100 * e.channelMeanErrors[2]));
    line("relMSE", fmt::format("{:.4g}", e.relMse));
    line("MAE", fmt::format("{:.4g}", e.mae));
    line("PSNR", fmt::format("{:.2f} dB", e.psnrDb));
    line("SSIM", fmt::format("{:.5f}", e.ssim));
    line("LDR-FLIP", fmt::format("{:.5f}", e.ldrFlip));
    if (e.hdrFlip)
        line("HDR-FLIP",
             fmt::format("{:.5f} ({} exposures, {:+.2f} to {:+.2f} stops)", e.hdrFlipMean, e.hdrFlip->exposureCount,
                         e.hdrFlip->startExposureStops, e.hdrFlip->stopExposureStops));
    return text;
}

}  // namespace earthshine::cli
