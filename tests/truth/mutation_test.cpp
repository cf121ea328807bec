// Can these truths fail? Each factor of the kernels is spoiled in a copy of the sources, once, and the closed forms
// must notice by a clear margin. A kernel that is rewritten takes its mutations along: a text that is gone fails here
// too.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <span>

#include "reference/device_variants.hpp"
#include "support/kernel_folder.hpp"
#include "truth/truth_scene.hpp"

namespace earthshine::truth {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSound = 0.02;    // small maps and few samples: the closed forms hold to this
constexpr double kNoticed = 0.05;  // what a spoiled factor must at least cost

/// A frame with what one of its outputs must be on average; 0 is compared with `scale`.
struct Check {
    const char* name;
    FrameImages frame;
    Settings settings;
    Output output;
    double truth;
    double scale;
};

constexpr double kAlbedo = 0.5, kLux = 1000.0, kCandela = 300.0;
constexpr double kRadiosity = kAlbedo * kLux;

std::vector<Check> makeChecks() {
    std::vector<Check> checks;
    const Rectangle emitter{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}, above{{0, 1, -1}, {1, 0, 0}, {0, 0, 1}};
    const Light beam = beamOnto(emitter, kLux, 1.0);
    const auto add = [&](const char* name, const Rectangle& receiver, const Camera& view, int px, const Light& light,
                         int rsmSizePx, const Settings& settings, Output output, double truth, double scale) {
        raster::Scene scene;
        addRectangle(scene, emitter, kAlbedo);
        addRectangle(scene, receiver, kAlbedo);
        checks.push_back(
            {name, DrawnScene(scene).draw(view, {px, px}, light, rsmSizePx), settings, output, truth, scale});
    };
    const auto irradiance = Output::IndirectIrradiance;
    const double parallel = kRadiosity * 0.199825;
    add("sum", above, squareView(above), 16, beam, 32, fullSum(), irradiance, parallel, parallel);
    add("disk", above, squareView(above), 32, beam, 32, wholeDisk(1024), irradiance, parallel, parallel);
    add("disk, radius 2", above, squareView(above), 32, beam, 32, wholeDisk(1024, 2.0), irradiance, parallel, parallel);
    for (const RadiusMapping mapping : {RadiusMapping::Polar, RadiusMapping::Squared}) {
        Settings line = wholeDisk(1024);
        line.pattern = DiskPattern::Line;
        line.mapping = mapping;
        add(mapping == RadiusMapping::Polar ? "polar line" : "squared line", above, squareView(above), 64, beam, 32,
            line, irradiance, parallel, parallel);
    }
    // Across a shared edge all light comes from one side: half of the turns would not do.
    const Rectangle beside{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    Settings tile = wholeDisk(256);
    tile.pattern = DiskPattern::Line;
    tile.mapping = RadiusMapping::Squared;
    tile.rotation = Rotation::Tile;
    add("tile", beside, squareView(beside), 128, beam, 256, tile, irradiance, kRadiosity * 0.200044, parallel);
    add("radiance", above, squareView(above), 16, beam, 32, fullSum(), Output::Indirect, kAlbedo / kPi * parallel,
        parallel);
    // What faces away, and what lies behind the emitter.
    const Rectangle facingAway{{1.5, 1, 0}, {1, 0, 0}, {0, 0, -1}}, below{{0, -1, 0}, {1, 0, 0}, {0, 0, -1}};
    add("facing away", facingAway, squareView(facingAway), 16, beam, 32, fullSum(), irradiance, 0.0, parallel);
    add("behind", below, squareView(below), 16, beam, 32, fullSum(), irradiance, 0.0, parallel);

    // Blocks of 8 texels, of which the emitter's edges cut off a part: 36 texels a metre.
    Settings minified = fullSum();
    minified.rsmMinify = 8;
    minified.animatesNoise = false;
    add("minified", above, squareView(above), 16, beamOnto(emitter, kLux, 10.0), 360, minified, irradiance, parallel,
        parallel);
    // One texel on a slope of 60 degrees, seen from so near that its disc decides (disc_test.cpp).
    const double height = 0.2, side = 0.4, slope = kPi / 3.0;
    const glm::dvec3 u(1, 0, 0), v(0.0, std::sin(slope), -std::cos(slope)), centre(0.5, 0, -0.5);
    const Rectangle near{{-0.5, height, -1.5}, {2, 0, 0}, {0, 0, 2}};
    const Camera nearPoint = pointView(centre + glm::dvec3(0, height, 0), near.normal());
    const double beamDisc = kRadiosity * side * side / kPi / (height * height + side * side / std::cos(slope) / kPi);
    add("disc of a beam", near, nearPoint, 1, beamOnto({centre - 0.5 * (u + v), u, v}, kLux, side), 1, fullSum(),
        irradiance, beamDisc, beamDisc);
    // One texel of a spot 0.5 m above.
    const double distance = 0.5, t = std::tan(0.4), solid = 4.0 * t * t;
    const double spotDisc = kAlbedo * kCandela * solid / kPi / (height * height + solid * distance * distance / kPi);
    add("disc of a spot", near, nearPoint, 1,
        spot(centre + glm::dvec3(0, distance, 0), centre, kCandela, 1.0, 1.2, 0.8), 1, fullSum(), irradiance, spotDisc,
        spotDisc);

    // Direct: a beam at 60 degrees; a spot, 0.4 rad off its axis, at half its range.
    const double direct = kLux * std::cos(slope);
    const Camera onEmitter = pointView(centre, {0, 1, 0});
    add("direct beam", below, onEmitter, 4, beamOnto({centre - 0.5 * (u + v), u, v}, kLux, 3.0), 1, fullSum(),
        Output::DirectIrradiance, direct, direct);
    Light lamp =
        spot(centre + glm::dvec3(0, 2, 0), centre + glm::dvec3(2.0 * std::tan(0.4), 0, 0), kCandela, 0.1, 0.8, 1.8);
    lamp.rangeM = 4.0f;
    const double cone = (std::cos(0.4) - std::cos(0.8)) / (std::cos(0.1) - std::cos(0.8));
    const double lampTruth = kCandela / 4.0 * cone * cone * (1.0 - 1.0 / 16.0);
    add("direct spot", below, onEmitter, 4, lamp, 1, fullSum(), Output::DirectIrradiance, lampTruth, lampTruth);
    return checks;
}

/// The check that a folder of kernels ("" = the library's) fails worst, and by how much.
struct Worst {
    std::string check;
    double error = 0.0;
};
Worst worstError(const std::string& kernelFolder) {
    static const std::vector<Check> checks = makeChecks();
    static const test::TempFolder cache;  // kernels that a mutation leaves alone are built once
    reference::Variant variant = reference::defaultVariants().at(0);
    // What is quickest to build; that width changes nothing is tests/stages' matter.
    variant.options.lanes = variant.caps.type == "GPU" ? 1 : 4;
    variant.options.kernelFolder = kernelFolder;
    variant.options.cacheFolder = cache.path().string();
    Pipeline pipeline{Device(variant.caps, variant.options)};
    Worst worst;
    for (const Check& check : checks) {
        const double mean = meanOf(compute(pipeline, check.frame, check.settings, check.output));
        const double error = std::fabs(mean - check.truth) / check.scale;
        if (!(error <= worst.error)) worst = {check.name, error};  // a NaN is the worst of all
    }
    return worst;
}

struct Mutation {
    const char* what;
    const char* file;
    const char* from;
    const char* to;
};

constexpr Mutation kEstimators[] = {
    {"sum without 1/pi", "rsm_sum.cl", "(vfloat)(ES_INV_PI)", "(vfloat)(1.0f)"},
    {"sum twice", "rsm_sum.cl", "(vfloat)(ES_INV_PI)", "(vfloat)(2.0f * ES_INV_PI)"},
    {"sum misses two columns", "rsm_sum.cl", "x < params.rsmSizePx; ++x", "x < params.rsmSizePx - 2; ++x"},
    {"disk without 1/pi", "common/rsm_gather.clh", "* size * size * ES_INV_PI", "* size * size"},
    {"disk twice", "common/rsm_gather.clh", "* size * size * ES_INV_PI", "* size * size * 2.0f * ES_INV_PI"},
    {"disk of r, not r^2", "common/rsm_gather.clh", "radius * radius * size", "radius * size"},
    {"disk without the map's size", "common/rsm_gather.clh", "* size * size * ES_INV_PI", "* ES_INV_PI"},
    {"disk without the pattern's weight", "common/rsm_gather.clh", "g * weight", "g"},
    {"disk denser at its centre", "common/rsm_gather.clh", "unitRadius = sqrt(u)", "unitRadius = u"},
    {"disk that does not wrap", "common/rsm_gather.clh", "wrapped(p.w + move.shift)", "p.w + move.shift"},
    {"polar disk without its pdf", "common/rsm_gather.clh", "weight *= 2.0f * u", "weight *= 1.0f"},
    {"squared disk with u^2 for u^3", "common/rsm_gather.clh", "4.0f * u * unitRadius", "4.0f * unitRadius"},
    {"tile of half the turns", "common/rsm_gather.clh", "1.0f / 16.0f, 0.5f / 16.0f", "1.0f / 32.0f, 0.25f"},
    {"tile's mean without its own pixel", "tile_average.cl", "vfloat count = ONE", "vfloat count = 0.0f"},
    {"disk with a lit border", "common/rsm_gather.clh", "vselect(isInside, g * weight, 0.0f)", "g * weight"},
};

constexpr Mutation kTexels[] = {
    {"no cosine at the receiver", "common/rsm.clh", "max(dot3(n, d), 0.0f)", "sqrt(d2)"},
    {"no cosine at the texel", "common/rsm.clh", "max(-dot3(normalWs, d), 0.0f)", "sqrt(d2)"},
    {"receivers lit from behind", "common/rsm.clh", "max(dot3(n, d), 0.0f)", "fabs(dot3(n, d))"},
    {"texels shine backwards", "common/rsm.clh", "max(-dot3(normalWs, d), 0.0f)", "fabs(dot3(normalWs, d))"},
    {"1/d^2 for 1/d^4", "common/rsm.clh", "vmad(d2, vmad(radius, radius, d2), 1e-30f)", "vmad(radius, radius, d2)"},
    {"texel as a point", "common/rsm.clh", "vmad(radius, radius, d2)", "d2"},
    {"texel radius of the area without 1/pi", "common/rsm.clh", "area * ES_INV_PI /", "area /"},
    {"texel area without the slope", "common/rsm.clh", "max(dot3(normalWs, towards), 0.05f)", "1.0f"},
    {"texel area of a spot without depth", "common/rsm.clh", "area * depth * depth *", "area * depth *"},
    {"texel area at half size", "common/rsm.clh", "vfloat area = light->rsmTexelArea",
     "vfloat area = 0.5f * light->rsmTexelArea"},
};

constexpr Mutation kOtherStages[] = {
    {"normals half as long", "common/rsm_record.clh", "inside, 32767.0f", "inside, 16383.0f"},
    {"radius twice", "common/rsm_record.clh", "(112u << 23)", "(111u << 23)"},
    {"flux in another channel's place", "common/rsm_record.clh", "positionWs.z, flux.x,", "positionWs.z, radius,"},
    {"minified flux of one texel", "rsm_minify.cl", "flux = add3(flux, f);", "flux = f;"},
    {"minified flux of one row", "rsm_minify.cl", "int rows = min(params.minify, ", "int rows = min(1, "},
    {"minified position of the wrong column", "rsm_minify.cl", "vselectInt(isPicked, x, pickedX)",
     "vselectInt(isPicked, x / 2, pickedX)"},
    {"minified texel at no depth", "rsm_minify.cl", "vselect(isPicked, depth, pickedDepth)", "pickedDepth"},
    {"radiance without 1/pi", "modulate.cl", "(vfloat)(ES_INV_PI)", "(vfloat)(1.0f)"},
    {"direct light without its cosine", "direct_light.cl", "e * max(cosine, 0.0f)", "e"},
    {"spot without its cone's square", "direct_light.cl", "cone * cone * window", "cone * window"},
    {"spot without its range", "direct_light.cl", "cone * cone * window", "cone * cone"},
    {"spot with 1/d", "direct_light.cl", "window / d2", "window * inverse"},
};

TEST(Mutations, SoundKernelsPass) {
    const test::KernelFolder copy;
    for (const std::string& folder : {std::string(), copy.path()}) {
        const Worst worst = worstError(folder);
        EXPECT_LT(worst.error, kSound) << worst.check;
    }
}

void expectAllNoticed(std::span<const Mutation> mutations) {
    for (const Mutation& mutation : mutations) {
        SCOPED_TRACE(mutation.what);
        test::KernelFolder copy;
        copy.replace(mutation.file, mutation.from, mutation.to);
        const Worst worst = worstError(copy.path());
        EXPECT_FALSE(worst.error < kNoticed) << "only " << worst.error << ", " << worst.check;
        std::string key = mutation.what;
        std::replace_if(
            key.begin(), key.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
        testing::Test::RecordProperty(key, std::to_string(worst.error) + " of the " + worst.check);
    }
}

TEST(Mutations, ASpoiledEstimatorIsNoticed) {
    expectAllNoticed(kEstimators);
}

TEST(Mutations, ASpoiledTexelIsNoticed) {
    expectAllNoticed(kTexels);
}

TEST(Mutations, AnotherSpoiledStageIsNoticed) {
    expectAllNoticed(kOtherStages);
}

}  // namespace
}  // namespace earthshine::truth
