#include "earthshine/settings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>

#include "earthshine/error.hpp"

namespace earthshine {

void validate(const Settings& settings) {
    forEachSetting(settings, [](const SettingInfo& info, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, int> || std::is_same_v<Value, float>) {
            const auto number = double(value);
            if (!(number >= info.min && number <= info.max))  // a NaN is in no range
                throw UsageError(fmt::format("{}: {} is not in [{}; {}]{}{}", info.name, number, info.min, info.max,
                                             *info.unit ? " " : "", info.unit));
        }
    });
}

}  // namespace earthshine
