// Which device a word means, and what may be asked of it.

#include "earthshine/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "compute/surface.hpp"
#include "earthshine/error.hpp"
#include "image/temp_folder.hpp"
#include "reference/device_variants.hpp"

namespace earthshine {
namespace {

using test::thrown;
using testing::HasSubstr;

class Devices : public testing::Test {
protected:
    Devices() {
        ::unsetenv("EARTHSHINE_DEVICE");
        reference::defaultVariants();  // sees to it that rusticl is there
        all_ = listDevices();
    }
    ~Devices() override { ::unsetenv("EARTHSHINE_DEVICE"); }

    // How many devices a part of a name fits.
    long fitting(const std::string& part) const {
        return std::count_if(all_.begin(), all_.end(), [&](const DeviceCaps& caps) {
            return lowered(caps.name).find(part) != std::string::npos ||
                   lowered(caps.platformName).find(part) != std::string::npos;
        });
    }
    static std::string lowered(std::string text) {
        for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
        return text;
    }
    static std::string raised(std::string text) {
        for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
        return text;
    }

    std::vector<DeviceCaps> all_;
};

TEST_F(Devices, AreListedWithWhatTheyCanDo) {
    ASSERT_FALSE(all_.empty());
    for (std::size_t i = 0; i < all_.size(); ++i) {
        const DeviceCaps& caps = all_[i];
        SCOPED_TRACE(caps.name);
        EXPECT_EQ(caps.index, int(i));
        EXPECT_FALSE(caps.platformName.empty());
        if (!caps.unusable.empty()) continue;
        EXPECT_FALSE(caps.name.empty());
        EXPECT_FALSE(caps.openclCVersion.empty());
        EXPECT_GT(caps.computeUnits, 0);
        EXPECT_GT(caps.maxAllocationBytes, 0u);
        EXPECT_THAT(caps.transports, testing::Contains("host"));
        const Tuning& t = caps.tuning;
        EXPECT_THAT(t.lanes, testing::AnyOf(1, 4, 8, 16));
        EXPECT_LE(std::size_t(t.localSizePx[0] * t.localSizePx[1]), caps.maxWorkGroupSize);
        EXPECT_FALSE(t.reason.empty());
    }
}

TEST_F(Devices, AreFoundByNumberAndByPartOfTheNameInAnyCase) {
    for (const DeviceCaps& caps : all_) {
        if (!caps.unusable.empty()) continue;
        std::string why;
        EXPECT_EQ(selectDevice(std::to_string(caps.index), &why).name, caps.name);
        EXPECT_EQ(why, "asked for");
        if (fitting(lowered(caps.name)) > 1) continue;
        EXPECT_EQ(selectDevice(lowered(caps.name)).index, caps.index);
        EXPECT_EQ(selectDevice(raised(caps.name)).index, caps.index);
        const std::string part = lowered(caps.name).substr(0, 6);
        if (fitting(part) == 1) {
            EXPECT_EQ(selectDevice(raised(part)).index, caps.index);
        }
        const std::string platform = lowered(caps.platformName);
        if (fitting(platform) == 1) {
            EXPECT_EQ(selectDevice(platform).index, caps.index);
        }
    }
}

TEST_F(Devices, UnknownAndAmbiguousNamesAreRefused) {
    EXPECT_THAT(thrown<UsageError>([] { selectDevice("no such device"); }),
                testing::AllOf(HasSubstr("'no such device'"), HasSubstr(all_[0].name)));
    EXPECT_THAT(thrown<UsageError>([] { selectDevice("99999"); }), HasSubstr("99999"));
    EXPECT_THAT(thrown<UsageError>([] { selectDevice("99999999999999999999"); }), HasSubstr("99999999999999999999"));
    // A letter that two devices share: there is one wherever two drivers are.
    for (char letter = 'a'; letter <= 'z'; ++letter) {
        const std::string part(1, letter);
        if (fitting(part) < 2) continue;
        EXPECT_THAT(thrown<UsageError>([&] { selectDevice(part); }),
                    testing::AllOf(HasSubstr("fits"), HasSubstr("say more")));
    }
}

TEST_F(Devices, TheEnvironmentStandsInForNoWord) {
    const DeviceCaps& last = all_.back();
    if (!last.unusable.empty()) return;
    ::setenv("EARTHSHINE_DEVICE", std::to_string(last.index).c_str(), 1);
    std::string why;
    EXPECT_EQ(selectDevice("", &why).index, last.index);
    EXPECT_THAT(why, HasSubstr("EARTHSHINE_DEVICE"));
    EXPECT_EQ(selectDevice("0").index, 0);  // a word of one's own goes first
    ::setenv("EARTHSHINE_DEVICE", "no such device", 1);
    thrown<UsageError>([] { selectDevice(""); });
    ::setenv("EARTHSHINE_DEVICE", "", 1);
    EXPECT_NO_THROW(selectDevice(""));
}

TEST_F(Devices, WithoutAWordAGpuGoesBeforeACpu) {
    std::string why;
    const DeviceCaps chosen = selectDevice("", &why);
    EXPECT_TRUE(chosen.unusable.empty());
    const auto isUsable = [&](const char* type) {
        return [type](const DeviceCaps& caps) { return caps.unusable.empty() && caps.type == type; };
    };
    const auto gpu = std::find_if(all_.begin(), all_.end(), isUsable("GPU"));
    const auto cpu = std::find_if(all_.begin(), all_.end(), isUsable("CPU"));
    if (gpu != all_.end()) {
        EXPECT_EQ(chosen.index, gpu->index);
    } else if (cpu != all_.end()) {
        EXPECT_EQ(chosen.index, cpu->index);
        EXPECT_THAT(why, HasSubstr("first CPU"));
    }
}

TEST_F(Devices, OptionsOutOfRangeAreRefused) {
    const DeviceCaps caps = selectDevice("");
    const auto message = [&](const std::function<void(DeviceOptions&)>& change) {
        DeviceOptions options;
        change(options);
        return thrown<UsageError>([&] { Device(caps, options); });
    };
    EXPECT_THAT(message([](DeviceOptions& o) { o.lanes = 3; }), HasSubstr("lanes: 3"));
    EXPECT_THAT(message([](DeviceOptions& o) { o.lanes = -1; }), HasSubstr("lanes: -1"));
    EXPECT_THAT(message([](DeviceOptions& o) { o.storage = "tape"; }), HasSubstr("'tape'"));
    EXPECT_THAT(message([](DeviceOptions& o) { o.localSizePx[0] = -2; }), HasSubstr("local size"));
    EXPECT_THAT(message([](DeviceOptions& o) { o.localSizePx[0] = o.localSizePx[1] = 30000; }),
                HasSubstr("30000 x 30000"));
    DeviceCaps withoutImages = caps;
    withoutImages.images = false;
    DeviceOptions images;
    images.storage = "image";
    EXPECT_THAT(thrown<UsageError>([&] { Device(withoutImages, images); }), HasSubstr("no images"));
}

TEST_F(Devices, CountsWhatIsAllocatedOnIt) {
    for (const std::string storage : {"image", "planar", "packed"}) {
        DeviceOptions options;
        options.storage = storage;
        const Device device(selectDevice(""), options);
        EXPECT_EQ(device.allocatedBytes(), 0u);
        device.impl().makeBuffer(1000);
        EXPECT_EQ(device.allocatedBytes(), 1000u);
        // A plane of 7 x 3 has rows of 16 floats, between two guards; so have packed pixels.
        const std::size_t surface = storage == "image"    ? 16u * 7 * 3
                                    : storage == "planar" ? 4u * (3 * 16 * 3 + 2 * SURFACE_GUARD)
                                                          : 8u * (16 * 3 + 2 * SURFACE_GUARD);
        Surface(device, PixelFormat::RGBA32F, {7, 3});
        EXPECT_EQ(device.allocatedBytes(), 1000u + surface) << storage;
    }
}

TEST_F(Devices, OptionsTakeTheTuningTablesPlace) {
    DeviceOptions options;
    options.lanes = 4;
    options.storage = "planar";
    options.rsmRecords = 0;
    options.localSizePx[0] = 2;
    options.localSizePx[1] = 3;
    const Device device(selectDevice(""), options);
    EXPECT_EQ(device.tuning().lanes, 4);
    EXPECT_EQ(device.tuning().storage, Storage::Planar);
    EXPECT_FALSE(device.tuning().rsmRecords);
    EXPECT_EQ(device.tuning().localSizePx[0], 2);
    EXPECT_EQ(device.tuning().localSizePx[1], 3);
    EXPECT_EQ(device.tuning().reason, "asked for");
}

}  // namespace
}  // namespace earthshine
