#pragma once
// The ways to build kernels that a row compares.

#include <string>
#include <vector>

#include "earthshine/device.hpp"

namespace earthshine::bench {

struct Variant {
    std::string name;  ///< the last part of a row's name: "tuned", "naive", "lanes16_planar"
    DeviceOptions options;
};

/// The device's defaults.
Variant tuned();
/// One pixel a work-item, images, the RSM's three maps, a launch a pass of the filter: as such kernels are usually
/// written.
Variant naive();
/// Every number of lanes x storage that the device can do.
std::vector<Variant> everyVariant(const DeviceCaps& caps);

/// With packed records, which rsm_pack and rsm_minify write whatever gathers from them.
Variant withRecords(Variant variant);

/// "tuned", "naive", a list of both with a comma, or "all", which has these two and every other; "" is tuned and, where
/// there are images, naive. Throws UsageError.
std::vector<Variant> parseVariants(const std::string& text, const DeviceCaps& caps);

}  // namespace earthshine::bench
