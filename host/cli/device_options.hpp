#pragma once
// Which OpenCL device runs the kernels, and how: the same options for every command that computes.

#include <string>

#include "cli/options.hpp"
#include "earthshine/device.hpp"

namespace earthshine::cli {

struct DeviceArguments {
    std::string spec;  ///< as selectDevice takes it
    DeviceOptions options;
};

void addDeviceOptions(Options& options, DeviceArguments& arguments);

/// The device that is meant, and one line on why.
struct DeviceChoice {
    DeviceCaps caps;
    std::string why;
};

/// Throws as selectDevice.
DeviceChoice chooseDevice(const DeviceArguments& arguments);

/// "0: NAME (PLATFORM)"
std::string deviceTitle(const DeviceCaps& caps);

}  // namespace earthshine::cli
