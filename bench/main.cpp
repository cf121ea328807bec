// earthshine_bench: times kernels by profiling events, tuned and naive in one run, and prints their ratio.
//   earthshine_bench --tune ...: rows of the tuning table instead (tune.hpp)
//   earthshine_bench [--device=NAME] [Google Benchmark's own options, such as --benchmark_filter=REGEX]

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "bench.hpp"
#include "compute/cl.hpp"
#include "compute/tuning.hpp"
#include "earthshine/error.hpp"
#include "tune.hpp"

namespace earthshine::bench {

namespace {

std::optional<DeviceCaps>& deviceSlot() {
    static std::optional<DeviceCaps> slot;
    return slot;
}

// The console's table, and after it one line for each benchmark that has a tuned and a naive form.
class RatioReporter : public benchmark::ConsoleReporter {
public:
    RatioReporter() : ConsoleReporter(OO_Tabular) {}

    void ReportRuns(const std::vector<Run>& runs) override {
        ConsoleReporter::ReportRuns(runs);
        for (const Run& run : runs) {
            const std::string name = run.benchmark_name();
            const bool isSingle = run.run_type == Run::RT_Iteration && run.repetitions <= 1;
            const bool isMedian = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
            if (!run.error_occurred && (isSingle || isMedian))
                ms_[name.substr(0, name.find('/'))] = run.GetAdjustedRealTime();
        }
    }

    void Finalize() override {
        for (const auto& [name, ms] : ms_) {
            constexpr std::string_view kTuned = ".tuned";
            if (!name.ends_with(kTuned)) continue;
            const std::string base = name.substr(0, name.size() - kTuned.size());
            const auto other = ms_.find(base + ".naive");
            if (other != ms_.end())
                fmt::print("{}: naive {:.2f} ms / tuned {:.2f} ms = {:.1f}x\n", base, other->second, ms,
                           other->second / ms);
        }
    }

private:
    std::map<std::string, double> ms_;
};

}  // namespace

const Variant& tuned() {
    static const Variant variant = [] {
        Variant v{"tuned", {}};
        v.options.profiling = true;
        return v;
    }();
    return variant;
}

const Variant& naive() {
    static const Variant variant = [] {
        Variant v{"naive", {}};
        v.options.profiling = true;
        v.options.lanes = 1;
        v.options.storage = "image";
        v.options.rsmRecords = 0;
        return v;
    }();
    return variant;
}

const DeviceCaps& chosenDevice() {
    return *deviceSlot();
}

}  // namespace earthshine::bench

int main(int argc, char** argv) {
    using namespace earthshine;
    try {
        if (bench::asksToTune(argc, argv)) {
            bench::tune(argc, argv);
            return 0;
        }
        std::string device;
        std::vector<char*> rest;
        for (int i = 0; i < argc; ++i) {
            constexpr std::string_view kDevice = "--device=";
            if (std::string_view(argv[i]).starts_with(kDevice))
                device = argv[i] + kDevice.size();
            else
                rest.push_back(argv[i]);
        }
        int count = int(rest.size());
        benchmark::Initialize(&count, rest.data());
        if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 2;

        const DeviceCaps caps = selectDevice(device);
        bench::deviceSlot() = caps;
        const Tuning tuning = tuningFor(caps, {});
        benchmark::AddCustomContext("device", caps.name);
        benchmark::AddCustomContext("platform", caps.platformVersion);
        benchmark::AddCustomContext("driver", caps.driverVersion);
        benchmark::AddCustomContext(
            "tuned", fmt::format("{} lanes, {} storage, {} x {} work-items a group", tuning.lanes,
                                 storageName(tuning.storage), tuning.localSizePx[0], tuning.localSizePx[1]));
        benchmark::AddCustomContext("revision", EARTHSHINE_REVISION);
        bench::registerDenoiser();
        bench::registerLowerResolution();
        bench::registerRsmGather();
        bench::RatioReporter reporter;
        benchmark::RunSpecifiedBenchmarks(&reporter);
        return 0;
    } catch (const cl::Error& error) {
        fmt::print(stderr, "earthshine_bench: {}: {}\n", error.what(), clErrorName(error.err()));
    } catch (const BuildError& error) {
        fmt::print(stderr, "earthshine_bench: {}\n{}\n", error.what(), error.log());
    } catch (const UsageError& error) {
        fmt::print(stderr, "earthshine_bench: {}\n", error.what());
        return 2;
    } catch (const Error& error) {
        fmt::print(stderr, "earthshine_bench: {}\n", error.what());
    }
    return 1;
}
