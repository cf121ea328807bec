#include "cli/quality_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/error_report.hpp"

namespace earthshine::cli {

namespace {

nlohmann::ordered_json truthJson(const QualityTruth& truth) {
    return {{"samples", truth.samples}, {"noiseRelMse", truth.noiseRelMse}, {"mean", truth.mean}};
}

/// Rows by series, and one plot of them: x and y are taken from a row.
template <class X>
Plot plotOf(const QualityResult& result, const std::string& xTitle, X&& x) {
    Plot plot{fmt::format("{}: indirect irradiance", result.scene->name),
              xTitle,
              "relMSE (to the estimator's own truth)",
              {}};
    for (const QualityRow& row : result.rows) {
        const double at = x(row);
        if (!(at > 0.0)) continue;
        auto series = std::find_if(plot.series.begin(), plot.series.end(),
                                   [&](const PlotSeries& s) { return s.name == row.setting->series; });
        if (series == plot.series.end()) series = plot.series.insert(series, {row.setting->series, {}});
        series->points.push_back({at, row.unoccluded.relMse,
                                  fmt::format("{}: relMSE {:.3g}, mean {:+.2f} %, {:.2f} ms", row.setting->label,
                                              row.unoccluded.relMse, 100 * row.unoccluded.meanError, row.estimatorMs)});
    }
    return plot;
}

}  // namespace

nlohmann::ordered_json qualityJson(const std::vector<QualityResult>& results) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const QualityResult& result : results) {
        nlohmann::ordered_json rows = nlohmann::ordered_json::array();
        for (const QualityRow& row : result.rows)
            rows.push_back({{"setting", row.setting->label},
                            {"series", row.setting->series},
                            {"estimatorMs", row.estimatorMs},
                            {"frameMs", row.frameMs},
                            {"converged", row.converged ? errorsJson(*row.converged) : nlohmann::ordered_json()},
                            {"unoccluded", errorsJson(row.unoccluded)},
                            {"oneBounce", errorsJson(row.oneBounce)}});
        json.push_back(
            {{"scene", result.scene->name},
             {"references", {{"unoccluded", truthJson(result.unoccluded)}, {"oneBounce", truthJson(result.oneBounce)}}},
             {"direct", errorsJson(result.direct)},
             {"rows", std::move(rows)}});
    }
    return json;
}

std::string qualityMarkdown(const std::vector<QualityResult>& results, const std::string& heading) {
    std::string text = fmt::format("# Quality of indirect irradiance\n\n{}\n\n", heading);
    text +=
        "`ms`: median device time of the stages of indirect light, and of all stages. `sum`: error against the full "
        "sum "
        "over the RSM, which the estimators tend to. `estimator`: error against the "
        "path-traced truth without indirect visibility. `truth`: error against the path-traced bounce, so with the "
        "light that leaks. `mean` is signed; relMSE is the mean of err^2 / (ref^2 + (0.1 mean ref)^2).\n";
    for (const QualityResult& result : results) {
        text += fmt::format("\n## {}\n\n", result.scene->name);
        text += fmt::format(
            "Mean of the truth: {:.4g} lx ({} samples, noise relMSE {:.2g}); without visibility {:.4g} lx ({} samples, "
            "noise {:.2g}). Direct light: mean {:+.2f} %, relMSE {:.3g}.\n\n",
            result.oneBounce.mean, result.oneBounce.samples, result.oneBounce.noiseRelMse, result.unoccluded.mean,
            result.unoccluded.samples, result.unoccluded.noiseRelMse, 100 * result.direct.meanError,
            result.direct.relMse);
        text +=
            "| setting | ms | ms, all | sum: relMSE | HDR-FLIP | estimator: mean | relMSE | HDR-FLIP | truth: mean | "
            "relMSE | HDR-FLIP |\n"
            "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
        for (const QualityRow& row : result.rows) {
            const std::string converged =
                row.converged ? fmt::format("{:.3g} | {:.4f}", row.converged->relMse, row.converged->hdrFlipMean)
                              : " | ";
            text += fmt::format(
                "| {} | {:.2f} | {:.2f} | {} | {:+.2f} % | {:.3g} | {:.4f} | {:+.2f} % | {:.3g} | {:.4f} |\n",
                row.setting->label, row.estimatorMs, row.frameMs, converged, 100 * row.unoccluded.meanError,
                row.unoccluded.relMse, row.unoccluded.hdrFlipMean, 100 * row.oneBounce.meanError, row.oneBounce.relMse,
                row.oneBounce.hdrFlipMean);
        }
    }
    return text;
}

Plot errorAgainstMs(const QualityResult& result) {
    return plotOf(result, "milliseconds on the device", [](const QualityRow& row) { return row.estimatorMs; });
}

Plot errorAgainstSamples(const QualityResult& result) {
    return plotOf(result, "samples a pixel", [](const QualityRow& row) {
        return row.setting->settings.estimator == Estimator::Sum ? 0.0 : double(row.setting->settings.sampleCount);
    });
}

}  // namespace earthshine::cli
