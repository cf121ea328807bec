#include "tune_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string_view>

#include "earthshine/error.hpp"

namespace earthshine::bench {

TuneArguments parseTuneArguments(int argc, char** argv) {
    TuneArguments arguments;
    const auto after = [](std::string_view text, std::string_view name) {
        return text.starts_with(name) ? std::optional(std::string(text.substr(name.size()))) : std::nullopt;
    };
    for (int i = 1; i < argc; ++i) {
        const std::string text = argv[i];
        char rest = 0;
        if (text == "--tune") continue;
        if (text == "--groups-only") {
            arguments.groupsOnly = true;
            continue;
        }
        if (const auto device = after(text, "--device=")) {
            arguments.device = *device;
        } else if (const auto out = after(text, "--out=")) {
            arguments.out = *out;
        } else if (text == "--out" && i + 1 < argc) {
            arguments.out = argv[++i];
        } else if (const auto size = after(text, "--size=")) {
            if (std::sscanf(size->c_str(), "%dx%d%c", &arguments.extent.widthPx, &arguments.extent.heightPx, &rest) !=
                    2 ||
                std::min(arguments.extent.widthPx, arguments.extent.heightPx) < 16 ||
                std::max(arguments.extent.widthPx, arguments.extent.heightPx) > 8192)
                throw UsageError(fmt::format("tune: --size={}: is not WxH of 16 to 8192 pixels", *size));
        } else if (const auto rounds = after(text, "--rounds=")) {
            if (std::sscanf(rounds->c_str(), "%d%c", &arguments.rounds, &rest) != 1 || arguments.rounds < 1 ||
                arguments.rounds > 99)
                throw UsageError(fmt::format("tune: --rounds={}: is not a number from 1 to 99", *rounds));
        } else {
            throw UsageError(fmt::format(
                "tune: '{}' is none of --device=NAME, --size=WxH, --rounds=N, --groups-only, --out FILE", text));
        }
    }
    return arguments;
}

}  // namespace earthshine::bench
