#pragma once
// `earthshine_bench --tune`: rows of the tuning table (host/compute/tuning_table.hpp) from measurements.

namespace earthshine::bench {

/// Does the command line ask to tune?
bool asksToTune(int argc, char** argv);

/// earthshine_bench --tune [--device=NAME] [--size=WxH] [--rounds=N] [--out FILE]
/// Prints what it tried, sorted by time, and the rows; FILE receives the rows. Throws UsageError for other arguments,
/// and what the device throws.
void tune(int argc, char** argv);

}  // namespace earthshine::bench
