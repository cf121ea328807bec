#pragma once
// An open device as compute/, stages/ and pipeline/ see it.

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "compute/cl.hpp"
#include "earthshine/device.hpp"
#include "earthshine/image.hpp"

namespace earthshine {

/// What was launched, for the stage times: filled by Kernel, read and cleared by the pipeline once a frame.
struct Launch {
    std::string kernel;
    cl::Event event;
    double clockMs = 0.0;  ///< by the host's clock, where events tell no time (Device::Impl::timesByClock)

    /// Time on the device; needs DeviceOptions::profiling, and the launch to be over.
    double ms() const {
        if (clockMs > 0.0) return clockMs;
        return 1e-6 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                             event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    }
};

struct Device::Impl {
    DeviceCaps caps;
    DeviceOptions options;
    Tuning tuning;
    std::string cacheFolder;  ///< of compiled programs; "" = none
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;     ///< in order; the only one
    bool timesByClock = false;  ///< profiling, but events tell no time: every launch is waited for and timed here
    std::vector<Launch> launches;
    std::size_t allocatedBytes = 0;  ///< Device::allocatedBytes

    /// Runs `body`; what OpenCL refuses becomes a DeviceError that starts with `what` and names this device.
    template <class Body>
    auto checked(const std::string& what, Body&& body) {
        return clChecked(what, caps.name, body);
    }
    cl::Buffer makeBuffer(std::size_t bytes, cl_mem_flags flags = CL_MEM_READ_WRITE);
    /// A table that kernels read; waits until it is there.
    template <class Element>
    cl::Buffer upload(const std::vector<Element>& elements) {
        const std::size_t bytes = elements.size() * sizeof(Element);
        cl::Buffer buffer = makeBuffer(bytes);
        checked("writing a table",
                [&] { return queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, elements.data()); });
        return buffer;
    }
    /// Runs `enqueue(cl::Event*)`, which enqueues one command, and keeps its time as a launch of this name.
    template <class Enqueue>
    void record(std::string name, Enqueue&& enqueue) {
        Launch launch{std::move(name), {}};
        if (timesByClock) queue.finish();
        const auto start = std::chrono::steady_clock::now();
        enqueue(&launch.event);
        if (timesByClock) {
            queue.finish();
            launch.clockMs =
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        }
        launches.push_back(std::move(launch));
    }
    /// Waits for all that was enqueued.
    void finish() {
        checked("waiting for the frame", [&] { return queue.finish(); });
    }
};

}  // namespace earthshine
