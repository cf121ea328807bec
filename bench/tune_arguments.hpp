#pragma once
// What is asked of --tune on the command line.

#include <string>

#include "earthshine/image.hpp"

namespace earthshine::bench {

struct TuneArguments {
    std::string device, out;
    Extent extent{1920, 1080};
    int rounds = 3;
    bool groupsOnly = false;  ///< for the lanes and storage that the table has
};

/// Throws UsageError for what it does not know.
TuneArguments parseTuneArguments(int argc, char** argv);

}  // namespace earthshine::bench
