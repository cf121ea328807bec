#pragma once
// What a person sees of a run: a line a row, each kernel's part below a row of several, and at the end how much faster
// than naive the tuned rows were.

#include <map>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace earthshine::bench {

/// Where a row was repeated, its line has medians over the repetitions, the least of all times, and how far the
/// repetitions' medians lie apart.
class Reporter : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context& context) override;
    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

    /// Rows that could not run.
    int failureCount() const { return failureCount_; }

private:
    void printRow(const std::string& name, const std::map<std::string, std::vector<double>>& counters);

    std::size_t nameWidth_ = 0;
    std::map<std::string, double> medianMs_;
    int failureCount_ = 0;
};

}  // namespace earthshine::bench
