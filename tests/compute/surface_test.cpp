// Surfaces in both storages, at odd extents and every width: loads, stores and gathers hit the pixel that they name,
// and nothing is written outside.

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "compute/probe.hpp"

namespace earthshine {
namespace {

constexpr std::array kExtents = {Extent{1, 1}, Extent{7, 3}, Extent{16, 2}, Extent{191, 347}};

/// Pixels of a surface, one or three channels interleaved.
struct Pixels {
    Extent extent;
    int channels = 1;
    std::vector<float> values;

    float& at(int x, int y, int c) {
        return values[(std::size_t(y) * std::size_t(extent.widthPx) + std::size_t(x)) * std::size_t(channels) +
                      std::size_t(c)];
    }
};

// Numbers that a half holds exactly, so that RGBA16F is no different.
Pixels randomPixels(Extent extent, int channels, unsigned seed) {
    std::mt19937 random(seed);
    Pixels pixels{extent, channels, {}};
    pixels.values.resize(std::size_t(extent.widthPx) * std::size_t(extent.heightPx) * std::size_t(channels));
    for (float& v : pixels.values) v = float(int(random() % 2048) - 1024) / 64.0f;
    return pixels;
}

Pixels flipped(Pixels pixels) {
    Pixels result = pixels;
    const Extent e = pixels.extent;
    for (int y = 0; y < e.heightPx; ++y)
        for (int x = 0; x < e.widthPx; ++x)
            for (int c = 0; c < pixels.channels; ++c)
                result.at(x, y, c) = pixels.at(e.widthPx - 1 - x, e.heightPx - 1 - y, c);
    return result;
}

// What lies `by` pixels to the right, 0 beyond the row's ends.
Pixels shifted(Pixels pixels, int by) {
    Pixels result = pixels;
    const Extent e = pixels.extent;
    for (int y = 0; y < e.heightPx; ++y)
        for (int x = 0; x < e.widthPx; ++x)
            for (int c = 0; c < pixels.channels; ++c)
                result.at(x, y, c) = x + by >= 0 && x + by < e.widthPx ? pixels.at(x + by, y, c) : 0.0f;
    return result;
}

class Surfaces : public testing::TestWithParam<reference::Variant> {
protected:
    bool isPlanar() const { return device_.tuning().storage == Storage::Planar; }

    void write(const Surface& surface, Pixels pixels) {
        Device::Impl& impl = device_.impl();
        const Extent e = surface.extent();
        if (isPlanar()) {
            const SurfaceLayout& l = surface.layout();
            std::vector<float> planes(surface.sizeBytes() / sizeof(float), 1e9f);  // padding that nobody may take in
            for (int c = 0; c < pixels.channels; ++c)
                for (int y = 0; y < e.heightPx; ++y)
                    for (int x = 0; x < e.widthPx; ++x)
                        planes[std::size_t(SURFACE_GUARD + c * l.planeStride + y * l.pitch + x)] = pixels.at(x, y, c);
            impl.queue.enqueueWriteBuffer(cl::Buffer(surface.memory()(), true), CL_TRUE, 0, surface.sizeBytes(),
                                          planes.data());
            return;
        }
        HostImage image(surface.format() == PixelFormat::R32F ? PixelFormat::R32F : PixelFormat::RGBA32F, e);
        for (int y = 0; y < e.heightPx; ++y)
            for (int x = 0; x < e.widthPx; ++x)
                for (int c = 0; c < pixels.channels; ++c) image.pixel(x, y)[c] = pixels.at(x, y, c);
        if (surface.format() == PixelFormat::RGBA16F) image = toHalf(image.view());
        impl.queue.enqueueWriteImage(cl::Image2D(surface.memory()(), true), CL_TRUE, {0, 0, 0}, regionOf(e), 0, 0,
                                     image.data());
    }

    Pixels read(const Surface& surface) {
        Device::Impl& impl = device_.impl();
        const Extent e = surface.extent();
        Pixels pixels = randomPixels(e, surface.format() == PixelFormat::R32F ? 1 : 3, 99);
        if (isPlanar()) {
            const SurfaceLayout& l = surface.layout();
            std::vector<float> planes(surface.sizeBytes() / sizeof(float));
            impl.queue.enqueueReadBuffer(cl::Buffer(surface.memory()(), true), CL_TRUE, 0, surface.sizeBytes(),
                                         planes.data());
            for (int c = 0; c < pixels.channels; ++c)
                for (int y = 0; y < e.heightPx; ++y)
                    for (int x = 0; x < e.widthPx; ++x)
                        pixels.at(x, y, c) = planes[std::size_t(SURFACE_GUARD + c * l.planeStride + y * l.pitch + x)];
            return pixels;
        }
        HostImage image(surface.format(), e);
        impl.queue.enqueueReadImage(cl::Image2D(surface.memory()(), true), CL_TRUE, {0, 0, 0}, regionOf(e), 0, 0,
                                    image.data());
        const HostImage floats = toFloat(image.view());
        for (int y = 0; y < e.heightPx; ++y) {
            for (int x = 0; x < e.widthPx; ++x) {
                for (int c = 0; c < pixels.channels; ++c) pixels.at(x, y, c) = floats.pixel(x, y)[c];
                if (pixels.channels == 3) {
                    EXPECT_EQ(floats.pixel(x, y)[3], 1.0f) << "alpha at " << x << ", " << y;
                }
            }
        }
        return pixels;
    }

    static cl::array<cl::size_type, 3> regionOf(Extent e) {
        return {std::size_t(e.widthPx), std::size_t(e.heightPx), 1};
    }

    Device device_ = test::openWithProbes(GetParam());
};

TEST_P(Surfaces, LoadsStoresAndGathersHitTheirPixel) {
    Kernel copy(device_, "surface_copy"), flip(device_, "surface_flip");
    for (const Extent extent : kExtents) {
        for (const PixelFormat format : {PixelFormat::RGBA32F, PixelFormat::RGBA16F}) {
            SCOPED_TRACE(testing::Message()
                         << extent.widthPx << " x " << extent.heightPx << ", " << formatName(format));
            const Pixels one = randomPixels(extent, 1, 1), three = randomPixels(extent, 3, 2);
            const Surface inOne(device_, PixelFormat::R32F, extent), inThree(device_, format, extent);
            const Surface outOne(device_, PixelFormat::R32F, extent), outThree(device_, format, extent);
            write(inOne, one);
            write(inThree, three);
            for (Kernel* kernel : {&copy, &flip}) {
                kernel->set("inOne", inOne).set("inThree", inThree).set("outOne", outOne).set("outThree", outThree);
                kernel->enqueue(extent);
                const bool isFlip = kernel == &flip;
                ASSERT_EQ(read(outOne).values, (isFlip ? flipped(one) : one).values) << (isFlip ? "flip" : "copy");
                ASSERT_EQ(read(outThree).values, (isFlip ? flipped(three) : three).values)
                    << (isFlip ? "flip" : "copy");
            }
        }
    }
}

// A row read from beside it: lanes on the row hold its pixels, whatever lies around it.
TEST_P(Surfaces, LoadsFromBesideARowHitItsPixels) {
    Kernel shift(device_, "surface_shift");
    for (const Extent extent : kExtents) {
        const Pixels one = randomPixels(extent, 1, 1), three = randomPixels(extent, 3, 2);
        const Surface inOne(device_, PixelFormat::R32F, extent), inThree(device_, PixelFormat::RGBA32F, extent);
        const Surface outOne(device_, PixelFormat::R32F, extent), outThree(device_, PixelFormat::RGBA32F, extent);
        write(inOne, one);
        write(inThree, three);
        shift.set("inOne", inOne).set("inThree", inThree).set("outOne", outOne).set("outThree", outThree);
        for (const int by : {-(SURFACE_GUARD - 16), -17, -1, 3, SURFACE_GUARD - 16}) {
            SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx << ", shifted by " << by);
            shift.setParams("shiftPx", by);
            shift.enqueue(extent);
            ASSERT_EQ(read(outOne).values, shifted(one, by).values);
            ASSERT_EQ(read(outThree).values, shifted(three, by).values);
        }
    }
}

// Planes in the middle of a larger buffer, far from one another: what lies between must stay.
TEST_P(Surfaces, NothingIsWrittenOutside) {
    if (!isPlanar()) return;  // an image has no outside: OpenCL drops such writes
    Kernel copy(device_, "surface_copy");
    Device::Impl& impl = device_.impl();
    for (const Extent extent : kExtents) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        const Surface inOne(device_, PixelFormat::R32F, extent), inThree(device_, PixelFormat::RGBA32F, extent);
        write(inOne, randomPixels(extent, 1, 1));
        write(inThree, randomPixels(extent, 3, 2));
        const int pitch = inOne.layout().pitch, plane = pitch * extent.heightPx;
        constexpr int kGuard = 1024;  // 4096 bytes: as much as any device wants a sub-buffer aligned to
        constexpr float kUntouched = -12345.0f;
        const auto size = std::size_t(3 * plane + 4 * kGuard + 2 * SURFACE_GUARD);
        const std::vector<float> before(size, kUntouched);
        const cl::Buffer one = test::upload(device_, before), three = test::upload(device_, before);
        const auto inside = [&](cl::Buffer buffer) {
            const cl_buffer_region region{kGuard * sizeof(float), (size - 2 * kGuard) * sizeof(float)};
            return buffer.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region);
        };
        const SurfaceLayout layout{extent.widthPx, extent.heightPx, pitch, plane + kGuard};
        const cl::Buffer outOne = inside(one), outThree = inside(three);
        copy.set("inOne", inOne).set("inThree", inThree);
        copy.set("outOne", outOne).setParams("outOneLayout", layout);
        copy.set("outThree", outThree).setParams("outThreeLayout", layout);
        copy.enqueue(extent);
        impl.queue.finish();
        for (const auto& [buffer, planes] : {std::pair{one, 1}, std::pair{three, 3}}) {
            const std::vector<float> after = test::download<float>(device_, buffer, size);
            std::size_t written = 0;
            for (std::size_t i = 0; i < size; ++i) {
                const auto offset = int(i) - kGuard - SURFACE_GUARD;
                const bool isInside =
                    offset >= 0 && offset / (plane + kGuard) < planes && offset % (plane + kGuard) < plane;
                if (!isInside) {
                    ASSERT_EQ(after[i], kUntouched) << planes << " planes, offset " << offset;
                }
                if (after[i] != kUntouched) ++written;
            }
            EXPECT_GE(written, std::size_t(planes * extent.widthPx * extent.heightPx));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Surfaces, testing::ValuesIn(test::storageVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
