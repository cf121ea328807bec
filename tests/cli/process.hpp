#pragma once
// Runs the real program, as a shell would.

#include <string>
#include <vector>

#include <sys/types.h>

namespace earthshine::test {

struct Result {
    int exitCode = -1;  ///< minus the signal's number if one ended it
    std::string out, err;
};

using Arguments = std::vector<std::string>;

/// What a program said beside its progress, which is said where a run is slow, as the first that compiles the kernels
/// is on a busy machine.
std::string besidesProgress(const std::string& err);

/// A program that runs; its output goes into files of its own.
class Process {
public:
    /// `environment` adds "NAME=value" to this process's own.
    explicit Process(const Arguments& arguments, const std::vector<std::string>& environment = {},
                     const std::string& program = EARTHSHINE_PROGRAM_PATH);
    ~Process();  ///< kills it if it still runs
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void signal(int number) const;
    Result wait();

private:
    std::string read(int file) const;

    pid_t pid_ = -1;
    int out_ = -1, err_ = -1;
};

/// Runs `earthshine`, or another program, with these arguments to its end.
Result runEarthshine(const Arguments& arguments, const std::vector<std::string>& environment = {},
                     const std::string& program = EARTHSHINE_PROGRAM_PATH);

}  // namespace earthshine::test
