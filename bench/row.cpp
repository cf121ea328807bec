#include "row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "compute/device_impl.hpp"
#include "earthshine/error.hpp"
#include "run_options.hpp"

namespace earthshine::bench {

namespace {

// The row whose turn it is. Google Benchmark calls a row's function again and again, with more iterations or for a
// repetition: what it runs on is made once, and warmed up once.
struct Current {
    std::string name;
    std::optional<Row> row;
};
Current& current() {
    static Current c;
    return c;
}

double sumMs(const std::vector<StageTime>& times) {
    double sum = 0.0;
    for (const StageTime& time : times) sum += time.ms;
    return sum;
}

double medianOf(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

// Times of one thing over all iterations, in the order first heard of.
using Series = std::vector<std::pair<std::string, std::vector<double>>>;

void add(Series& all, const std::vector<StageTime>& times) {
    for (const StageTime& time : times) {
        auto same = std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.first == time.stage; });
        if (same == all.end()) same = all.insert(all.end(), {time.stage, {}});
        same->second.push_back(time.ms);
    }
}

void measure(benchmark::State& state, Row& row) {
    std::vector<double> deviceMs, wallMs;
    Series stages;
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        const std::vector<StageTime> times = row.run();
        wallMs.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        deviceMs.push_back(sumMs(times));
        if (row.showsStages) add(stages, times);
        state.SetIterationTime(1e-3 * deviceMs.back());
    }
    // Of medians: one interruption by another program is not the kernel's.
    const double ms = medianOf(deviceMs), seconds = 1e-3 * std::max(ms, 1e-9);
    state.counters["median_ms"] = ms;
    state.counters["min_ms"] = *std::min_element(deviceMs.begin(), deviceMs.end());
    if (row.work.bytes > 0.0) {
        const Roof& roof = *runOptions().roof;
        state.counters["GB/s"] = 1e-9 * row.work.bytes / seconds;
        if (row.work.flops > 0.0) state.counters["GFLOP/s"] = 1e-9 * row.work.flops / seconds;
        const double least = std::max(row.work.bytes / (1e9 * roof.copyGBs()), row.work.flops / (1e9 * roof.fmaGflops));
        state.counters["roofline"] = least / seconds;
    }
    if (row.pixels > 0.0) state.counters["ns/px"] = 1e6 * ms / row.pixels;
    if (row.samples > 0.0) state.counters["ns/px/spp"] = 1e6 * ms / row.pixels / row.samples;
    if (row.showsStages) {
        state.counters["wall_ms"] = medianOf(wallMs);
        for (const auto& [stage, values] : stages) state.counters[kStageCounter + stage] = medianOf(values);
    }
    if (row.addCounters) row.addCounters(state);
}

void runRow(benchmark::State& state, const std::string& name, const std::function<Row()>& make) {
    Current& now = current();
    try {
        if (now.name != name || !now.row) {
            now.row.reset();  // its memory first
            now.name = name;
            now.row = make();
            for (int i = 0; i < now.row->warmUps; ++i) now.row->run();
        }
        measure(state, *now.row);
    } catch (const BuildError& error) {
        now.row.reset();
        state.SkipWithError(fmt::format("{}\n{}", error.what(), error.log()).c_str());
    } catch (const Error& error) {
        now.row.reset();
        state.SkipWithError(error.what());
    } catch (const cl::Error& error) {
        now.row.reset();
        state.SkipWithError(fmt::format("{}: {}", error.what(), clErrorName(error.err())).c_str());
    }
}

}  // namespace

std::function<std::vector<StageTime>()> launches(const Device& device, std::function<void()> enqueue,
                                                 std::string only) {
    return [device, enqueue = std::move(enqueue), only = std::move(only)] {
        Device::Impl& impl = device.impl();
        impl.launches.clear();
        enqueue();
        impl.finish();
        std::vector<StageTime> times;
        for (const Launch& launch : impl.launches) {
            if (!only.empty() && launch.kernel != only) continue;
            auto same =
                std::find_if(times.begin(), times.end(), [&](const StageTime& t) { return t.stage == launch.kernel; });
            if (same == times.end()) same = times.insert(times.end(), {launch.kernel, 0.0});
            same->ms += launch.ms();
        }
        return times;
    };
}

void addRow(const std::string& name, std::function<Row()> make, int iterations) {
    auto* row = benchmark::RegisterBenchmark(
        name.c_str(), [name, make = std::move(make)](benchmark::State& state) { runRow(state, name, make); });
    row->UseManualTime()->Unit(benchmark::kMillisecond);
    if (iterations > 0) row->Iterations(iterations);
}

const Extents& usualExtents() {
    static const Extents extents{{{1280, 720}, {1920, 1080}}};
    return extents;
}

void addRows(const std::string& stage, const Extents& extents, const std::string& setting, const MakeRow& make,
             int iterations) {
    addRows(stage, extents, setting, runOptions().variants, make, iterations);
}

void addRows(const std::string& stage, const Extents& extents, const std::string& setting,
             const std::vector<Variant>& variants, const MakeRow& make, int iterations) {
    const bool isAsked = !extents.areFixed && !runOptions().extents.empty();
    for (const Extent extent : isAsked ? runOptions().extents : extents.extents)
        for (const Variant& variant : variants)
            addRow(
                fmt::format("{}.{}x{}.{}{}{}", stage, extent.widthPx, extent.heightPx, setting,
                            setting.empty() ? "" : ".", variant.name),
                [=] { return make(variant, extent); }, iterations);
}

void forgetRows() {
    current().row.reset();
}

}  // namespace earthshine::bench
