#pragma once
// JSON that people read: lists of plain values stay on one line.

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace earthshine {

/// The value as text, indented by two blanks, keys in their own order; numbers read back to the same bits. Numbers that
/// are not finite become null, and bytes that are not UTF-8 a replacement character.
std::string readableJson(const nlohmann::ordered_json& value);

}  // namespace earthshine
