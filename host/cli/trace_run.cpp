#include "cli/trace_run.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include <nlohmann/json.hpp>

namespace earthshine::cli {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPortionSeconds = 0.5;  // of work between two looks at the clock
constexpr auto kCheckpointEvery = std::chrono::seconds(60);

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double meanOf(const HostImage& image, std::size_t surfacePixels) {
    double sum = 0.0;
    const auto [width, height] = image.extent();
    for (int i = 0; i < width * height; ++i) {
        const float* p = image.pixel(0, 0) + 4 * i;
        if (p[3] != 0.0f) sum += (double(p[0]) + double(p[1]) + double(p[2])) / 3.0;
    }
    return surfacePixels ? sum / double(surfacePixels) : 0.0;
}

}  // namespace

std::string spend(trace::PathTracer& tracer, const TraceBudget& budget, const std::function<void(double)>& progress,
                  const std::function<void()>& checkpoint) {
    const Clock::time_point start = Clock::now();
    Clock::time_point lastCheckpoint = start;
    const int most = budget.samples > 0 ? budget.samples : std::numeric_limits<int>::max();
    const int first = tracer.sampleCount();
    int portion = 2;
    for (int target = first; tracer.sampleCount() < most;) {
        target = std::min(most, target + std::max(16, (target - first) / 64 * 16));
        while (tracer.sampleCount() < target) {
            const Clock::time_point portionStart = Clock::now();
            tracer.addSamples(std::min(portion, target - tracer.sampleCount()));
            if (tracer.sampleCount() == first) return "samples";  // nothing to sample
            const double took = secondsSince(portionStart);
            if (took < kPortionSeconds / 2) portion = std::min(2 * portion, 1 << 16);
            if (took > kPortionSeconds * 2) portion = std::max(portion / 2, 1);
            const double bySamples = budget.samples > 0 ? double(tracer.sampleCount()) / budget.samples : 0.0;
            const double byTime = budget.seconds > 0.0 ? secondsSince(start) / budget.seconds : 0.0;
            // Squared errors fall as one over the samples.
            const double noise = budget.relMse > 0.0 && tracer.sampleCount() > 1 ? tracer.noise().relMse : 0.0;
            const double byNoise = noise > 0.0 ? budget.relMse / noise : 0.0;
            progress(std::max({bySamples, byTime, byNoise}));
            if (byTime >= 1.0) return "time";
            if (checkpoint && Clock::now() - lastCheckpoint > kCheckpointEvery) {
                checkpoint();
                lastCheckpoint = Clock::now();
            }
        }
        if (budget.relMse > 0.0 && tracer.noise().relMse <= budget.relMse) return "noise";
    }
    return "samples";
}

std::size_t writeTraced(const std::filesystem::path& path, const trace::PathTracer& tracer,
                        const Attributes& attributes) {
    const std::vector<std::string> rgb{"R", "G", "B"};
    const std::array<std::pair<const char*, HostImage>, 7> images{
        {{"", tracer.read(Output::Color)},
         {"direct", tracer.read(Output::Direct)},
         {"indirect", tracer.read(Output::Indirect)},
         {"direct-irradiance", tracer.read(Output::DirectIrradiance)},
         {"indirect-irradiance", tracer.read(Output::IndirectIrradiance)},
         {"albedo", tracer.albedo()},
         {"normal", tracer.normalWs()}}};
    const HostImage depth = tracer.depth();
    std::vector<Layer> layers;
    std::size_t nonFinite = 0;
    for (const auto& [name, image] : images) {
        layers.push_back(
            {name, image.view(), std::string_view(name) == "normal" ? std::vector<std::string>{"X", "Y", "Z"} : rgb});
        nonFinite += findNonFinite(image.view()).count;
    }
    layers.push_back({"depth", depth.view(), {"Z"}});
    writeExr(path, layers, attributes);
    return nonFinite;
}

nlohmann::ordered_json tracedJson(const trace::PathTracer& tracer) {
    const trace::TraceNoise noise = tracer.noise();
    const trace::RayCount rays = tracer.rays();
    return {{"samples", tracer.sampleCount()},
            {"surfacePixels", tracer.surfacePixels()},
            {"directIrradianceMean", meanOf(tracer.read(Output::DirectIrradiance), tracer.surfacePixels())},
            {"indirectIrradianceMean", meanOf(tracer.read(Output::IndirectIrradiance), tracer.surfacePixels())},
            {"noise", {{"relMse", noise.relMse}, {"meanError", noise.meanError}}},
            {"rays",
             {{"camera", rays.camera},
              {"gather", rays.gather},
              {"shadow", rays.shadow},
              {"light", rays.light},
              {"total", rays.total()},
              {"seconds", rays.seconds},
              {"perSecond", rays.seconds > 0.0 ? double(rays.total()) / rays.seconds : 0.0},
              {"cpuSeconds", rays.cpuSeconds},
              {"perCpuSecond", rays.cpuSeconds > 0.0 ? double(rays.total()) / rays.cpuSeconds : 0.0}}}};
}

}  // namespace earthshine::cli
