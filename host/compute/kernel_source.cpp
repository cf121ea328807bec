#include "compute/kernel_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <set>
#include <sstream>

#include "earthshine/error.hpp"

namespace earthshine {

namespace {

std::string readText(const std::string& file, const std::string& folder, const std::string& includedFrom) {
    if (folder.empty()) {
        for (const KernelText* text = kKernelTexts; text->name; ++text)
            if (file == text->name) return text->text;
    } else {
        for (const char* sub : {".", "common", "shared"}) {
            std::ifstream in(std::filesystem::path(folder) / sub / file, std::ios::binary);
            if (in) return {std::istreambuf_iterator<char>(in), {}};
        }
    }
    throw InputError(fmt::format("{}: no kernel source of that name {}", includedFrom + file,
                                 folder.empty() ? "in the library" : "under " + folder));
}

void expandInto(std::string& out, const std::string& file, const std::string& text, const std::string& folder,
                std::set<std::string>& seen) {
    std::istringstream lines(text);
    out += fmt::format("#line 1 \"{}\"\n", file);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        constexpr std::string_view kInclude = "#include \"";
        if (line.starts_with(kInclude)) {
            const auto end = line.find('"', kInclude.size());
            if (end == std::string::npos) throw InputError(fmt::format("{}:{}: #include without an end", file, number));
            const std::string included = line.substr(kInclude.size(), end - kInclude.size());
            if (seen.insert(included).second)
                expandInto(out, included, readText(included, folder, fmt::format("{}:{}: ", file, number)), folder,
                           seen);
            out += fmt::format("#line {} \"{}\"\n", number + 1, file);
        } else {
            out += line;
            out += '\n';
        }
    }
}

// The text between the '(' at `open` and its partner.
std::string_view parenthesised(std::string_view text, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < text.size(); ++i) {
        if (text[i] == '(') ++depth;
        if (text[i] == ')' && --depth == 0) return text.substr(open + 1, i - open - 1);
    }
    return {};
}

std::string lastIdentifier(std::string_view text) {
    const auto isName = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    std::size_t end = text.size();
    while (end > 0 && !isName(text[end - 1])) --end;
    std::size_t begin = end;
    while (begin > 0 && isName(text[begin - 1])) --begin;
    return std::string(text.substr(begin, end - begin));
}

}  // namespace

std::string expandKernel(const std::string& file, const std::string& folder) {
    return expandKernelText(file, readText(file, folder, ""), folder);
}

std::string expandKernelText(const std::string& file, const std::string& text, const std::string& folder) {
    std::string out;
    std::set<std::string> seen{file};
    expandInto(out, file, text, folder, seen);
    return out;
}

std::string withFilesAndLines(const std::string& log, const std::string& expandedText) {
    std::vector<std::string> places;  // of each line of the text
    std::istringstream lines(expandedText);
    std::string file = "<kernel>", text;
    for (int next = 1; std::getline(lines, text); ++next) {
        places.push_back(fmt::format("{}:{}:", file, next));
        if (std::istringstream mark(text); text.starts_with("#line ")) {
            mark.ignore(6) >> next >> std::quoted(file);
            --next;
        }
    }
    constexpr std::string_view kWhole = "<kernel>:";
    std::string named;
    std::size_t done = 0;
    for (std::size_t at = log.find(kWhole); at != std::string::npos; at = log.find(kWhole, done)) {
        const std::size_t number = at + kWhole.size(), colon = log.find_first_not_of("0123456789", number);
        std::size_t line = 0;
        std::from_chars(log.data() + number, log.data() + std::min(colon, log.size()), line);
        const bool isPlace = colon < log.size() && log[colon] == ':' && line >= 1 && line <= places.size();
        named += log.substr(done, at - done) + (isPlace ? places[line - 1] : std::string(kWhole));
        done = isPlace ? colon + 1 : number;
    }
    return named + log.substr(done);
}

std::vector<std::string> argumentNames(const std::string& text, const std::string& name, bool rsmRecords) {
    const std::string head = "__kernel void " + name + "(";
    const auto at = text.find(head);
    if (at == std::string::npos) throw InputError(fmt::format("{}.cl: holds no '{}'", name, head));
    const std::string_view list = parenthesised(text, at + head.size() - 1);

    std::vector<std::string> names;
    const auto addSurface = [&](const std::string& surface) {
        names.push_back(surface);
        names.push_back(surface + "Layout");
    };
    int depth = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= list.size(); ++i) {
        if (i < list.size() && list[i] == '(') ++depth;
        if (i < list.size() && list[i] == ')') --depth;
        if (i < list.size() && (list[i] != ',' || depth > 0)) continue;
        const std::string_view argument = list.substr(begin, i - begin);
        begin = i + 1;
        const std::string identifier = lastIdentifier(argument);
        if (argument.find("SURFACE_") != std::string_view::npos) {
            addSurface(identifier);
        } else if (argument.find("RSM_IN") != std::string_view::npos && !rsmRecords) {
            for (const char* map : {"Depth", "NormalWs", "Flux"}) addSurface(identifier + map);
        } else {
            names.push_back(identifier);
        }
    }
    return names;
}

}  // namespace earthshine
