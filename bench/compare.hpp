#pragma once
// Two runs, row by row.

#include <string>
#include <vector>

#include "result_file.hpp"

namespace earthshine::bench {

/// How the times of a row stand to each other.
struct RowRatio {
    std::string name;
    double msA = 0.0, msB = 0.0;   ///< medians over repetitions
    double ratio = 0.0;            ///< msB / msA
    double low = 0.0, high = 0.0;  ///< quartiles of b / a over all pairs of a repetition of A and one of B
    std::size_t repetitionsA = 0, repetitionsB = 0;
};

/// The rows that both have, by name.
std::vector<RowRatio> compareRows(const ResultFile& a, const ResultFile& b);

/// The table of two files for people; what only one of them has is counted below it. Throws InputError for files that
/// are not results, have no row in common, or, unless `anyDevice`, are of different devices.
std::string compareFiles(const std::string& pathA, const std::string& pathB, bool anyDevice);

}  // namespace earthshine::bench
