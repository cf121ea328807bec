#pragma once
// What a run of the benchmark was asked for, and what it found out before its first row.

#include <optional>
#include <string>
#include <vector>

#include "earthshine/image.hpp"
#include "roof.hpp"
#include "variants.hpp"

namespace earthshine::bench {

struct RunOptions {
    DeviceCaps device;
    std::vector<Variant> variants;
    std::vector<Extent> extents;  ///< for every row; empty: each row's own
    std::optional<Roof> roof;     ///< once measured
};

/// The one of this run, filled by main before rows are added.
RunOptions& runOptions();

/// "1280x720,64x36". Throws UsageError.
std::vector<Extent> parseExtents(const std::string& text);

/// What the names of a row's counters of stages begin with; the rest is the kernel's name. Milliseconds.
inline constexpr const char* kStageCounter = "stage_ms:";

}  // namespace earthshine::bench
