#pragma once
// Runs of the path tracer until a budget is spent, and the files that they leave.

#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "image/image_file.hpp"
#include "raster/trace/path_tracer.hpp"

namespace earthshine::cli {

/// When to stop: whatever comes first. 0 = no such limit; one at least must be given.
struct TraceBudget {
    int samples = 0;     ///< a pixel, those of an earlier run included
    double seconds = 0;  ///< of this run
    double relMse = 0;   ///< of the noise that is left
};

/// Adds samples until the budget is spent. Noise is looked at after numbers of samples that depend on nothing but how
/// many there were at the start, so a run to a noise ends with the same picture everywhere. `progress` hears fractions;
/// `checkpoint`, if given, is called about once a minute. Returns why it stopped: "samples", "time" or "noise".
std::string spend(trace::PathTracer& tracer, const TraceBudget& budget, const std::function<void(double)>& progress,
                  const std::function<void()>& checkpoint = {});

/// Writes every output as a layer under the names that `render` gives them: the main picture, direct, indirect,
/// direct-irradiance, indirect-irradiance, albedo, normal, depth. Returns how many values are not finite.
std::size_t writeTraced(const std::filesystem::path& path, const trace::PathTracer& tracer,
                        const Attributes& attributes);

/// Samples, noise, rays and means, for reports.
nlohmann::ordered_json tracedJson(const trace::PathTracer& tracer);

}  // namespace earthshine::cli
