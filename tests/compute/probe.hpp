#pragma once
// Small kernels of the tests' own (tests/compute/kernels), built like those of the library, and buffers for them.

#include <string>
#include <vector>

#include "compute/kernel.hpp"
#include "reference/device_variants.hpp"

namespace earthshine::test {

/// A folder with the library's kernels and the probes; stays until the program ends.
std::string probeFolder();

/// The device of a variant, with probes among its kernels.
Device openWithProbes(const reference::Variant& variant);

/// One variant a device and number of lanes: for what does not touch a surface.
std::vector<reference::Variant> laneVariants();

/// One variant a device, number of lanes and storage.
std::vector<reference::Variant> storageVariants();

template <class T>
cl::Buffer upload(const Device& device, const std::vector<T>& values) {
    cl::Buffer buffer = device.impl().makeBuffer(values.size() * sizeof(T));
    device.impl().queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
    return buffer;
}

template <class T>
std::vector<T> download(const Device& device, const cl::Buffer& buffer, std::size_t count) {
    std::vector<T> values(count);
    device.impl().queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
    return values;
}

}  // namespace earthshine::test
