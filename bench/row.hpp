#pragma once
// A row of the table: something that runs on a device again and again, and what it must do at least.

#include <functional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "earthshine/pipeline.hpp"
#include "variants.hpp"

namespace earthshine::bench {

/// What one run of a row must move and compute at least; the formula stands beside each row.
struct Work {
    double bytes = 0.0;  ///< each byte that it needs read once, each that it makes written once
    double flops = 0.0;  ///< as flops.hpp counts them
};

struct Row {
    Device device;
    std::function<std::vector<StageTime>()> run;  ///< once, to its end; gives the device's own time of each kernel
    Work work{};                                  ///< none: the row has no roofline
    double pixels = 0.0;                          ///< > 0: ns/px
    double samples = 0.0;                         ///< > 0: a pixel; ns/px/spp
    int warmUps = 1;                              ///< runs before time counts: the first compiles, histories want more
    bool showsStages = false;                     ///< beside the sum a line for each kernel, and wall-clock time
    std::function<void(benchmark::State&)> addCounters = {};  ///< after the last run
};

/// `enqueue` and a wait, as Row::run. `only`: of all that is launched, this kernel alone counts.
std::function<std::vector<StageTime>()> launches(const Device& device, std::function<void()> enqueue,
                                                 std::string only = {});

/// Adds a row. `make` runs when its turn comes, and what it made stays until the next row's. `iterations`: how often it
/// runs; 0 = until --benchmark_min_time of the device's own time have passed.
void addRow(const std::string& name, std::function<Row()> make, int iterations = 0);

/// The extents that a table has rows for.
struct Extents {
    std::vector<Extent> extents;
    bool areFixed = false;  ///< --sizes does not change them: maps, and what would take hours
};
/// 1280 x 720 and 1920 x 1080.
const Extents& usualExtents();

/// Adds stage.WxH.setting.variant for each extent and each of --variants, or of `variants`; no second dot if `setting`
/// is "".
using MakeRow = std::function<Row(const Variant& variant, Extent extent)>;
void addRows(const std::string& stage, const Extents& extents, const std::string& setting, const MakeRow& make,
             int iterations = 0);
void addRows(const std::string& stage, const Extents& extents, const std::string& setting,
             const std::vector<Variant>& variants, const MakeRow& make, int iterations = 0);

/// Lets go of the last row, before the driver is unloaded.
void forgetRows();

}  // namespace earthshine::bench
