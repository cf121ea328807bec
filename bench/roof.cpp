#include "roof.hpp"

#include <functional>

#include "compute/surface.hpp"
#include "flops.hpp"
#include "own_kernel.hpp"
#include "row.hpp"

namespace earthshine::bench {

namespace {

constexpr double kSeconds = 0.4;

// The best of some launches, in seconds: what a roof is for is what nothing goes above.
double bestSeconds(const std::function<std::vector<StageTime>()>& run, double seconds) {
    run();  // compiles
    double best = 1e30, spent = 0.0;
    for (int i = 0; i < 5 || spent < seconds; ++i) {
        const double one = 1e-3 * std::max(run().at(0).ms, 1e-6);
        best = std::min(best, one);
        spent += one;
    }
    return best;
}

// Some four times any cache there is, and far less than the memory there is: 200 to 270 MB to read, as much to write.
Extent beyondCaches(const DeviceCaps& caps) {
    constexpr std::size_t kBytesPerPixel = 16;
    Extent extent{4096, 4096};
    const std::size_t most = std::min(caps.maxAllocationBytes / 2, caps.globalMemoryBytes / 8);
    while (extent.heightPx > 256 && kBytesPerPixel * std::size_t(extent.widthPx) * std::size_t(extent.heightPx) > most)
        extent.heightPx /= 2;
    return extent;
}

double kernelCopyGBs(const Device& device, Extent extent) {
    const Surface from(device, PixelFormat::RGBA32F, extent), to(device, PixelFormat::RGBA32F, extent);
    Kernel kernel = ownKernel(device, "copy_surface");
    const auto run = launches(device, [&] {
        kernel.set("inSurface", from).set("outSurface", to);
        kernel.enqueue(extent);
    });
    return 1e-9 * double(from.sizeBytes() + to.sizeBytes()) / bestSeconds(run, kSeconds);
}

double bufferCopyGBs(const Device& device, Extent extent) {
    Device::Impl& impl = device.impl();
    const std::size_t bytes = 16 * std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
    const cl::Buffer from = impl.makeBuffer(bytes), to = impl.makeBuffer(bytes);
    impl.checked("filling a buffer", [&] { return impl.queue.enqueueFillBuffer(from, 0.0f, 0, bytes); });
    const auto run = launches(device, [&] { enqueueCopy(device, from, to, bytes); });
    return 2e-9 * double(bytes) / bestSeconds(run, kSeconds);
}

double fmaGflops(const Device& device) {
    constexpr int kChains = 12;      // fma_rate.cl
    constexpr double kLongMs = 3.0;  // longer than what starting takes, shorter than a turn of another program's
    const int columns = 1024, rows = 2 * std::max(device.caps().computeUnits, 1);
    const int items = columns * rows;
    Kernel kernel = ownKernel(device, "fma_rate");
    const cl::Buffer sums = device.impl().makeBuffer(sizeof(float) * std::size_t(items));  // arguments do not keep it
    kernel.set("outSums", sums);
    kernel.setParams("itemCount", items).setParams("factor", 0.875f).setParams("addend", 0.125f);
    int steps = 256;
    const auto run = launches(device, [&] {
        kernel.setParams("steps", steps);
        kernel.enqueueItems(std::size_t(columns), std::size_t(rows));
    });
    run();
    while (run().at(0).ms < kLongMs && steps < (1 << 20)) steps *= 2;
    const double flops = kFma * kChains * double(steps) * double(items) * device.tuning().lanes;
    return 1e-9 * flops / bestSeconds(run, kSeconds);
}

}  // namespace

Roof measureRoof(const DeviceCaps& caps) {
    const Device device(caps, tuned().options);
    const Extent extent = beyondCaches(caps);
    return {kernelCopyGBs(device, extent), bufferCopyGBs(device, extent), fmaGflops(device)};
}

}  // namespace earthshine::bench
