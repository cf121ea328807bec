#pragma once
// Every way that a kernel can be built here: each usable device x LANES x storage. A test that runs through these
// proves that width, storage and driver change nothing but rounding.

#include <ostream>
#include <string>
#include <vector>

#include "earthshine/device.hpp"

namespace earthshine::reference {

struct Variant {
    DeviceCaps caps;
    DeviceOptions options;
    std::string name;  ///< fit for a test's name: "pocl_lanes16_planar"
};

/// What a variant's surfaces round off a number, relative to it, beyond a float's own rounding.
double surfaceRounding(const Variant& variant);

/// How GoogleTest shows one.
inline void PrintTo(const Variant& variant, std::ostream* out) {
    *out << variant.name;
}

/// Devices whose platform or name holds the text of $EARTHSHINE_TEST_DEVICES, or all usable ones without it. Of kernels
/// of several lanes a GPU has those of 4 lanes and planes alone, unless $EARTHSHINE_TEST_EVERY_VARIANT is set: its
/// compiler takes minutes for vectors that it does not run.
std::vector<Variant> allVariants();

/// Those of allVariants() that are quick to build: llvmpipe takes up to ten seconds a process for kernels of several
/// lanes, so that of these there is only one, unless $EARTHSHINE_TEST_EVERY_VARIANT is set.
std::vector<Variant> quickVariants();

/// One variant a device: its own defaults.
std::vector<Variant> defaultVariants();

}  // namespace earthshine::reference
