// Surfaces in every storage, at odd extents and every width: loads, stores and gathers hit the pixel that they name,
// and nothing is written outside.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "compute/probe.hpp"
#include "support/surface_pixels.hpp"

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

std::vector<reference::Variant> packedVariants() {
    std::vector<reference::Variant> variants;
    for (const reference::Variant& v : test::storageVariants())
        if (v.options.storage == "packed") variants.push_back(v);
    return variants;
}

class Surfaces : public testing::TestWithParam<reference::Variant> {
protected:
    bool isPlanar() const { return device_.tuning().storage == Storage::Planar; }
    bool isPacked() const { return device_.tuning().storage == Storage::Packed; }

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
        if (isPacked()) {
            const std::size_t words = pixels.channels == 3 ? 2 : 1;
            std::vector<float> packed(surface.sizeBytes() / sizeof(float), 1e9f);
            for (int y = 0; y < e.heightPx; ++y)
                for (int x = 0; x < e.widthPx; ++x) {
                    float* to = &packed[words * std::size_t(SURFACE_GUARD + y * surface.layout().pitch + x)];
                    if (words == 2)
                        std::memcpy(to, test::packedWords(&pixels.at(x, y, 0)).data(), 2 * sizeof(float));
                    else
                        *to = pixels.at(x, y, 0);
                }
            impl.queue.enqueueWriteBuffer(cl::Buffer(surface.memory()(), true), CL_TRUE, 0, surface.sizeBytes(),
                                          packed.data());
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
        const Extent e = surface.extent();
        Pixels pixels = randomPixels(e, surface.format() == PixelFormat::R32F ? 1 : 3, 99);
        const HostImage floats = test::readSurface(device_, surface);
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

class PackedSurfaces : public Surfaces {};

// Three numbers in 64 bits: within 2^-13 of each, 2^-14 of the third, whatever its size and sign; what was rounded once
// is rounded no more, so that a picture can be copied for ever; and what halves hold stays as it is.
TEST_P(PackedSurfaces, RoundOnceToTwelveBits) {
    constexpr Extent kExtent{191, 64};
    Pixels pixels{kExtent, 3, {}};
    pixels.values.resize(std::size_t(kExtent.widthPx) * std::size_t(kExtent.heightPx) * 3);
    std::mt19937 random(5);
    for (float& v : pixels.values) {
        const float mantissa = float(int(random() % 0x2000000) - 0x1000000) * 0x1p-24f;
        v = random() % 16 == 0 ? 0.0f : std::ldexp(mantissa, int(random() % 140) - 90);  // to 2^49
    }
    constexpr std::array kEdges{1e15f,           -1e15f,          1.0f, 0x1.000fffp0f, 0x1.000800p0f, 0x1.fffffep0f,
                                -0x1.fffffep33f, 0x1.fffffep-99f, 0.0f};
    std::copy(kEdges.begin(), kEdges.end(), pixels.values.begin());
    constexpr std::size_t kHalves = 3000;  // of these on
    for (std::size_t i = kHalves; i < 2 * kHalves; ++i)
        pixels.values[i] = std::ldexp(float(int(random() % 4096) - 2048), int(random() % 28) - 24);
    Kernel copy(device_, "surface_copy"), pack(device_, "packed_probe");
    const Surface one(device_, PixelFormat::R32F, kExtent), from(device_, PixelFormat::RGBA32F, kExtent);
    const Surface outOne(device_, PixelFormat::R32F, kExtent), once(device_, PixelFormat::RGBA32F, kExtent);
    // Floats come in as they are: the kernel rounds, not this test.
    const cl::Buffer floats = test::upload(device_, pixels.values);
    pack.set("inNumbers", floats).set("outThree", from);
    pack.enqueue(kExtent);
    copy.set("inOne", one).set("inThree", from).set("outOne", outOne).set("outThree", once);
    copy.enqueue(kExtent);
    const std::vector<float> rounded = read(from).values;
    EXPECT_EQ(read(once).values, rounded);
    for (std::size_t i = 0; i < rounded.size(); ++i) {
        const bool isHalf = i >= kHalves && i < 2 * kHalves;
        ASSERT_LE(std::fabs(rounded[i] - pixels.values[i]),
                  isHalf ? 0.0f : (i % 3 == 2 ? 0x1p-14f : 0x1p-13f) * std::fabs(pixels.values[i]))
            << i << ": " << pixels.values[i];
    }
}

// Pixels in the middle of a larger buffer, planes far from one another: what lies between must stay.
TEST_P(Surfaces, NothingIsWrittenOutside) {
    if (!isPlanar() && !isPacked()) return;  // an image has no outside: OpenCL drops such writes
    Kernel copy(device_, "surface_copy");
    Device::Impl& impl = device_.impl();
    for (const Extent extent : kExtents) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        const Surface inOne(device_, PixelFormat::R32F, extent), inThree(device_, PixelFormat::RGBA32F, extent);
        write(inOne, randomPixels(extent, 1, 1));
        write(inThree, randomPixels(extent, 3, 2));
        const int pitch = inOne.layout().pitch;
        constexpr int kGuard = 1024;  // 4096 bytes: as much as any device wants a sub-buffer aligned to
        constexpr float kUntouched = -12345.0f;
        const int threePlanes = isPlanar() ? 3 : 1, threeWords = isPlanar() ? 1 : 2;  // of a pixel in a plane
        const auto size = std::size_t(3 * pitch * extent.heightPx + 4 * kGuard + 4 * SURFACE_GUARD);
        const std::vector<float> before(size, kUntouched);
        const cl::Buffer one = test::upload(device_, before), three = test::upload(device_, before);
        const auto inside = [&](cl::Buffer buffer) {
            const cl_buffer_region region{kGuard * sizeof(float), (size - 2 * kGuard) * sizeof(float)};
            return buffer.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region);
        };
        const SurfaceLayout layout{extent.widthPx, extent.heightPx, pitch, pitch * extent.heightPx + kGuard};
        const cl::Buffer outOne = inside(one), outThree = inside(three);
        copy.set("inOne", inOne).set("inThree", inThree);
        copy.set("outOne", outOne).setParams("outOneLayout", layout);
        copy.set("outThree", outThree).setParams("outThreeLayout", layout);
        copy.enqueue(extent);
        impl.queue.finish();
        const auto check = [&](const cl::Buffer& buffer, int planes, int words) {
            const std::vector<float> after = test::download<float>(device_, buffer, size);
            const int plane = words * pitch * extent.heightPx;
            std::size_t written = 0;
            for (std::size_t i = 0; i < size; ++i) {
                const int offset = int(i) - kGuard - words * SURFACE_GUARD;
                const bool isInside =
                    offset >= 0 && offset / (plane + kGuard) < planes && offset % (plane + kGuard) < plane;
                if (!isInside) {
                    ASSERT_EQ(after[i], kUntouched) << planes << " planes, offset " << offset;
                }
                if (after[i] != kUntouched) ++written;
            }
            EXPECT_GE(written, std::size_t(planes * words * extent.widthPx * extent.heightPx));
        };
        check(one, 1, 1);
        check(three, threePlanes, threeWords);
    }
}

INSTANTIATE_TEST_SUITE_P(All, PackedSurfaces, testing::ValuesIn(packedVariants()),
                         [](const auto& variant) { return variant.param.name; });
INSTANTIATE_TEST_SUITE_P(All, Surfaces, testing::ValuesIn(test::storageVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
