// Folders of inputs: a frame comes back bit for bit, kindred files are understood, the rest ends in one line.

#include "image/inputs_folder.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>
#include <glm/gtc/matrix_transform.hpp>

#include "earthshine/error.hpp"
#include "image/image_file.hpp"
#include "temp_folder.hpp"

namespace fs = std::filesystem;

namespace earthshine {
namespace {

using test::readText;
using test::TempFolder;
using test::thrown;
using test::writeText;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr Extent kFrame{7, 5}, kRsm{4, 4}, kShadow{8, 6};

/// Numbers without a pattern that a mistake could share; the same on every run.
class Numbers {
public:
    float next() {
        state_ = state_ * 1664525u + 1013904223u;
        return float(state_ >> 8) * 0x1p-24f;
    }

private:
    unsigned state_ = 1;
};

HostImage depthImage(Extent extent, Numbers& numbers) {
    HostImage image(PixelFormat::R32F, extent);
    for (int i = 0; i < extent.widthPx * extent.heightPx; ++i)
        image.pixel(0, 0)[i] = i % 5 == 0 ? 0.0f : 0.1f + 100.0f * numbers.next();
    return image;
}

HostImage colorImage(Extent extent, PixelFormat format, Numbers& numbers, float scale) {
    HostImage image(PixelFormat::RGBA32F, extent);
    for (int i = 0; i < 4 * extent.widthPx * extent.heightPx; ++i) image.pixel(0, 0)[i] = scale * numbers.next();
    return format == PixelFormat::RGBA16F ? toHalf(image.view()) : std::move(image);
}

HostImage normalImage(const HostImage& depth, Numbers& numbers) {
    HostImage image(PixelFormat::RGBA32F, depth.extent());
    for (int i = 0; i < depth.extent().widthPx * depth.extent().heightPx; ++i) {
        if (depth.pixel(0, 0)[i] == 0.0f) continue;
        const glm::vec3 n = glm::normalize(glm::vec3(numbers.next(), numbers.next(), numbers.next()) - 0.5f);
        for (int c = 0; c < 3; ++c) image.pixel(0, 0)[4 * i + c] = n[c];
        image.pixel(0, 0)[4 * i + 3] = 1.0f;
    }
    return toHalf(image.view());
}

struct Frame {
    HostImage albedo, normal, depth, motion, emission;
    std::vector<HostImage> maps;
    FrameInputs inputs;
};

Frame makeFrame() {
    Numbers numbers;
    Frame f;
    f.depth = depthImage(kFrame, numbers);
    f.albedo = colorImage(kFrame, PixelFormat::RGBA16F, numbers, 1.0f);
    f.normal = normalImage(f.depth, numbers);
    f.motion = colorImage(kFrame, PixelFormat::RGBA16F, numbers, 30.0f);
    f.emission = colorImage(kFrame, PixelFormat::RGBA16F, numbers, 60000.0f);
    f.inputs.camera = {glm::lookAt(glm::vec3(1, 2, 3), glm::vec3(0.1f, 0, 0), glm::vec3(0, 1, 0)),
                       glm::perspective(0.8f, 1.4f, 0.1f, 50.0f)};
    f.inputs.gbuffer = {f.albedo.view(), f.normal.view(), f.depth.view(), f.motion.view(), f.emission.view()};
    const glm::mat4 lightView = glm::lookAt(glm::vec3(0, 9, 1), glm::vec3(0), glm::vec3(0, 0, 1));
    f.inputs.lights = {{"sun",
                        LightType::Directional,
                        {1e5f, 9.3e4f, 0.1f},
                        0.0f,
                        0.785f,
                        0.0f,
                        {lightView, glm::ortho(-5.0f, 5.0f, -4.0f, 4.0f, 0.1f, 20.0f)}},
                       {"lamp \"two\"",
                        LightType::Spot,
                        {10.0f, 20.0f, 1.0f / 3.0f},
                        0.1f,
                        0.7f,
                        12.5f,
                        {lightView, glm::perspective(1.4f, 1.0f, 0.05f, 30.0f)}}};
    f.inputs.lights[1].indirectScale = 1.75f;
    f.inputs.lights[1].gatherRadiusUv = 0.3f;
    f.maps.reserve(8);
    for (int i = 0; i < 2; ++i) {
        const HostImage& depth = f.maps.emplace_back(depthImage(kRsm, numbers));
        const HostImage& normal = f.maps.emplace_back(normalImage(depth, numbers));
        const HostImage& flux = f.maps.emplace_back(colorImage(kRsm, PixelFormat::RGBA32F, numbers, 1e-6f));
        const HostImage& shadow = f.maps.emplace_back(depthImage(kShadow, numbers));
        f.inputs.lightMaps.push_back({depth.view(), normal.view(), flux.view(), shadow.view()});
    }
    return f;
}

bool same(const ImageView& a, const ImageView& b) {
    return a.format == b.format && a.extent == b.extent && std::memcmp(a.data, b.data, a.sizeBytes()) == 0;
}

bool same(const Camera& a, const Camera& b) {
    return a.viewFromWorld == b.viewFromWorld && a.clipFromView == b.clipFromView;
}

/// The rows of light `i` of two.
ImageView map(const HostImage& all, int i) {
    const int rows = all.extent().heightPx / 2;
    return all.rows(i * rows, rows);
}

class InputsFolder : public ::testing::Test {
protected:
    void SetUp() override {
        setImageThreads(1);
        saveInputs(folder / "in", frame.inputs);
    }

    /// Replaces the first `from` in inputs.json.
    void edit(const std::string& from, const std::string& to) {
        std::string text = readText(folder / "in/inputs.json");
        const auto at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from << " is not in\n" << text;
        writeText(folder / "in/inputs.json", text.replace(at, from.size(), to));
    }

    std::string loadError() {
        return thrown<InputError>([&] { loadInputs(folder / "in"); });
    }

    void writeImage(const std::string& file, const ImageView& image, std::vector<std::string> channels) {
        const Layer layer{"", image, std::move(channels)};
        writeExr(folder / "in" / file, {&layer, 1});
    }

    TempFolder folder;
    const Frame frame = makeFrame();
};

TEST_F(InputsFolder, AFrameComesBackBitForBit) {
    const FrameImages back = loadInputs(folder / "in");
    EXPECT_TRUE(same(back.camera, frame.inputs.camera));
    EXPECT_TRUE(same(back.albedo.view(), frame.albedo.view()));
    EXPECT_TRUE(same(back.normalWs.view(), frame.normal.view()));
    EXPECT_TRUE(same(back.depth.view(), frame.depth.view()));
    EXPECT_TRUE(same(back.motion.view(), frame.motion.view()));
    EXPECT_TRUE(same(back.emission.view(), frame.emission.view()));
    ASSERT_EQ(back.lights.size(), 2u);
    for (int i = 0; i < 2; ++i) {
        const Light &a = back.lights[std::size_t(i)], &b = frame.inputs.lights[std::size_t(i)];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.type, b.type);
        EXPECT_EQ(a.intensity, b.intensity);
        EXPECT_EQ(a.innerConeAngle, b.innerConeAngle);
        EXPECT_EQ(a.outerConeAngle, b.outerConeAngle);
        EXPECT_EQ(a.rangeM, b.rangeM);
        EXPECT_EQ(a.indirectScale, b.indirectScale);
        EXPECT_EQ(a.gatherRadiusUv, b.gatherRadiusUv);
        EXPECT_TRUE(same(a.camera, b.camera));
        const LightMaps& maps = frame.inputs.lightMaps[std::size_t(i)];
        EXPECT_TRUE(same(map(back.rsmDepth, i), maps.rsmDepth));
        EXPECT_TRUE(same(map(back.rsmNormalWs, i), maps.rsmNormalWs));
        EXPECT_TRUE(same(map(back.rsmFlux, i), maps.rsmFlux));
        EXPECT_TRUE(same(map(back.shadowDepth, i), maps.shadowDepth));
    }
}

TEST_F(InputsFolder, OptionalImagesMayBeMissing) {
    FrameInputs inputs = frame.inputs;
    inputs.gbuffer.motion = inputs.gbuffer.emission = {};
    inputs.lights.clear();
    inputs.lightMaps.clear();
    saveInputs(folder / "in", inputs);
    EXPECT_FALSE(fs::exists(folder / "in/motion.exr")) << "the older folder was not replaced";
    const FrameImages back = loadInputs(folder / "in");
    EXPECT_TRUE(back.motion.empty());
    EXPECT_TRUE(back.emission.empty());
    EXPECT_TRUE(back.lights.empty());
    EXPECT_TRUE(back.rsmDepth.empty());
}

TEST_F(InputsFolder, KindredFilesAreUnderstood) {
    const HostImage albedo = toFloat(frame.albedo.view()), normal = toFloat(frame.normal.view());
    writeImage("albedo.exr", albedo.view(), {"R", "G", "B"});  // FLOAT, no alpha
    writeImage("normal.exr", normal.view(), {"R", "G", "B"});  // other names, no valid
    writeImage("depth.exr", frame.depth.view(), {"distance"});
    const FrameImages back = loadInputs(folder / "in");
    EXPECT_TRUE(same(back.depth.view(), frame.depth.view()));
    EXPECT_TRUE(same(back.normalWs.view(), frame.normal.view())) << "valid should follow from the depth";
    const HostImage read = toFloat(back.albedo.view());
    for (int i = 0; i < kFrame.widthPx * kFrame.heightPx; ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_EQ(read.pixel(0, 0)[4 * i + c], albedo.pixel(0, 0)[4 * i + c]);
        EXPECT_EQ(read.pixel(0, 0)[4 * i + 3], 1.0f);
    }
}

TEST_F(InputsFolder, CommentsAndFewerKeysAreFine) {
    edit("\"camera\"", "\"comment\": [\"by hand\"], \"camera\"");
    edit("\"innerConeAngle\": 0.0,", "");  // of the sun
    edit("\"rangeM\": 0.0,", "");
    edit("\"indirectScale\": 1.0,", "");
    edit("\"gatherRadiusUv\": 0.0,", "");
    EXPECT_EQ(loadInputs(folder / "in").lights.size(), 2u);
}

TEST_F(InputsFolder, MissingFilesAreNamed) {
    fs::remove(folder / "in/rsm_1_flux.exr");
    EXPECT_THAT(loadError(), HasSubstr("in/rsm_1_flux.exr: no such file"));
    fs::remove(folder / "in/inputs.json");
    EXPECT_THAT(loadError(), HasSubstr("in/inputs.json: no such file"));
    EXPECT_THAT(thrown<InputError>([&] { loadInputs(folder / "nowhere"); }), HasSubstr("nowhere: no such folder"));
}

TEST_F(InputsFolder, ExtentsMustAgree) {
    Numbers numbers;
    const HostImage small = colorImage({7, 4}, PixelFormat::RGBA16F, numbers, 1.0f);
    writeImage("albedo.exr", small.view(), {"R", "G", "B", "A"});
    EXPECT_THAT(loadError(), HasSubstr("albedo.exr: 7x4 pixels, but the depth beside it has 7x5"));
}

TEST_F(InputsFolder, ExtentsOfLightsMustAgree) {
    Numbers numbers;
    writeImage("shadow_1.exr", depthImage({8, 5}, numbers).view(), {"Z"});
    EXPECT_THAT(loadError(), HasSubstr("shadow_1.exr: 8x5 pixels, but that of the first light has 8x6"));
}

TEST_F(InputsFolder, NumbersMustBeFinite) {
    HostImage flux = toFloat(frame.inputs.lightMaps[0].rsmFlux);
    flux.pixel(2, 3)[1] = std::numeric_limits<float>::quiet_NaN();
    writeImage("rsm_0_flux.exr", flux.view(), {"R", "G", "B", "A"});
    EXPECT_THAT(loadError(), AllOf(HasSubstr("rsm_0_flux.exr: 1 values are not finite"), HasSubstr("pixel (2, 3)")));
}

TEST_F(InputsFolder, FloatsTooLargeForAHalfAreRefused) {
    HostImage emission = toFloat(frame.emission.view());
    emission.pixel(1, 4)[0] = 70000.0f;
    writeImage("emission.exr", emission.view(), {"R", "G", "B", "A"});
    EXPECT_THAT(loadError(), AllOf(HasSubstr("emission.exr"), HasSubstr("too large for RGBA16F"), HasSubstr("(1, 4)")));
}

TEST_F(InputsFolder, NegativeDepthIsRefused) {
    HostImage depth = toFloat(frame.depth.view());
    depth.pixel(6, 0)[0] = -3.0f;
    writeImage("depth.exr", depth.view(), {"Z"});
    EXPECT_THAT(loadError(), AllOf(HasSubstr("depth.exr: depth -3 at pixel (6, 0)"), HasSubstr("along -z")));
}

TEST_F(InputsFolder, PackedNormalsAreRefused) {
    HostImage packed = toFloat(frame.normal.view());
    for (int i = 0; i < kFrame.widthPx * kFrame.heightPx; ++i)
        for (int c = 0; c < 3; ++c) packed.pixel(0, 0)[4 * i + c] = 0.5f + 0.5f * packed.pixel(0, 0)[4 * i + c];
    writeImage("normal.exr", packed.view(), {"X", "Y", "Z", "valid"});
    EXPECT_THAT(loadError(), AllOf(HasSubstr("normal.exr"), HasSubstr("not of length 1")));
}

TEST_F(InputsFolder, ChannelsMustBeKnown) {
    writeImage("motion.exr", toFloat(frame.motion.view()).view(), {"U", "V"});
    EXPECT_THAT(loadError(), HasSubstr("motion.exr: expected channels X Y Z W; it has U V"));
}

struct BadJson {
    const char *from, *to, *message;
};

void PrintTo(const BadJson& bad, std::ostream* stream) {
    *stream << bad.from << " -> " << bad.to;
}

class InputsJson : public InputsFolder, public ::testing::WithParamInterface<BadJson> {};

TEST_P(InputsJson, EndsInOneLine) {
    edit(GetParam().from, GetParam().to);
    EXPECT_THAT(loadError(), AllOf(HasSubstr("in/inputs.json: "), HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Bad, InputsJson,
    ::testing::Values(
        BadJson{"{", "", "parse error"}, BadJson{"{", "[{", "parse error"},
        BadJson{"earthshine-inputs", "inputs", "\"format\" must be \"earthshine-inputs\""},
        BadJson{"\"version\": 1", "\"version\": 2", "version: expected 1, found 2"},
        BadJson{"\"version\": 1", "\"version\": 1, \"exposure\": 1", "unknown key \"exposure\""},
        BadJson{"\"camera\": {", "\"camera\": 3, \"comment\": {", "camera: expected an object, found number"},
        BadJson{"\"viewFromWorld\": [", "\"viewFromWorld\": [1, ",
                "camera: viewFromWorld: expected 16 numbers, found 17"},
        BadJson{"\"viewFromWorld\": [", "\"viewFromWorld\": [1,0,0,5, 0,1,0,5, 0,0,1,5, 0,0,0,1], \"comment\": [",
                "camera: viewFromWorld: its last row must be 0 0 0 1"},
        BadJson{"\"viewFromWorld\": [", "\"viewFromWorld\": [2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1], \"comment\": [",
                "without scale"},
        BadJson{"\"viewFromWorld\": [", "\"viewFromWorld\": [1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,0,0,1], \"comment\": [",
                "mirrors the world"},
        BadJson{"\"clipFromView\": [", "\"clipFromView\": [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0], \"comment\": [",
                "camera: clipFromView: cannot be inverted"},
        BadJson{"\"clipFromView\": [", "\"clipFromView\": [\"a\",0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0], \"comment\": [",
                "clipFromView[0]: expected a number, found string"},
        BadJson{"\"depth.exr\"", "7", "images: depth: expected a string, found number"},
        BadJson{"\"depth.exr\"", "\"../depth.exr\"", "images: depth: expected the name of a file inside the folder"},
        BadJson{"\"depth.exr\"", "\"/depth.exr\"", "inside the folder"},
        BadJson{"\"emission\"", "\"emmission\"", "images: unknown key \"emmission\""},
        BadJson{"\"albedo\": \"albedo.exr\",", "", "images: no \"albedo\""},
        BadJson{"\"lights\": [", "\"lights\": 1, \"comment\": [", "lights: expected a list, found number"},
        BadJson{"\"directional\"", "\"point\"", "lights[0]: type: expected \"directional\" or \"spot\""},
        BadJson{"\"directional\"", "\"spot\"", "lights[0]"},
        BadJson{"\"spot\"", "\"directional\"", "lights[1]: camera: clipFromView: a directional light needs"},
        BadJson{"\"intensity\": [", "\"intensity\": [-", "lights[0]: intensity: must be finite and not negative"},
        BadJson{"\"intensity\": [", "\"intensity\": [1e999, 1, 1], \"comment\": [", "number overflow"},
        BadJson{"\"intensity\": [", "\"intensity\": [1e99, 1, 1], \"comment\": [", "too large for a float"},
        BadJson{"\"rangeM\": 0.0", "\"rangeM\": -1", "lights[0]: rangeM: must not be negative"},
        BadJson{"\"indirectScale\": 1.0", "\"indirectScale\": -1", "lights[0]: indirectScale: must be in [0; 1000]"},
        BadJson{"\"gatherRadiusUv\": 0.0", "\"gatherRadiusUv\": 3", "lights[0]: gatherRadiusUv: must be in [0; 2]"},
        BadJson{"\"innerConeAngle\": 0.1", "\"innerConeAngle\": 1.1", "lights[1]: a spot needs 0 <= innerConeAngle"},
        BadJson{"\"rsmFlux\": \"rsm_1", "\"rsmFlux\": \"../rsm_1", "lights[1]: rsmFlux"}));

TEST_F(InputsFolder, SavingIsWholeOrNotAtAll) {
    FrameInputs broken = frame.inputs;
    broken.lightMaps[1].rsmFlux = broken.lightMaps[1].rsmNormalWs;
    EXPECT_THAT(thrown<UsageError>([&] { saveInputs(folder / "other", broken); }), HasSubstr("rsmFlux"));
    EXPECT_THAT(thrown<UsageError>([&] { saveInputs(folder / "in", broken); }), HasSubstr("rsmFlux"));
    EXPECT_THAT(folder.names(), ::testing::ElementsAre("in"));
    EXPECT_EQ(loadInputs(folder / "in").lights.size(), 2u);
}

}  // namespace
}  // namespace earthshine
