#pragma once
// What every benchmark shares.

#include <functional>
#include <string>

#include "earthshine/device.hpp"

namespace earthshine::bench {

/// A way to build kernels that a benchmark compares.
struct Variant {
    std::string name;  ///< "tuned", "naive"
    DeviceOptions options;
};

/// Tuned: the device's defaults. Naive: one pixel a work-item, images, the RSM's three maps: as such kernels are
/// usually written.
const Variant& tuned();
const Variant& naive();

/// The device that --device chose.
const DeviceCaps& chosenDevice();

void registerLowerResolution();
void registerDenoiser();
void registerRsmGather();

}  // namespace earthshine::bench
