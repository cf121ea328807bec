// Settings become parameters: every one of them moves something, and none out of range gets through.

#include "pipeline/make_params.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "earthshine/error.hpp"
#include "image/temp_folder.hpp"

namespace earthshine {
namespace {

// All that kernels get to see, and which estimator runs. Padding inside the structs is a field like others, so it is
// set.
std::vector<unsigned char> bytesOf(const FrameParams& p) {
    std::vector<unsigned char> bytes;
    const auto append = [&](const auto& part) {
        const auto* data = reinterpret_cast<const unsigned char*>(&part);
        bytes.insert(bytes.end(), data, data + sizeof part);
    };
    append(p.estimator);
    append(p.pattern);
    append(p.divisor);
    append(p.upsampling);
    append(p.fullRays);
    append(p.pack);
    append(p.gather);
    append(p.sharesTexels);
    append(p.choose);
    append(p.sum);
    append(p.averagesTile);
    append(p.tileAverage);
    append(p.directLight);
    append(p.exposure);
    append(p.toneMap);
    append(p.denoises);
    append(p.accumulates);
    append(p.temporal);
    append(p.checksHistory);
    append(p.historyCheck);
    for (const AtrousParams& pass : p.filterPasses) append(pass);
    append(p.feedbackPasses);
    return bytes;
}

FrameGeometry geometry() {
    FrameGeometry g;
    g.cameraRays.origin = {1, 2, 3, 0};
    g.cameraRays.rayDx = {0.5f, 0, 0, 0};
    g.rsmSizePx = 64;
    g.lightCount = 2;
    g.shadowExtent = {128, 96};
    g.extent = {32, 18};
    g.frameIndex = 3;
    g.hasHistory = g.hasConfidence = true;
    return g;
}

// Another value of the setting's own range.
template <class Value>
void nudge(const SettingInfo& info, Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
        value = !value;
    } else if constexpr (std::is_enum_v<Value>) {
        value = Value((int(value) + 1) % int(info.names.size()));
    } else {
        value = double(value) == info.max ? Value(info.min) : Value(info.max);
    }
}

TEST(MakeParams, EverySettingMovesSomething) {
    // The middle of everything: where the denoiser runs, all that it does can be seen.
    Settings settings;
    settings.accumulates = true;
    settings.filterIterations = 7;
    const std::vector<unsigned char> before = bytesOf(makeParams(settings, geometry()));
    forEachSetting(settings, [&](const SettingInfo& info, auto& value) {
        const auto kept = value;
        nudge(info, value);
        EXPECT_NE(bytesOf(makeParams(settings, geometry())), before) << info.name << " is never read";
        EXPECT_NO_THROW(validate(settings)) << info.name;
        value = kept;
    });
    EXPECT_EQ(bytesOf(makeParams(settings, geometry())), before);
}

// A field that forEachSetting forgot would be a gap of four bytes; what a bool leaves before the next field is less.
TEST(MakeParams, EveryFieldIsASetting) {
    Settings settings;
    std::vector<std::pair<std::ptrdiff_t, std::size_t>> fields;
    forEachSetting(settings, [&](const SettingInfo&, auto& value) {
        fields.emplace_back(reinterpret_cast<const char*>(&value) - reinterpret_cast<const char*>(&settings),
                            sizeof value);
    });
    std::sort(fields.begin(), fields.end());
    fields.emplace_back(std::ptrdiff_t(sizeof settings), 0);
    std::ptrdiff_t end = 0;
    for (const auto& [offset, size] : fields) {
        EXPECT_GE(offset, end) << "visited twice";
        EXPECT_LT(offset, end + 4) << "nobody visits what is at byte " << end;
        end = offset + std::ptrdiff_t(size);
    }
}

TEST(MakeParams, TheFramesGeometryGoesThrough) {
    const FrameGeometry g = geometry();
    const FrameParams p = makeParams(Settings(), g);
    for (const ViewRays& rays :
         {p.gather.cameraRays, p.sum.cameraRays, p.tileAverage.cameraRays, p.directLight.cameraRays})
        EXPECT_EQ(std::memcmp(&rays, &g.cameraRays, sizeof rays), 0);
    EXPECT_EQ(p.gather.rsmSizePx, 64);
    EXPECT_EQ(p.gather.mapScale, 1.0f);
    EXPECT_EQ(p.sum.rsmSizePx, 64);
    EXPECT_EQ(p.gather.lightCount, 2);
    EXPECT_EQ(p.sum.lightCount, 2);
    EXPECT_EQ(p.directLight.lightCount, 2);
    EXPECT_EQ(p.directLight.shadowWidthPx, 128);
    EXPECT_EQ(p.directLight.shadowHeightPx, 96);
    EXPECT_EQ(p.sum.firstRowPx, 0);
}

TEST(MakeParams, ThereIsNoConfidenceWithoutAHistory) {
    // After a change of extent the tiles' confidence is of another picture, or of none.
    Settings settings;
    settings.accumulates = true;
    FrameGeometry g = geometry();
    EXPECT_EQ(makeParams(settings, g).temporal.usesConfidence, 1);
    g.hasHistory = false;
    EXPECT_EQ(makeParams(settings, g).temporal.usesConfidence, 0);
}

TEST(MakeParams, BlocksOfAMinifiedMapMayStickOut) {
    FrameGeometry g = geometry();
    g.rsmSizePx = 61;
    Settings settings;
    settings.rsmMinify = 8;
    const FrameParams p = makeParams(settings, g);
    EXPECT_EQ(p.pack.sizePx, 61);
    EXPECT_EQ(p.pack.minify, 8);
    EXPECT_EQ(p.pack.seed, 3u);
    EXPECT_EQ(p.gather.rsmSizePx, 8);
    EXPECT_EQ(p.sum.rsmSizePx, 8);
    EXPECT_FLOAT_EQ(p.gather.mapScale, 61.0f / 64.0f);
    settings.rsmMinify = 3;
    EXPECT_THAT(test::thrown<UsageError>([&] { validate(settings); }),
                testing::StrEq("rsm-minify: 3 is not 1, 2, 4 or 8"));
}

TEST(MakeParams, OutOfRangeIsRefusedByName) {
    EXPECT_NO_THROW(validate(Settings()));
    Settings settings;
    int numbers = 0;
    forEachSetting(settings, [&](const SettingInfo& info, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, int> || std::is_same_v<Value, float>) {
            const Value kept = value;
            std::vector<Value> wrong;
            if constexpr (std::is_same_v<Value, int>) {
                wrong = {int(info.min) - 1, int(info.max) + 1, std::numeric_limits<int>::min(),
                         std::numeric_limits<int>::max()};
            } else {
                constexpr float kInfinity = std::numeric_limits<float>::infinity();
                wrong = {std::nextafter(float(info.max), kInfinity), kInfinity, -kInfinity,
                         std::numeric_limits<float>::quiet_NaN()};
                wrong.push_back(info.min == 0.0 ? -1e-30f : float(info.min - 0.01 * std::fabs(info.min)));
            }
            for (const Value v : wrong) {
                value = v;
                EXPECT_THAT(test::thrown<UsageError>([&] { validate(settings); }),
                            testing::StartsWith(std::string(info.name) + ": "))
                    << v;
            }
            for (const double v : {info.min, info.max}) {
                value = Value(v);
                if (std::string(info.name) == "feedback")
                    settings.filterIterations = int(v);  // it remembers one of these
                EXPECT_NO_THROW(validate(settings)) << info.name << " = " << v;
            }
            value = kept;
            ++numbers;
        }
    });
    EXPECT_GT(numbers, 3);
}

TEST(MakeParams, HistoryCannotRememberAnIterationThatIsNotRun) {
    Settings settings;
    settings.filterIterations = 2;
    settings.feedback = 3;
    EXPECT_THAT(test::thrown<UsageError>([&] { validate(settings); }), testing::HasSubstr("iteration 3 of 2"));
}

TEST(MakeParams, DivisorsAreOneTwoOrFourAndInterpolationIsTheDisks) {
    Settings settings;
    settings.divisor = 3;
    EXPECT_THAT(test::thrown<UsageError>([&] { validate(settings); }), testing::HasSubstr("3 is not 1, 2 or 4"));
    settings.divisor = 2;
    settings.upsampling = Upsampling::Interpolate;
    EXPECT_NO_THROW(validate(settings));
    settings.estimator = Estimator::Sum;
    EXPECT_THAT(test::thrown<UsageError>([&] { validate(settings); }), testing::StartsWith("upsampling: "));
}

TEST(MakeParams, SetsOfPixelsAreOfWholeRows) {
    Settings settings;
    settings.rotation = Rotation::Coherent;
    settings.upsampling = Upsampling::Interpolate;
    EXPECT_NO_THROW(validate(settings));  // at full resolution nothing is interpolated
    settings.divisor = 2;
    EXPECT_THAT(test::thrown<UsageError>([&] { validate(settings); }), testing::StartsWith("rotation: coherent "));
    settings.upsampling = Upsampling::Bilateral;
    EXPECT_NO_THROW(validate(settings));
}

TEST(MakeParams, EveryPresetIsInRange) {
    for (int i = 0; i < int(std::size(kPresetNames)); ++i) EXPECT_NO_THROW(validate(settingsOf(Preset(i)))) << i;
}

TEST(MakeParams, EverySettingIsExplained) {
    std::vector<std::string> names;
    const Settings defaults;
    forEachSetting(defaults, [&](const SettingInfo& info, const auto& value) {
        EXPECT_THAT(names, testing::Not(testing::Contains(info.name)));
        names.emplace_back(info.name);
        EXPECT_GT(std::strlen(info.help), 10u) << info.name;
        if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
            EXPECT_EQ(info.names.size(), std::size_t(info.max) + 1) << info.name;
        }
    });
}

}  // namespace
}  // namespace earthshine
