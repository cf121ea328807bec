#include "cli/console.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "earthshine/log.hpp"

namespace earthshine::cli {

namespace {

constexpr auto kPatience = std::chrono::seconds(2);
constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr int kBarWidth = 40;

Verbosity verbosity = Verbosity::Normal;
bool barOnScreen = false;
std::chrono::steady_clock::time_point opened;

bool isTerminal() {
    return ::isatty(STDERR_FILENO) == 1;
}

void eraseBar() {
    if (barOnScreen) std::fputs("\r\033[K", stderr);
    barOnScreen = false;
}

// A step of slow work: in one line of a terminal, elsewhere a line each once the program has run for a while.
void showStep(std::string_view step) {
    if (verbosity == Verbosity::Quiet) return;
    if (isTerminal()) {
        eraseBar();
        if (step.empty()) return;
        fmt::print(stderr, "earthshine: {}", step);
        std::fflush(stderr);
        barOnScreen = true;
    } else if (!step.empty() && std::chrono::steady_clock::now() - opened > kPatience) {
        fmt::print(stderr, "earthshine: {}\n", step);
    }
}

}  // namespace

void openConsole(Verbosity wanted) {
    verbosity = wanted;
    opened = std::chrono::steady_clock::now();
    setLogSink([](LogLevel level, std::string_view message) {
        if (level == LogLevel::Progress) return showStep(message);
        if (verbosity == Verbosity::Quiet || (verbosity == Verbosity::Normal && level != LogLevel::Warning)) return;
        complain(fmt::format("{}{}", level == LogLevel::Warning ? "warning: " : "", message));
    });
}

void complain(const std::string& message) {
    eraseBar();
    fmt::print(stderr, "earthshine: {}\n", message);
}

Progress::Progress(std::string title)
    : title_(std::move(title)), start_(Clock::now()), lastDrawn_(start_), terminal_(isTerminal()) {}

Progress::~Progress() {
    eraseBar();
}

void Progress::update(double fraction) {
    const auto now = Clock::now();
    if (verbosity == Verbosity::Quiet || now - start_ < kPatience) return;
    fraction = std::clamp(fraction, 0.0, 1.0);
    if (!terminal_) {
        const int tenth = int(fraction * 10.0);
        if (drawn_ && tenth == lastTenth_) return;
        fmt::print(stderr, "earthshine: {}: {} %\n", title_, int(fraction * 100.0));
        lastTenth_ = tenth;
        drawn_ = true;
        return;
    }
    if (drawn_ && now - lastDrawn_ < kRedraw) return;
    const int full = int(fraction * kBarWidth);
    fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3} %\033[K", title_, "", full, "", kBarWidth - full,
               int(fraction * 100.0));
    std::fflush(stderr);
    lastDrawn_ = now;
    drawn_ = barOnScreen = true;
}

}  // namespace earthshine::cli
