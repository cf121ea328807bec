#include "own_kernel.hpp"

#include <chrono>
#include <utility>

#include "earthshine/error.hpp"

namespace earthshine::bench {

Kernel ownKernel(const Device& device, const std::string& name) {
    for (const KernelText* text = kBenchKernelTexts; text->name; ++text)
        if (name + ".cl" == text->name) return Kernel(device, name, text->text);
    throw InputError(name + ".cl: no kernel of that name in the benchmark");
}

void enqueueCopy(const Device& device, const cl::Buffer& from, const cl::Buffer& to, std::size_t bytes) {
    Device::Impl& impl = device.impl();
    impl.checked("copying a buffer", [&] {
        Launch launch{"copy", {}};
        if (impl.timesByClock) impl.queue.finish();
        const auto start = std::chrono::steady_clock::now();
        impl.queue.enqueueCopyBuffer(from, to, 0, 0, bytes, nullptr, &launch.event);
        if (impl.timesByClock) {
            impl.queue.finish();
            launch.clockMs =
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        }
        impl.launches.push_back(std::move(launch));
        return 0;
    });
}

}  // namespace earthshine::bench
