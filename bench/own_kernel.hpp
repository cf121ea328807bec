#pragma once
// The benchmark's own kernels, kept inside the program as the library keeps its own.

#include "compute/kernel.hpp"
#include "compute/kernel_source.hpp"

namespace earthshine {

/// bench/kernels/*.cl, closed by {nullptr, nullptr}. Generated (kernels/embed.cmake).
extern const KernelText kBenchKernelTexts[];

namespace bench {

/// Builds bench/kernels/NAME.cl.
Kernel ownKernel(const Device& device, const std::string& name);

/// The driver's clEnqueueCopyBuffer, as a launch that is timed like a kernel's.
void enqueueCopy(const Device& device, const cl::Buffer& from, const cl::Buffer& to, std::size_t bytes);

}  // namespace bench
}  // namespace earthshine
