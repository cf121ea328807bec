#pragma once
// What a person sees while the program works: the log and progress on stderr. Results go to stdout.

#include <chrono>
#include <string>

namespace earthshine::cli {

/// How much is said on stderr: failures only; warnings and progress too; everything.
enum class Verbosity { Quiet, Normal, Verbose };

/// Sends the library's log to stderr. Call it once, first.
void openConsole(Verbosity verbosity);

/// One line on stderr, `earthshine: message`.
void complain(const std::string& message);

/// Shows how far work that takes longer than two seconds is: a bar on a terminal, elsewhere a line every ten percent.
/// Nothing in quiet mode.
class Progress {
public:
    explicit Progress(std::string title);
    ~Progress();  ///< removes the bar
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void update(double fraction);

private:
    using Clock = std::chrono::steady_clock;
    std::string title_;
    Clock::time_point start_, lastDrawn_;
    bool terminal_, drawn_ = false;
    int lastTenth_ = 0;
};

}  // namespace earthshine::cli
