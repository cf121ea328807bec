#pragma once
// The tuning table: which lanes, storage and group size a device gets. bench/README.md has the measurements behind it.

#include "earthshine/device.hpp"

namespace earthshine {

/// The defaults for a device, from its type, its driver and its native float width.
Tuning defaultTuning(const DeviceCaps& caps);

/// The defaults with what `options` asks for instead. Throws UsageError for values that do not exist.
Tuning tuningFor(const DeviceCaps& caps, const DeviceOptions& options);

/// "image" or "planar".
const char* storageName(Storage storage);

}  // namespace earthshine
