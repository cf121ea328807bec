#include "compare.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "earthshine/error.hpp"
#include "statistics.hpp"

namespace earthshine::bench {

namespace {

std::string onlyIn(const std::string& path, const ResultFile& file, const ResultFile& other) {
    const auto count = std::count_if(file.rows.begin(), file.rows.end(),
                                     [&](const auto& row) { return !other.rows.contains(row.first); });
    std::string line;
    if (count > 0) line += fmt::format("{} row{} only in {}\n", count, count == 1 ? "" : "s", path);
    for (const std::string& row : file.failedRows) line += fmt::format("{}: {} did not run\n", path, row);
    return line;
}

}  // namespace

std::vector<RowRatio> compareRows(const ResultFile& a, const ResultFile& b) {
    std::vector<RowRatio> ratios;
    for (const auto& [name, timesA] : a.rows) {
        const auto other = b.rows.find(name);
        if (other == b.rows.end()) continue;
        std::vector<double> pairs;
        for (const double msA : timesA)
            for (const double msB : other->second) pairs.push_back(msB / msA);
        RowRatio row;
        row.name = name;
        row.msA = quantile(timesA, 0.5);
        row.msB = quantile(other->second, 0.5);
        row.ratio = row.msB / row.msA;
        row.low = quantile(pairs, 0.25);
        row.high = quantile(pairs, 0.75);
        row.repetitionsA = timesA.size();
        row.repetitionsB = other->second.size();
        ratios.push_back(row);
    }
    return ratios;
}

std::string compareFiles(const std::string& pathA, const std::string& pathB, bool anyDevice) {
    const ResultFile a = readResultFile(pathA), b = readResultFile(pathB);
    if (a.device != b.device && !anyDevice)
        throw InputError(fmt::format("{} is of \"{}\", {} of \"{}\"; --any-device compares them all the same", pathA,
                                     a.device, pathB, b.device));
    const std::vector<RowRatio> rows = compareRows(a, b);
    if (rows.empty()) throw InputError(fmt::format("{} and {} have no row in common", pathA, pathB));
    std::size_t width = 0;
    for (const RowRatio& row : rows) width = std::max(width, row.name.size());
    std::string table = fmt::format("A  {}: {}, revision {}\nB  {}: {}, revision {}\n\n", pathA, a.device, a.revision,
                                    pathB, b.device, b.revision);
    table += fmt::format("{:<{}}{:>12}{:>12}{:>9}   {:<18}{}\n", "", width, "A ms", "B ms", "B/A", "quartiles of B/A",
                         "repetitions");
    for (const RowRatio& row : rows)
        table += fmt::format("{:<{}}{:>12.4f}{:>12.4f}{:>9.3f}   {:<18}{} and {}\n", row.name, width, row.msA, row.msB,
                             row.ratio, fmt::format("{:.3f} to {:.3f}", row.low, row.high), row.repetitionsA,
                             row.repetitionsB);
    return table + onlyIn(pathA, a, b) + onlyIn(pathB, b, a);
}

}  // namespace earthshine::bench
