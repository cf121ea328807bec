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
            // The ends as the setting's own type has them; a NaN is in no range.
            if (!(number >= double(Value(info.min)) && number <= double(Value(info.max))))
                throw UsageError(fmt::format("{}: {} is not in [{}; {}]{}{}", info.name, number, info.min, info.max,
                                             *info.unit ? " " : "", info.unit));
        }
    });
    if ((settings.rsmMinify & (settings.rsmMinify - 1)) != 0)
        throw UsageError(fmt::format("rsm-minify: {} is not 1, 2, 4 or 8", settings.rsmMinify));
}

}  // namespace earthshine
