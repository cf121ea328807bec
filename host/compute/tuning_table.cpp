#include "compute/tuning_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "compute/kernel_source.hpp"
#include "compute/tuning.hpp"
#include "earthshine/error.hpp"

namespace earthshine {

// CPUs: vectors as wide as the registers, whole cache lines of planes, and groups as wide as a row of a picture: a
// thread walks along rows, whose memory comes in ahead of it; unpack reads rows of the host's memory, one at a time.
// llvmpipe vectorises across work-items by itself, and its texture unit is its fast path. bench/README.md has the
// measurements.
const char kShippedTuning[] = R"(
# scope    pattern                   kernel              lanes   storage  group
device     llvmpipe                  *                   1       image    8x8
type       CPU                       *                   native  planar   128x4
type       CPU                       unpack              -       -        64x1
vendor     NVIDIA                    *                   1       packed   16x8
default    *                         *                   1       image    16x8
)";

namespace {

constexpr const char* kScopes[] = {"device", "platform", "vendor", "type", "default"};

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

// Words between spaces; a word in quotes may hold spaces. A # outside of quotes ends the line.
std::vector<std::string> wordsOf(const std::string& line) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at < line.size();) {
        if (std::isspace(static_cast<unsigned char>(line[at]))) {
            ++at;
        } else if (line[at] == '#') {
            break;
        } else if (line[at] == '"') {
            const std::size_t end = std::min(line.find('"', at + 1), line.size());
            words.push_back(line.substr(at + 1, end - at - 1));
            at = end + 1;
        } else {
            const std::size_t end = std::min(line.find_first_of(" \t\r\"#", at), line.size());
            words.push_back(line.substr(at, end - at));
            at = end;
        }
    }
    return words;
}

bool isKernel(const std::string& name) {
    for (const KernelText* text = kKernelTexts; text->name; ++text)
        if (name + ".cl" == text->name) return true;
    return false;
}

int numberOf(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? value : -1;
}

// What is wrong with the words, or "" and the row.
std::string readRow(const std::vector<std::string>& words, TuningRow& row) {
    constexpr std::size_t kColumns = 6;
    if (words.size() != kColumns)
        return fmt::format("{} columns, must be {}: scope pattern kernel lanes storage group", words.size(), kColumns);
    const std::string &scope = words[0], &pattern = words[1], &kernel = words[2], &lanes = words[3],
                      &storage = words[4], &group = words[5];
    const auto* const found = std::find(std::begin(kScopes), std::end(kScopes), scope);
    if (found == std::end(kScopes)) return fmt::format("scope '{}' is none of {}", scope, fmt::join(kScopes, ", "));
    row.scope = TuningScope(found - std::begin(kScopes));
    if ((row.scope == TuningScope::Default) != (pattern == "*"))
        return fmt::format("pattern '{}': the scope default has *, and every other one a name", pattern);
    row.pattern = pattern == "*" ? "" : pattern;
    row.kernel = kernel == "*" ? "" : kernel;
    if (!row.kernel.empty() && !isKernel(kernel)) return fmt::format("there is no kernel '{}'", kernel);
    if (!row.kernel.empty() && (lanes != "-" || storage != "-"))
        return fmt::format("lanes and storage are those of all kernels: {}'s own row has - there", kernel);
    row.lanes = lanes == "-" ? 0 : lanes == "native" ? TuningRow::kNativeLanes : numberOf(lanes);
    if (lanes != "-" && lanes != "native" && row.lanes != 1 && row.lanes != 4 && row.lanes != 8 && row.lanes != 16)
        return fmt::format("lanes '{}' is none of 1, 4, 8, 16, native, -", lanes);
    if (storage != "-" && !storageOf(storage))
        return fmt::format("storage '{}' is none of {}, -", storage, fmt::join(kStorageNames, ", "));
    row.storage = storage == "-" ? "" : storage;
    if (group == "-") return {};
    const std::size_t cross = std::min(group.find('x'), group.size());
    for (int i = 0; i < 2; ++i)
        row.localSizePx[i] = numberOf(std::string_view(group).substr(i == 0 ? 0 : std::min(cross + 1, group.size()),
                                                                     i == 0 ? cross : group.npos));
    constexpr int kMost = 4096;  // work-items a side: more than any device takes
    if (row.localSizePx[0] < 1 || row.localSizePx[1] < 1 || std::max(row.localSizePx[0], row.localSizePx[1]) > kMost)
        return fmt::format("group '{}' is neither - nor WxH of 1 to {} work-items", group, kMost);
    return {};
}

bool fits(const TuningRow& row, const DeviceCaps& caps) {
    const std::string pattern = lowered(row.pattern);
    const auto holds = [&](const std::string& name) { return lowered(name).find(pattern) != std::string::npos; };
    switch (row.scope) {
        case TuningScope::Device:
            return holds(caps.name);
        case TuningScope::Platform:
            return holds(caps.platformName);
        case TuningScope::Vendor:
            return holds(caps.vendor);
        case TuningScope::Type:
            return lowered(caps.type) == pattern;
        case TuningScope::Default:
            return true;
    }
    return false;
}

}  // namespace

std::vector<TuningRow> parseTuning(std::istream& lines, const std::string& source) {
    std::vector<TuningRow> rows;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::vector<std::string> words = wordsOf(line);
        if (words.empty()) continue;
        TuningRow row;
        row.source = source;
        if (const std::string fault = readRow(words, row); !fault.empty())
            throw InputError(fmt::format("{}:{}: {}", source, number, fault));
        rows.push_back(std::move(row));
    }
    if (lines.bad()) throw InputError(source + ": cannot be read");  // a folder, for one
    std::stable_sort(rows.begin(), rows.end(), [](const TuningRow& a, const TuningRow& b) {
        return a.scope != b.scope ? a.scope < b.scope : a.kernel.empty() < b.kernel.empty();
    });
    return rows;
}

std::vector<TuningRow> tuningRows(const std::string& file) {
    std::string path = file;
    if (path.empty())
        if (const char* own = std::getenv("EARTHSHINE_TUNING")) path = own;
    std::vector<TuningRow> rows;
    if (!path.empty()) {
        std::ifstream in(path);
        if (!in) throw InputError(path + ": cannot be opened as a tuning table");
        rows = parseTuning(in, path);
    }
    std::istringstream shipped(kShippedTuning);
    for (TuningRow& row : parseTuning(shipped, "shipped table")) rows.push_back(std::move(row));
    return rows;
}

Tuning lookUpTuning(const std::vector<TuningRow>& rows, const DeviceCaps& caps) {
    std::vector<const TuningRow*> fitting;
    for (const TuningRow& row : rows)
        if (fits(row, caps)) fitting.push_back(&row);
    Tuning tuning;
    const auto first = [&](const auto& has) {
        const auto at = std::find_if(fitting.begin(), fitting.end(), [&](const TuningRow* row) { return has(*row); });
        return at == fitting.end() ? nullptr : *at;
    };
    if (const TuningRow* row = first([](const TuningRow& r) { return r.lanes != 0; })) {
        const int width = caps.nativeFloatWidth;
        tuning.lanes = row->lanes != TuningRow::kNativeLanes ? row->lanes : width >= 16 ? 16 : width >= 8 ? 8 : 4;
    }
    if (const TuningRow* row = first([](const TuningRow& r) { return !r.storage.empty(); })) {
        tuning.storage = *storageOf(row->storage);
        tuning.reason = fmt::format("{}, {}{}{}", row->source, kScopes[int(row->scope)],
                                    row->pattern.empty() ? "" : " ", row->pattern);
    }
    const auto groupOf = [&](const std::string& kernel) {
        return first(
            [&](const TuningRow& r) { return r.localSizePx[0] > 0 && (r.kernel.empty() || r.kernel == kernel); });
    };
    if (const TuningRow* all = groupOf("")) std::copy_n(all->localSizePx, 2, tuning.localSizePx);
    for (const TuningRow* own : fitting) {
        // Its own row decides only where no row of all kernels goes before it.
        if (own->kernel.empty() || groupOf(own->kernel) != own) continue;
        tuning.groups.push_back({own->kernel, {own->localSizePx[0], own->localSizePx[1]}});
    }
    return tuning;
}

std::string formatTuningRow(const TuningRow& row) {
    const bool hasSpace = row.pattern.find_first_of(" \t#") != std::string::npos;
    const std::string pattern = row.pattern.empty() ? "*" : hasSpace ? '"' + row.pattern + '"' : row.pattern;
    const std::string lanes = row.lanes == 0                         ? "-"
                              : row.lanes == TuningRow::kNativeLanes ? "native"
                                                                     : fmt::format("{}", row.lanes);
    const std::string group =
        row.localSizePx[0] == 0 ? "-" : fmt::format("{}x{}", row.localSizePx[0], row.localSizePx[1]);
    return fmt::format("{:<10} {:<25} {:<19} {:<7} {:<8} {}", kScopes[int(row.scope)], pattern,
                       row.kernel.empty() ? "*" : row.kernel, lanes, row.storage.empty() ? "-" : row.storage, group);
}

std::string tuningHeading() {
    return fmt::format("{:<10} {:<25} {:<19} {:<7} {:<8} {}", "# scope", "pattern", "kernel", "lanes", "storage",
                       "group");
}

}  // namespace earthshine
