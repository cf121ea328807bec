#include "result_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

#include "earthshine/error.hpp"
#include "row_name.hpp"

namespace earthshine::bench {

namespace {

using Json = nlohmann::json;

// Google Benchmark writes NaN and Infinity, which are not JSON, where a spread is 0 / 0. Numbers of their length in
// their place: a time that is 0 is refused, and the rest is not looked at.
void replaceNonFinite(std::string& text) {
    for (const auto& [token, number] : {std::pair{"NaN", "0.0"}, std::pair{"Infinity", "0.000000"}})
        for (const char* before : {"\": ", "\": -"}) {
            const std::string wanted = std::string(before) + token;
            for (auto at = text.find(wanted); at != std::string::npos; at = text.find(wanted, at))
                text.replace(at, wanted.size(), std::string(before) + number);
        }
}

Json parse(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(path + ": cannot be read");
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    replaceNonFinite(bytes);
    try {
        return Json::parse(bytes);
    } catch (const Json::parse_error& error) {
        throw InputError(fmt::format("{}: is not JSON: wrong or cut off at byte {}", path, error.byte));
    }
}

std::string text(const Json& object, const char* key) {
    const auto value = object.find(key);
    return value != object.end() && value->is_string() ? value->get<std::string>() : std::string();
}

void addRow(ResultFile& file, const std::string& where, const Json& row) {
    if (!row.is_object()) throw InputError(where + "is not an object");
    const std::string name = rowName(text(row, "name"));
    if (name.empty()) throw InputError(where + "has no name");
    if (text(row, "run_type") == "aggregate") return;  // of repetitions that the file lists as well
    const auto failed = row.find("error_occurred");
    if (failed != row.end() && *failed == true) {
        file.failedRows.push_back(name);
        return;
    }
    const auto median = row.find("median_ms");
    if (median == row.end() || !median->is_number())
        throw InputError(fmt::format("{}{}: has no median_ms; earthshine_bench writes one", where, name));
    const double ms = median->get<double>();
    if (!(ms > 0.0) || !std::isfinite(ms))
        throw InputError(fmt::format("{}{}: median_ms is {}, must be > 0", where, name, ms));
    file.rows[name].push_back(ms);
}

}  // namespace

ResultFile readResultFile(const std::string& path) {
    const Json json = parse(path);
    const auto context = json.is_object() ? json.find("context") : json.end();
    const auto rows = json.is_object() ? json.find("benchmarks") : json.end();
    if (context == json.end() || !context->is_object() || rows == json.end() || !rows->is_array())
        throw InputError(path + ": is not of earthshine_bench --benchmark_out: no \"context\" or no \"benchmarks\"");
    ResultFile file;
    file.device = text(*context, "device");
    file.revision = text(*context, "revision");
    if (file.device.empty()) throw InputError(path + ": context: names no device");
    for (std::size_t i = 0; i < rows->size(); ++i)
        addRow(file, fmt::format("{}: benchmarks[{}]: ", path, i), (*rows)[i]);
    if (file.rows.empty())
        throw InputError(path +
                         ": holds no row that ran; if the run had --benchmark_report_aggregates_only, leave that out");
    return file;
}

}  // namespace earthshine::bench
