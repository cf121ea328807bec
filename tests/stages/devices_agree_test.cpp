// One scene, one seed: the same picture from every device and storage, to rounding; and from one device the same bits
// each time.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "../../bench/room_frame.hpp"
#include "compute/tuning.hpp"
#include "reference/device_variants.hpp"

namespace earthshine {
namespace {

// Eight frames of the balanced preset, light as it leaves the surfaces.
HostImage eighthFrame(const reference::Variant& variant, const FrameImages& frame) {
    Pipeline pipeline{Device(variant.caps, variant.options)};
    pipeline.setFrame(frame.inputs());
    for (int i = 0; i < 8; ++i) pipeline.run(settingsOf(Preset::Balanced));
    return pipeline.read(Output::Color);
}

// image/metrics.hpp's: the mean of (T - R)^2 / (R^2 + (0.1 mean)^2).
double relMse(const HostImage& test, const HostImage& reference) {
    const Extent e = reference.extent();
    const int count = 4 * e.widthPx * e.heightPx;
    const float *t = test.pixel(0, 0), *r = reference.pixel(0, 0);
    double mean = 0.0, sum = 0.0;
    for (int i = 0; i < count; ++i) mean += i % 4 < 3 ? double(r[i]) / (0.75 * count) : 0.0;
    for (int i = 0; i < count; ++i)
        if (i % 4 < 3)
            sum += std::pow(double(t[i]) - double(r[i]), 2.0) / (double(r[i]) * double(r[i]) + 0.01 * mean * mean);
    return sum / (0.75 * count);
}

// What differs: float rounding moves a sample over a texel's border, or a tap over a threshold, now and then. Then the
// pixel takes a neighbouring texel, which is as likely to be right.
TEST(DevicesAgree, OneSceneAndSeedOnePicture) {
    const FrameImages frame = bench::makeRoomFrame({320, 180}, 128);
    HostImage first;
    ASSERT_FALSE(reference::defaultVariants().empty());
    for (const reference::Variant& device : reference::defaultVariants()) {
        for (const std::string storage : kStorageNames) {
            if (storage == "image" && !device.caps.images) continue;
            reference::Variant variant = device;
            variant.options.storage = storage;
            HostImage picture = eighthFrame(variant, frame);
            const HostImage again = eighthFrame(variant, frame);
            EXPECT_EQ(std::memcmp(picture.data(), again.data(), picture.sizeBytes()), 0)
                << device.name << ", " << storage;
            const double error = first.empty() ? 0.0 : relMse(picture, first);
            // Found: up to 1e-12 between floats, 3e-9 to packed pixels.
            EXPECT_LT(error, storage == "packed" ? 3e-8 : 1e-8) << device.name << ", " << storage;
            if (first.empty()) first = std::move(picture);
            RecordProperty("relMse_" + device.name + "_" + storage, std::to_string(error));
            std::printf("%s, %s: relMSE %.3g to the first\n", device.name.c_str(), storage.c_str(), error);
        }
    }
}

}  // namespace
}  // namespace earthshine
