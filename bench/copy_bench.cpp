// What the roof is made of, as rows: a copy of a picture's three numbers a pixel, which a cache may hold, by a kernel
// and by the driver. Beside a stage's row of the same size they say what the caches are worth.

#include <memory>

#include "benches.hpp"
#include "compute/surface.hpp"
#include "own_kernel.hpp"
#include "row.hpp"
#include "run_options.hpp"

namespace earthshine::bench {

namespace {

Row byKernel(const Variant& variant, Extent extent) {
    const Device device(runOptions().device, variant.options);
    const Surface from(device, PixelFormat::RGBA32F, extent), to(device, PixelFormat::RGBA32F, extent);
    const auto kernel = std::make_shared<Kernel>(ownKernel(device, "copy_surface"));
    return {.device = device,
            .run = launches(device,
                            [=] {
                                kernel->set("inSurface", from).set("outSurface", to);
                                kernel->enqueue(extent);
                            }),
            .work = {.bytes = double(from.sizeBytes() + to.sizeBytes())}};
}

Row byDriver(Extent extent) {
    const Device device(runOptions().device, tuned().options);
    const std::size_t bytes = 12 * std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
    const cl::Buffer from = device.impl().makeBuffer(bytes), to = device.impl().makeBuffer(bytes);
    return {.device = device,
            .run = launches(device, [=] { enqueueCopy(device, from, to, bytes); }),
            .work = {.bytes = 2.0 * double(bytes)}};
}

}  // namespace

void addCopyRows() {
    addRows("copy", usualExtents(), "kernel", byKernel);
    Variant device = tuned();
    device.name = "device";  // no kernel of ours: lanes and storage are nothing to it
    addRows("copy", usualExtents(), "driver", {device}, [](const Variant&, Extent extent) { return byDriver(extent); });
}

}  // namespace earthshine::bench
