#pragma once
// From the tuning table to a device: which lanes, storage and group sizes it gets.

#include <array>
#include <string>

#include "earthshine/device.hpp"

namespace earthshine {

/// What the table (tuning_table.hpp; with the rows of `file`, "" = $EARTHSHINE_TUNING) says of a device, within what
/// the device can do. Throws InputError for a file that is no table.
Tuning defaultTuning(const DeviceCaps& caps, const std::string& file = {});

/// The same with what `options` asks for instead. Throws UsageError for values that do not exist.
Tuning tuningFor(const DeviceCaps& caps, const DeviceOptions& options);

/// Work-items a group of one kernel, x and y.
std::array<int, 2> localSizeOf(const Tuning& tuning, const std::string& kernel);

/// "image" or "planar".
const char* storageName(Storage storage);

}  // namespace earthshine
