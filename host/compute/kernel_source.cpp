#include "compute/kernel_source.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <fstream>
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
