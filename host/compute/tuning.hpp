#pragma once
// From the tuning table to a device: which lanes, storage and group sizes it gets.

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "earthshine/device.hpp"

namespace earthshine {

/// What the table (tuning_table.hpp; with the rows of `file`, "" = $EARTHSHINE_TUNING) says of a device, within what
/// the device can do. Throws InputError for a file that is no table.
Tuning defaultTuning(const DeviceCaps& caps, const std::string& file = {});

/// The same with what `options` asks for instead. Throws UsageError for values that do not exist.
Tuning tuningFor(const DeviceCaps& caps, const DeviceOptions& options);

/// Work-items a group of one kernel, x and y.
std::array<int, 2> localSizeOf(const Tuning& tuning, const std::string& kernel);

/// How text says it, in the order of Storage.
inline constexpr const char* kStorageNames[] = {"image", "planar", "packed"};
const char* storageName(Storage storage);
/// Nothing for a name of none.
std::optional<Storage> storageOf(std::string_view name);

}  // namespace earthshine
