#pragma once
// Errors of pictures in the words of reports and of people.

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "image/metrics.hpp"

namespace earthshine::cli {

/// Every number of `errors`, under the names of metrics.hpp; what is infinite becomes null in the text.
nlohmann::ordered_json errorsJson(const PictureErrors& errors);

/// A line a number.
std::string errorsTable(const PictureErrors& errors);

}  // namespace earthshine::cli
