// unpack, import_image and interleave: the doors between plain pixels and surfaces.

#include <memory>

#include "benches.hpp"
#include "flops.hpp"
#include "room.hpp"
#include "room_frame.hpp"
#include "row.hpp"
#include "run_options.hpp"
#include "stages/import_image_stage.hpp"
#include "stages/interleave_stage.hpp"
#include "stages/unpack_stage.hpp"

namespace earthshine::bench {

namespace {

// bytes: the host's pixels in, the surface out. Sanitised: min and max a channel; a half is scaled as well.
Row unpack(const Variant& variant, Extent extent, PixelFormat format) {
    const Device device(runOptions().device, variant.options);
    const FrameImages& images = roomFrame(extent, kRsmSizePx);
    const HostImage wide = format == PixelFormat::RGBA32F ? toFloat(images.albedo.view()) : HostImage();
    const ImageView pixels = format == PixelFormat::R32F      ? images.depth.view()
                             : format == PixelFormat::RGBA16F ? images.albedo.view()
                                                              : wide.view();
    const cl::Buffer buffer = device.impl().makeBuffer(pixels.sizeBytes());
    device.impl().queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, pixels.sizeBytes(), pixels.data);
    const Surface surface(device, format, extent);
    const auto stage = std::make_shared<UnpackStage>(device);
    const double perPixel = format == PixelFormat::R32F ? 2 : format == PixelFormat::RGBA16F ? 3 * (2 + 1) : 3 * 2;
    return {.device = device,
            .run = launches(device, [=] { stage->enqueue(buffer, format, extent, surface, 0); }),
            .work = {.bytes = double(pixels.sizeBytes() + surface.sizeBytes()),
                     .flops = perPixel * extent.widthPx * extent.heightPx}};
}

// bytes: the other API's image in, the surface out. Sanitised: min and max a channel.
Row importImage(const Variant& variant, Extent extent) {
    const Device device(runOptions().device, variant.options);
    const HostImage pixels = toFloat(roomFrame(extent, kRsmSizePx).albedo.view());
    const cl::Image2D image(device.impl().context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                            clImageFormat(PixelFormat::RGBA32F), std::size_t(extent.widthPx),
                            std::size_t(extent.heightPx), 0, const_cast<std::byte*>(pixels.data()));
    const Surface surface(device, PixelFormat::RGBA32F, extent);
    const auto stage = std::make_shared<ImportImageStage>(device);
    return {.device = device,
            .run = launches(device, [=] { stage->enqueue(image, surface); }),
            .work = {.bytes = double(pixels.sizeBytes() + surface.sizeBytes()),
                     .flops = 3.0 * 2 * extent.widthPx * extent.heightPx}};
}

// bytes: color and depth in, 16 a pixel out. No arithmetic.
Row interleave(const Variant& variant, Extent extent) {
    const Room room(variant, extent);
    const Surface color = room.noisy();
    const cl::Buffer out = room.device.impl().makeBuffer(std::size_t(16 * room.pixels));
    const auto stage = std::make_shared<InterleaveStage>(room.device);
    return {.device = room.device,
            .run = launches(room.device,
                            [=] {
                                stage->enqueue({color, room.inputs.depth}, out);
                            }),
            .work = {.bytes = room.bytes({color, room.inputs.depth}) + 16 * room.pixels}};
}

}  // namespace

void addUnpackRows() {
    const auto add = [](const char* setting, PixelFormat format) {
        addRows("unpack", usualExtents(), setting,
                [=](const Variant& variant, Extent extent) { return unpack(variant, extent, format); });
    };
    add("r32f", PixelFormat::R32F);
    add("rgba16f", PixelFormat::RGBA16F);
    add("rgba32f", PixelFormat::RGBA32F);
    addRows("import_image", usualExtents(), "rgba32f", importImage);
    addRows("interleave", usualExtents(), "", interleave);
}

}  // namespace earthshine::bench
