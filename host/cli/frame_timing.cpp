#include "cli/frame_timing.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <unistd.h>

namespace earthshine::cli {

namespace {

using Named = std::vector<std::pair<std::string, Series>>;

Series& find(Named& all, const std::string& name) {
    for (auto& [key, series] : all)
        if (key == name) return series;
    return all.emplace_back(name, Series{}).second;
}

std::string row(const std::string& name, const Series& series) {
    return fmt::format("{:<24}{:>11.3f}{:>11.3f}{:>11.3f}\n", name, series.median(), series.min(), series.max());
}

long long nowNs() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

double Series::median() const {
    if (ms.empty()) return 0.0;
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
}

double Series::min() const {
    return ms.empty() ? 0.0 : *std::min_element(ms.begin(), ms.end());
}

double Series::max() const {
    return ms.empty() ? 0.0 : *std::max_element(ms.begin(), ms.end());
}

void FrameTiming::addStages(const std::vector<StageTime>& times) {
    double sum = 0.0;
    for (const StageTime& time : times) {
        find(stages_, time.stage).ms.push_back(time.ms);
        sum += time.ms;
    }
    deviceTotal_.ms.push_back(sum);
}

void FrameTiming::addStep(const std::string& step, double ms) {
    find(steps_, step).ms.push_back(ms);
}

void FrameTiming::addTransport(const TransportCost& cost) {
    find(transport_, "wait").ms.push_back(cost.waitMs);
    find(transport_, "acquire").ms.push_back(cost.acquireMs);
    find(transport_, "release").ms.push_back(cost.releaseMs);
    transportHostBytes_ = cost.hostBytes;
}

void FrameTiming::clear() {
    *this = {};
    isCold_ = false;
}

std::string FrameTiming::table() const {
    std::string text =
        fmt::format("{:<24}{:>11}{:>11}{:>11}\n", "stage (on the device)", "median ms", "min ms", "max ms");
    for (const auto& [name, series] : stages_) text += row(name, series);
    text += row("all stages", deviceTotal_);
    text += fmt::format("\n{:<24}\n", "step (wall clock)");
    for (const auto& [name, series] : steps_) text += row(name, series);
    if (!transport_.empty()) {
        text += fmt::format("\n{:<24}\n", "transport (wall clock)");
        for (const auto& [name, series] : transport_) text += row(name, series);
        text += fmt::format("{:<24}{:>11.3f} MB a frame\n", "through the host", 1e-6 * double(transportHostBytes_));
    }
    if (isCold_) text += "\nThe first frame compiles and allocates; --frames 8 shows how long the later ones take.\n";
    return text;
}

double indirectMs(const std::vector<StageTime>& times) {
    double sum = 0.0;
    for (const StageTime& time : times)
        for (const char* start : {"rsm_", "tile_average", "temporal", "history_", "atrous", "downsample",
                                  "bilateral_upsample", "interpolate"})
            if (time.stage.starts_with(start)) sum += time.ms;
    return sum;
}

double processMs() {
    // /proc/self/stat: the 22nd field is the start, in ticks since boot; the 2nd, in brackets, may hold spaces.
    std::ifstream in("/proc/self/stat");
    std::string text, field;
    std::getline(in, text);
    std::istringstream fields(text.substr(std::min(text.rfind(')') + 1, text.size())));
    for (int i = 3; i <= 22; ++i) fields >> field;
    timespec now{};
    if (!fields || ::clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0.0;
    const double startMs = 1e3 * std::stod(field) / double(::sysconf(_SC_CLK_TCK));
    return 1e3 * double(now.tv_sec) + 1e-6 * double(now.tv_nsec) - startMs;
}

Stopwatch::Stopwatch() : startNs_(nowNs()) {}

double Stopwatch::ms() const {
    return 1e-6 * double(nowNs() - startNs_);
}

}  // namespace earthshine::cli
