#pragma once
// The error table of `quality`, as JSON, as Markdown and as plots.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/quality_list.hpp"
#include "image/metrics.hpp"
#include "image/svg_plot.hpp"

namespace earthshine::cli {

/// One setting on one scene.
struct QualityRow {
    const QualitySetting* setting;
    double estimatorMs = 0;                  ///< device time of the stages of indirect light
    double frameMs = 0;                      ///< device time of all stages
    std::optional<PictureErrors> converged;  ///< against the full sum, if the list has that before this row
    PictureErrors unoccluded;  ///< against the truth without indirect visibility: the estimator's own error
    PictureErrors oneBounce;   ///< against the truth: that and the light that leaks
};

/// A reference as it was used.
struct QualityTruth {
    double noiseRelMse = 0;
    int samples = 0;
    double mean = 0;  ///< lux
};

struct QualityResult {
    const QualityScene* scene;
    QualityTruth unoccluded, oneBounce;
    PictureErrors direct;  ///< direct irradiance against the truth, of the last setting
    std::vector<QualityRow> rows;
};

nlohmann::ordered_json qualityJson(const std::vector<QualityResult>& results);
std::string qualityMarkdown(const std::vector<QualityResult>& results, const std::string& heading);

/// Error against milliseconds, and against samples a pixel.
Plot errorAgainstMs(const QualityResult& result);
Plot errorAgainstSamples(const QualityResult& result);

}  // namespace earthshine::cli
