// earthshine_bench: times kernels and frames by profiling events, tuned and naive in one run, against what the device
// can do at best. bench/README.md says how to read it. Exit codes: 0 done, 1 failed, 2 wrong usage.
//   earthshine_bench --tune ...: rows of the tuning table instead (tune.hpp)

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "benches.hpp"
#include "compare.hpp"
#include "compute/device_impl.hpp"
#include "compute/tuning.hpp"
#include "earthshine/error.hpp"
#include "reporter.hpp"
#include "revision.hpp"
#include "row.hpp"
#include "run_options.hpp"
#include "tune.hpp"

namespace earthshine::bench {

namespace {

void printHelp() {
    fmt::print(
        "earthshine_bench [--device=NAME] [--variants=LIST] [--sizes=LIST] [Google Benchmark's options]\n"
        "earthshine_bench --compare A.json B.json [--any-device]\n\n"
        "  --device=NAME     an OpenCL device by number or part of its name\n"
        "  --variants=LIST   tuned,naive (default), or all: every lanes x storage of the device as well\n"
        "  --sizes=LIST      such as 1280x720,64x36, in place of each row's own\n"
        "  --compare A B     two files of --benchmark_out: B's times over A's\n"
        "  --any-device      compare: they may be of different devices\n\n");
    benchmark::PrintDefaultHelp();
}

/// Our own options among all, taken out; the rest is Google Benchmark's.
class Arguments {
public:
    Arguments(int argc, char** argv) : words_(argv + 1, argv + argc) {}

    /// Takes it out; was it there?
    bool takeFlag(std::string_view flag) {
        return std::erase_if(words_, [&](const std::string& word) { return word == flag; }) > 0;
    }
    /// The value of --name=value, or `otherwise`.
    std::string take(const std::string& name, const std::string& otherwise) {
        const std::string start = "--" + name + "=";
        std::string value = otherwise;
        std::erase_if(words_, [&](const std::string& word) {
            if (!word.starts_with(start)) return false;
            value = word.substr(start.size());
            return true;
        });
        return value;
    }
    bool has(std::string_view start) const {
        return std::any_of(words_.begin(), words_.end(), [&](const std::string& w) { return w.starts_with(start); });
    }
    const std::vector<std::string>& rest() const { return words_; }

private:
    std::vector<std::string> words_;
};

int compare(Arguments& arguments) {
    const bool anyDevice = arguments.takeFlag("--any-device");
    const std::vector<std::string>& files = arguments.rest();
    if (files.size() != 2)
        throw UsageError(fmt::format("compare: takes two files, A.json and B.json; here are {}", files.size()));
    fmt::print("{}", compareFiles(files[0], files[1], anyDevice));
    return 0;
}

// Google Benchmark's own options come from what is left. The table is ours: what would change it has no effect.
void initialise(const Arguments& arguments) {
    for (const char* option : {"--benchmark_format", "--benchmark_report_aggregates_only",
                               "--benchmark_display_aggregates_only", "--benchmark_counters_tabular"})
        if (arguments.has(option))
            throw UsageError(
                fmt::format("{} is not for this table; --benchmark_out=FILE.json has every number", option));
    static std::vector<std::string> words;  // it keeps pointers
    words = arguments.rest();
    words.insert(words.begin(), "earthshine_bench");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    int argc = int(argv.size());
    benchmark::Initialize(&argc, argv.data(), printHelp);
    if (argc > 1) throw UsageError(fmt::format("'{}' is no option; --help lists them", argv[1]));
}

void addContext(const RunOptions& run) {
    const Device device(run.device, tuned().options);
    const Tuning& tuning = device.tuning();
    benchmark::AddCustomContext("device", run.device.name);
    benchmark::AddCustomContext("platform", run.device.platformVersion);
    benchmark::AddCustomContext("driver", run.device.driverVersion);
    benchmark::AddCustomContext("lanes", std::to_string(tuning.lanes));
    benchmark::AddCustomContext("storage", storageName(tuning.storage));
    benchmark::AddCustomContext("local_size", fmt::format("{}x{}", tuning.localSizePx[0], tuning.localSizePx[1]));
    benchmark::AddCustomContext("timer", device.impl().timesByClock ? "host clock" : "profiling events");
    benchmark::AddCustomContext("revision", kRevision);
    benchmark::AddCustomContext("copy_GB/s", fmt::format("{:.2f}", run.roof->copyGBs()));
    benchmark::AddCustomContext("copy_GB/s_by_kernel", fmt::format("{:.2f}", run.roof->kernelCopyGBs));
    benchmark::AddCustomContext("copy_GB/s_by_driver", fmt::format("{:.2f}", run.roof->bufferCopyGBs));
    benchmark::AddCustomContext("fma_GFLOP/s", fmt::format("{:.1f}", run.roof->fmaGflops));
}

void addAllRows() {
    addCopyRows();
    addUnpackRows();
    addDirectLightRows();
    addRsmRows();
    addRsmGatherRows();
    addTileAverageRows();
    addTemporalRows();
    addAtrousRows();
    addLowerResolutionRows();
    addDisplayRows();
    addIndirectRows();
    addFrameRows();
}

int run(Arguments& arguments) {
    RunOptions& options = runOptions();
    const std::string device = arguments.take("device", "");
    const bool hasSizes = arguments.has("--sizes=");
    const std::string variants = arguments.take("variants", ""), sizes = arguments.take("sizes", "");
    const bool onlyLists = arguments.has("--benchmark_list_tests") && !arguments.has("--benchmark_list_tests=false");
    initialise(arguments);
    if (hasSizes) options.extents = parseExtents(sizes);
    options.device = selectDevice(device);
    options.variants = parseVariants(variants, options.device);
    if (!onlyLists) {
        options.roof = measureRoof(options.device);
        addContext(options);
    }
    addAllRows();
    Reporter reporter;
    const std::size_t rowCount = benchmark::RunSpecifiedBenchmarks(&reporter);
    forgetRows();
    if (rowCount == 0) throw UsageError("no row has such a name; --benchmark_list_tests lists them");
    if (reporter.failureCount() > 0)
        throw DeviceError(fmt::format("{} rows could not run; they say why", reporter.failureCount()));
    return 0;
}

}  // namespace

}  // namespace earthshine::bench

int main(int argc, char** argv) {
    using namespace earthshine;
    try {
        if (bench::asksToTune(argc, argv)) {
            bench::tune(argc, argv);
            return 0;
        }
        bench::Arguments arguments(argc, argv);
        return arguments.takeFlag("--compare") ? bench::compare(arguments) : bench::run(arguments);
    } catch (const cl::Error& error) {
        fmt::print(stderr, "earthshine_bench: {}: {}\n", error.what(), clErrorName(error.err()));
    } catch (const BuildError& error) {
        fmt::print(stderr, "earthshine_bench: {}\n{}\n", error.what(), error.log());
    } catch (const UsageError& error) {
        fmt::print(stderr, "earthshine_bench: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "earthshine_bench: {}\n", error.what());
    }
    return 1;
}
