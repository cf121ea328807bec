#pragma once
// The command line as the subcommands see it. CLI11, which takes long to compile, stays behind this door, and every
// option is refused in the same words: `--name: what is wrong`.

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "earthshine/image.hpp"

namespace earthshine::cli {

/// Reads the text after an option; throws UsageError, without the option's name, if it makes no sense.
using Parse = std::function<void(const std::string& text)>;

/// The options of one command. Values are given to variables of the caller, which must outlive parse().
class Options {
public:
    struct Impl;
    explicit Options(Impl* impl) : impl_(impl) {}

    /// A command of its own name; `run` is called by Program::run if the command line asks for it.
    Options command(const std::string& name, const std::string& help, std::function<void()> run);

    /// A word without dashes that must be there.
    void positional(const std::string& name, std::string& value, const std::string& help);

    /// `names` is "-o,--out"; `valueName` stands for the value in the help ("WxH"); `defaultText` is shown there.
    void option(const std::string& names, const std::string& valueName, const std::string& defaultText,
                const std::string& help, Parse parse, bool required = false);
    void text(const std::string& names, const std::string& valueName, std::string& value, const std::string& help,
              bool required = false);
    void onOff(const std::string& names, bool& value, const std::string& help);
    void flag(const std::string& names, bool& value, const std::string& help);

    /// Options added from here on stand under this heading in the help.
    void group(const std::string& heading) { group_ = heading; }

private:
    Impl* impl_;
    std::string group_;
};

/// The whole command line.
class Program {
public:
    Program(const std::string& name, const std::string& version, const std::string& description);
    ~Program();

    Options& options() { return options_; }

    /// Reads the arguments. False if they asked for --help or --version, which it printed. Throws UsageError.
    bool parse(int argc, const char* const* argv);

    /// Runs the command that was asked for.
    void run() const;

private:
    std::string remaining() const;  ///< the first argument that nothing takes

    std::unique_ptr<Options::Impl> impl_;
    Options options_;
};

/// A whole number, or a number, in [min; max]; nothing may follow it. Throws UsageError.
int parseInt(const std::string& text, double min, double max, const std::string& unit = "");
float parseFloat(const std::string& text, double min, double max, const std::string& unit = "");

/// "640x480" as an extent of at least 1 and at most `maxPx` a side. Throws UsageError.
Extent parseExtent(const std::string& text, int maxPx);

/// The parts between commas; blanks around them are dropped.
std::vector<std::string> splitCommas(const std::string& text);

/// Where `text` is among `names`. Throws UsageError naming them all.
int parseChoice(const std::string& text, std::span<const char* const> names);

}  // namespace earthshine::cli
