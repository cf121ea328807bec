#include "own_kernel.hpp"

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
        impl.record("copy",
                    [&](cl::Event* event) { impl.queue.enqueueCopyBuffer(from, to, 0, 0, bytes, nullptr, event); });
        return 0;
    });
}

}  // namespace earthshine::bench
