#include "cli/options.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "earthshine/error.hpp"

namespace earthshine::cli {

struct Options::Impl {
    CLI::App* app = nullptr;
    std::unique_ptr<CLI::App> owned;  ///< of the program
    std::function<void()> run;        ///< of a command
    std::vector<std::unique_ptr<Options::Impl>> commands;
};

namespace {

/// Puts the option's name before what `parse` complains of.
CLI::callback_t guarded(const std::string& names, Parse parse) {
    const std::string name = names.substr(names.find_last_of(',') + 1);
    return [name, parse = std::move(parse)](const CLI::results_t& values) {
        try {
            parse(values.back());
        } catch (const Error& e) {
            throw UsageError(fmt::format("{}: {}", name, e.what()));
        }
        return true;
    };
}

template <class Number>
Number parseNumber(const std::string& text, double min, double max, const std::string& unit, const char* kind) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range ||
        (error == std::errc() && end == text.data() + text.size() && !(double(value) >= min && double(value) <= max)))
        throw UsageError(fmt::format("{} is not in [{}; {}]{}{}", text, min, max, unit.empty() ? "" : " ", unit));
    if (error != std::errc() || end != text.data() + text.size())
        throw UsageError(fmt::format("'{}' is not a {}", text, kind));
    return value;
}

std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

}  // namespace

Options Options::command(const std::string& name, const std::string& help, std::function<void()> run) {
    auto& command = impl_->commands.emplace_back(std::make_unique<Impl>());
    command->app = impl_->app->add_subcommand(name, help);
    command->app->fallthrough();  // so that --verbose may stand at the end
    command->run = std::move(run);
    return Options(command.get());
}

void Options::positional(const std::string& name, std::string& value, const std::string& help) {
    impl_->app->add_option(name, value, help)->required()->type_name("");
}

void Options::option(const std::string& names, const std::string& valueName, const std::string& defaultText,
                     const std::string& help, Parse parse, bool required) {
    CLI::Option* option = impl_->app->add_option(names, guarded(names, std::move(parse)), help);
    option->type_name(valueName)->type_size(1)->required(required);
    option->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    if (!defaultText.empty()) option->default_str(defaultText);
    if (!group_.empty()) option->group(group_);
}

void Options::text(const std::string& names, const std::string& valueName, std::string& value, const std::string& help,
                   bool required) {
    option(
        names, valueName, value, help,
        [&value](const std::string& given) {
            if (given.empty()) throw UsageError("must not be empty");
            value = given;
        },
        required);
}

void Options::onOff(const std::string& names, bool& value, const std::string& help) {
    static constexpr const char* kNames[] = {"off", "on"};
    option(names, "on|off", kNames[value], help,
           [&value](const std::string& text) { value = parseChoice(text, kNames) == 1; });
}

void Options::flag(const std::string& names, bool& value, const std::string& help) {
    CLI::Option* option = impl_->app->add_flag(names, value, help);
    if (!group_.empty()) option->group(group_);
}

Program::Program(const std::string& name, const std::string& version, const std::string& description)
    : impl_(std::make_unique<Options::Impl>()), options_(impl_.get()) {
    impl_->owned = std::make_unique<CLI::App>(description, name);
    impl_->app = impl_->owned.get();
    impl_->app->set_version_flag("--version", name + " " + version, "Print the version and exit");
    impl_->app->set_help_flag("-h,--help", "Print this help and exit");
    impl_->app->require_subcommand(1);
    impl_->app->get_formatter()->column_width(34);
}

Program::~Program() = default;

bool Program::parse(int argc, const char* const* argv) {
    try {
        impl_->app->parse(argc, argv);
    } catch (const CLI::Success& e) {  // --help and --version
        impl_->app->exit(e);
        return false;
    } catch (const CLI::ExtrasError&) {
        throw UsageError(fmt::format("there is no option or place for '{}'; see --help", remaining()));
    } catch (const CLI::ArgumentMismatch&
                 e) {  // "--out: At Most 1 required but received 2", "--out: 1 required FILE missing"
        const std::string text = e.what();
        throw UsageError(
            fmt::format("{}: {}", text.substr(0, text.find(':')),
                        text.find("At Most") == std::string::npos ? "needs a value" : "given more than once"));
    } catch (const CLI::RequiredError& e) {
        if (!remaining().empty()) throw UsageError(fmt::format("there is no command '{}'; see --help", remaining()));
        throw UsageError(fmt::format("{}; see --help", oneLine(e.what())));
    } catch (const CLI::ParseError& e) {
        throw UsageError(oneLine(e.what()));
    }
    return true;
}

std::string Program::remaining() const {
    const std::vector<std::string> words = impl_->app->remaining(true);
    return words.empty() ? "" : words.front();
}

void Program::run() const {
    for (const auto& command : impl_->commands)
        if (command->app->parsed()) command->run();
}

int parseInt(const std::string& text, double min, double max, const std::string& unit) {
    return parseNumber<int>(text, min, max, unit, "whole number");
}

float parseFloat(const std::string& text, double min, double max, const std::string& unit) {
    return parseNumber<float>(text, min, max, unit, "number");
}

Extent parseExtent(const std::string& text, int maxPx) {
    const auto cross = text.find('x');
    if (cross == std::string::npos) throw UsageError(fmt::format("'{}' is not WIDTHxHEIGHT, as in 1280x720", text));
    return {parseInt(text.substr(0, cross), 1, maxPx, "px"), parseInt(text.substr(cross + 1), 1, maxPx, "px")};
}

std::vector<std::string> splitCommas(const std::string& text) {
    std::vector<std::string> parts;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t to = std::min(text.find(',', from), text.size());
        std::string part = text.substr(from, to - from);
        part.erase(0, std::min(part.find_first_not_of(' '), part.size()));
        part.erase(part.find_last_not_of(' ') + 1);
        parts.push_back(std::move(part));
        from = to + 1;
    }
    return parts;
}

int parseChoice(const std::string& text, std::span<const char* const> names) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) throw UsageError(fmt::format("'{}' is none of {}", text, fmt::join(names, ", ")));
    return int(found - names.begin());
}

}  // namespace earthshine::cli
