#include "compute/quirks.hpp"

namespace earthshine {

bool runsOnLlvmpipe(const DeviceCaps& caps) {
    return caps.name.find("llvmpipe") != std::string::npos;
}

bool emulatesFma(const DeviceCaps& caps) {
    return runsOnLlvmpipe(caps);
}

std::string knownUnusable(const DeviceCaps& caps) {
    // "OpenCL C 1.1 Mesa 22.3.6": clang's OpenCL C of another name keeps the same form.
    const std::string& version = caps.openclCVersion;
    if (version.starts_with("OpenCL C 1.0") || version.starts_with("OpenCL C 1.1"))
        return version + " is older than OpenCL C 1.2";
    return {};
}

bool tellsNoTimes(const cl::Context& context, const cl::CommandQueue& queue) {
    const cl::Buffer buffer(context, CL_MEM_READ_WRITE, 16);
    cl::Event event;
    queue.enqueueFillBuffer(buffer, 0.0f, 0, 16, nullptr, &event);
    event.wait();
    return event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>() == 0;
}

}  // namespace earthshine
