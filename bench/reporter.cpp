#include "reporter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "row_name.hpp"
#include "run_options.hpp"
#include "statistics.hpp"

namespace earthshine::bench {

namespace {

constexpr std::string_view kStage = kStageCounter;

// Those that have a column; all others are named behind them.
constexpr const char* kColumns[] = {"median_ms", "min_ms", "GB/s", "GFLOP/s", "roofline"};

using Counters = std::map<std::string, std::vector<double>>;

std::string column(const Counters& counters, const char* name, int digits) {
    const auto found = counters.find(name);
    if (found == counters.end()) return "-";
    return fmt::format("{:.{}f}", quantile(found->second, 0.5), digits);
}

std::string spread(const std::vector<double>& ms) {
    if (ms.size() < 2) return "-";
    const auto [low, high] = std::minmax_element(ms.begin(), ms.end());
    return fmt::format("{:.1f} %", 100.0 * (*high - *low) / quantile(ms, 0.5));
}

}  // namespace

bool Reporter::ReportContext(const Context& context) {
    PrintBasicContext(&GetErrorStream(), context);
    constexpr std::size_t kBehindName = std::string_view("/manual_time").size();
    nameWidth_ = std::max(context.name_field_width, kBehindName + 10) - kBehindName;
    GetOutputStream() << fmt::format("\n{:<{}}{:>12}{:>12}{:>9}{:>9}{:>10}{:>10}\n", "", nameWidth_, "median ms",
                                     "min ms", "spread", "GB/s", "GFLOP/s", "roofline");
    return true;
}

void Reporter::printRow(const std::string& name, const Counters& counters) {
    const auto ms = counters.find("median_ms");
    if (ms == counters.end()) return;
    const std::vector<double>& minMs = counters.at("min_ms");
    std::string line =
        fmt::format("{:<{}}{:>12.4f}{:>12.4f}{:>9}{:>9}{:>10}{:>10}", name, nameWidth_, quantile(ms->second, 0.5),
                    *std::min_element(minMs.begin(), minMs.end()), spread(ms->second), column(counters, "GB/s", 2),
                    column(counters, "GFLOP/s", 1), column(counters, "roofline", 3));
    std::vector<std::pair<double, std::string>> stages;
    for (const auto& [counter, values] : counters) {
        const double value = quantile(values, 0.5);
        if (counter.starts_with(kStage))
            stages.emplace_back(value, counter.substr(kStage.size()));
        else if (std::find(std::begin(kColumns), std::end(kColumns), counter) == std::end(kColumns))
            line += fmt::format("  {} {:.5g}", counter, value);
    }
    std::sort(stages.rbegin(), stages.rend());
    for (const auto& [stageMs, stage] : stages)
        line += fmt::format("\n    {:<{}}{:>12.4f}", stage, nameWidth_ - 4, stageMs);
    GetOutputStream() << line << std::endl;
    medianMs_[name] = quantile(ms->second, 0.5);
}

// All repetitions of a row come in one call.
void Reporter::ReportRuns(const std::vector<Run>& runs) {
    Counters counters;
    std::string name;
    for (const Run& run : runs) {
        if (run.run_type == Run::RT_Aggregate) continue;
        name = rowName(run.benchmark_name());
        if (run.error_occurred) {
            ++failureCount_;
            GetOutputStream() << fmt::format("{:<{}}  {}", name, nameWidth_, run.error_message) << std::endl;
        }
        for (const auto& [counter, value] : run.counters) counters[counter].push_back(value.value);
    }
    printRow(name, counters);
}

void Reporter::Finalize() {
    for (const auto& [name, ms] : medianMs_) {
        constexpr std::string_view kTuned = ".tuned";
        if (!name.ends_with(kTuned)) continue;
        const std::string base = name.substr(0, name.size() - kTuned.size());
        const auto other = medianMs_.find(base + ".naive");
        if (other == medianMs_.end()) continue;
        GetOutputStream() << fmt::format("{}: naive {:.3f} ms / tuned {:.3f} ms = {:.1f}x\n", base, other->second, ms,
                                         other->second / ms);
    }
}

}  // namespace earthshine::bench
