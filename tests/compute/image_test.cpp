// Pixels in host memory: half floats bit by bit, conversions, rows, and what a device's surface refuses.

#include "earthshine/image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "compute/surface.hpp"
#include "earthshine/error.hpp"
#include "image/temp_folder.hpp"
#include "reference/device_variants.hpp"

namespace earthshine {
namespace {

// The value of a half by its definition.
double valueOf(unsigned half) {
    const int exponent = int(half >> 10 & 31u), mantissa = int(half & 1023u);
    const double sign = (half & 0x8000u) != 0 ? -1.0 : 1.0;
    if (exponent == 31) return mantissa != 0 ? std::nan("") : sign * std::numeric_limits<double>::infinity();
    if (exponent == 0) return sign * std::ldexp(mantissa, -24);
    return sign * std::ldexp(1024 + mantissa, exponent - 25);
}

TEST(Half, EveryOneIsItsValueAndComesBack) {
    for (unsigned half = 0; half < 65536; ++half) {
        const float value = floatFromHalf(std::uint16_t(half));
        const double expected = valueOf(half);
        if (std::isnan(expected)) {
            ASSERT_TRUE(std::isnan(value)) << half;
            const unsigned back = halfFromFloat(value);
            ASSERT_TRUE((back & 0x7c00u) == 0x7c00u && (back & 0x3ffu) != 0) << half;
            continue;
        }
        ASSERT_EQ(std::bit_cast<std::uint32_t>(value), std::bit_cast<std::uint32_t>(float(expected))) << half;
        ASSERT_EQ(halfFromFloat(value), half);
    }
}

// Between two neighbouring halves: just below the middle goes down, just above goes up, the middle to the even one.
TEST(Half, RoundsToNearestEven) {
    for (unsigned half = 0; half < 0x7bff; ++half) {
        const double low = valueOf(half), high = valueOf(half + 1);
        const auto middle = float((low + high) / 2.0);
        ASSERT_EQ(halfFromFloat(middle), half % 2 == 0 ? half : half + 1) << half;
        ASSERT_EQ(halfFromFloat(std::nextafter(middle, 0.0f)), half);
        ASSERT_EQ(halfFromFloat(std::nextafter(middle, 1e6f)), half + 1);
        ASSERT_EQ(halfFromFloat(-middle), (half % 2 == 0 ? half : half + 1) | 0x8000u);
    }
    EXPECT_EQ(halfFromFloat(65504.0f), 0x7bff);
    EXPECT_EQ(halfFromFloat(std::nextafter(65520.0f, 0.0f)), 0x7bff);
    EXPECT_EQ(halfFromFloat(65520.0f), 0x7c00);
    EXPECT_EQ(halfFromFloat(1e30f), 0x7c00);
    EXPECT_EQ(halfFromFloat(-1e30f), 0xfc00);
    EXPECT_EQ(halfFromFloat(1e-30f), 0);
    EXPECT_EQ(halfFromFloat(-0.0f), 0x8000);
}

TEST(HostImage, IsZeroAlignedAndRowsPointIntoIt) {
    HostImage image(PixelFormat::RGBA16F, {5, 7});
    EXPECT_EQ(image.sizeBytes(), 5u * 7u * 8u);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(image.data()) % 4096, 0u);
    for (std::size_t i = 0; i < 4096; ++i) ASSERT_EQ(image.data()[i], std::byte(0));  // its last page too
    const ImageView rows = image.rows(2, 3);
    EXPECT_EQ(rows.data, image.data() + 2 * 5 * 8);
    EXPECT_EQ(rows.extent, (Extent{5, 3}));
    EXPECT_EQ(rows.format, PixelFormat::RGBA16F);
    EXPECT_TRUE(HostImage().empty());
    EXPECT_TRUE(HostImage(PixelFormat::R32F, {0, 4}).empty());
}

TEST(HostImage, ConvertsEveryFormat) {
    HostImage bytes(PixelFormat::RGBA8, {2, 1});
    const std::uint8_t values[] = {0, 1, 128, 255, 51, 2, 3, 4};
    std::memcpy(bytes.data(), values, sizeof values);
    const HostImage floats = toFloat(bytes.view());
    ASSERT_EQ(floats.format(), PixelFormat::RGBA32F);
    for (int i = 0; i < 8; ++i) EXPECT_EQ(floats.pixel(i / 4, 0)[i % 4], float(values[i]) / 255.0f);

    HostImage wide(PixelFormat::RGBA32F, {3, 2});
    for (int i = 0; i < 24; ++i) wide.pixel(0, 0)[i] = 0.1f * float(i) - 1.0f;
    const HostImage half = toHalf(wide.view());
    ASSERT_EQ(half.format(), PixelFormat::RGBA16F);
    const HostImage again = toFloat(half.view());
    for (int i = 0; i < 24; ++i)
        EXPECT_EQ(again.pixel(0, 0)[i], floatFromHalf(halfFromFloat(wide.pixel(0, 0)[i]))) << i;

    HostImage depth(PixelFormat::R32F, {2, 2});
    depth.pixel(1, 1)[0] = 7.5f;
    const HostImage copy = toFloat(depth.view());
    EXPECT_EQ(copy.format(), PixelFormat::R32F);
    EXPECT_EQ(*copy.pixel(1, 1), 7.5f);
    EXPECT_TRUE(toFloat(ImageView()).empty());
    EXPECT_TRUE(toHalf(ImageView()).empty());
}

TEST(SurfaceLimits, RowsArePaddedAndOffsetsFit32Bits) {
    reference::Variant variant = reference::defaultVariants().at(0);
    variant.options.storage = "planar";
    const Device device(variant.caps, variant.options);
    const Surface one(device, PixelFormat::R32F, {17, 3}), three(device, PixelFormat::RGBA16F, {16, 3});
    EXPECT_EQ(one.layout().pitch, 32);
    EXPECT_EQ(one.sizeBytes(), (32u * 3u + 2u * SURFACE_GUARD) * 4u);
    EXPECT_EQ(three.layout().pitch, 16);
    EXPECT_EQ(three.layout().planeStride, 48);
    EXPECT_EQ(three.sizeBytes(), (3u * 48u + 2u * SURFACE_GUARD) * 4u);
    EXPECT_TRUE(Surface().empty());
    EXPECT_THAT(test::thrown<DeviceError>([&] {
                    Surface(device, PixelFormat::R32F, {65536, 65536});
                }),
                testing::HasSubstr("65536 x 65536"));
}

TEST(SurfaceLimits, AnImageTooLargeForTheDeviceIsADeviceError) {
    for (const reference::Variant& v : reference::allVariants()) {
        if (v.options.storage != "image" || v.options.lanes != 1) continue;
        const Device device(v.caps, v.options);
        const auto width = int(v.caps.maxImageSizePx[0]) + 1;
        EXPECT_THAT(test::thrown<DeviceError>([&] {
                        Surface(device, PixelFormat::R32F, {width, 1});
                    }),
                    testing::AllOf(testing::HasSubstr(std::to_string(width)), testing::HasSubstr(v.caps.name),
                                   testing::HasSubstr("takes images of up to")));
    }
}

}  // namespace
}  // namespace earthshine
