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

/// An open device and the line on why it is this one.
struct ChosenDevice {
    Device device;
    std::string why;
};

/// Selects and opens the device, and logs the choice. Throws as selectDevice and Device.
ChosenDevice chooseDevice(const DeviceArguments& arguments);

}  // namespace earthshine::cli
