#pragma once
// A file that an earlier run wrote with --benchmark_out.

#include <map>
#include <string>
#include <vector>

namespace earthshine::bench {

struct ResultFile {
    std::string device, revision;                     ///< as that run printed them
    std::map<std::string, std::vector<double>> rows;  ///< median_ms of every repetition, by the row's name
    std::vector<std::string> failedRows;              ///< that could not run
};

/// Throws InputError "FILE: what is wrong" unless it is such a file, whole, with a row at least.
ResultFile readResultFile(const std::string& path);

}  // namespace earthshine::bench
