#pragma once
// What drivers do that they should not, one place for all of it; each with the version where it was last seen.

#include <string>

#include "compute/cl.hpp"
#include "earthshine/device.hpp"

namespace earthshine {

/// Mesa's rusticl over its software rasteriser: calls itself a CPU with a native width of 1 or more, runs images fast.
bool runsOnLlvmpipe(const DeviceCaps& caps);

/// Why a device that opens cannot be used all the same; "" if it can.
///   Clover (Mesa <= 24) lists devices of OpenCL C 1.1: our kernels need 1.2.
std::string knownUnusable(const DeviceCaps& caps);

/// fma() is many instructions although the device claims it: llvmpipe (Mesa 22.3) computes it in integers.
bool emulatesFma(const DeviceCaps& caps);

/// A profiling queue's events tell no times, only 0, 1, 2, 3: rusticl (Mesa 22.3).
bool tellsNoTimes(const cl::Context& context, const cl::CommandQueue& queue);

}  // namespace earthshine
