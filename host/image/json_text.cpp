#include "image/json_text.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace earthshine {

namespace {

using Json = nlohmann::ordered_json;

std::string plain(const Json& value) {
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append(std::string& text, const Json& value, const std::string& indent) {
    const bool flat = !value.is_structured() || value.empty() ||
                      (value.is_array() &&
                       std::none_of(value.begin(), value.end(), [](const Json& item) { return item.is_structured(); }));
    if (flat && !value.is_array()) {
        text += plain(value);
        return;
    }
    const std::string inner = indent + "  ";
    text += value.is_array() ? "[" : "{";
    const char* separator = "";
    for (const auto& [key, item] : value.items()) {
        text += separator;
        if (!flat) text += "\n" + inner;
        if (value.is_object()) text += plain(key) + ": ";
        append(text, item, inner);
        separator = flat ? ", " : ",";
    }
    if (!flat) text += "\n" + indent;
    text += value.is_array() ? "]" : "}";
}

}  // namespace

std::string readableJson(const Json& value) {
    std::string text;
    append(text, value, "");
    return text + "\n";
}

}  // namespace earthshine
