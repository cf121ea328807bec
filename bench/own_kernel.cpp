#include "own_kernel.hpp"

#include "earthshine/error.hpp"

namespace earthshine::bench {

Kernel ownKernel(const Device& device, const std::string& name) {
    for (const KernelText* text = kBenchKernelTexts; text->name; ++text)
        if (name + ".cl" == text->name) return Kernel(device, name, text->text);
    throw InputError(name + ".cl: no kernel of that name in the benchmark");
}

}  // namespace earthshine::bench
