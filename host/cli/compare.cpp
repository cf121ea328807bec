// `earthshine compare`: how far a picture is from the truth.

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/error_report.hpp"
#include "cli/picture_source.hpp"
#include "earthshine/error.hpp"
#include "image/contact_sheet.hpp"
#include "image/image_file.hpp"
#include "image/json_text.hpp"
#include "image/output_set.hpp"

namespace earthshine::cli {

namespace {

constexpr float kFullRed = 0.5f;  // of the difference panel: half too bright

struct CompareArguments {
    std::string test, reference;
    std::string layer;
    std::vector<std::string> channels;
    bool masksSky = true;
    float pixelsPerDegree = float(kFlipPixelsPerDegree);
    bool json = false;
    std::string picture;
};

void requireAlike(const LoadedPicture& test, const LoadedPicture& reference) {
    if (test.kind != reference.kind)
        throw InputError(fmt::format("{} and {}: a PNG is for the eye and an EXR is light; compare like with like",
                                     test.name, reference.name));
    const auto [a, b] = std::pair(test.pixels.extent(), reference.pixels.extent());
    if (a != b)
        throw InputError(fmt::format("{} is {}x{} and {} is {}x{}: they must be of one size", test.name, a.widthPx,
                                     a.heightPx, reference.name, b.widthPx, b.heightPx));
    if (test.channels != reference.channels)
        throw InputError(fmt::format("{} has the channels {} and {} has {}: they must be the same", test.name,
                                     fmt::join(test.channels, ", "), reference.name,
                                     fmt::join(reference.channels, ", ")));
}

void writeSheet(const std::filesystem::path& path, const LoadedPicture& test, const LoadedPicture& reference,
                const PictureErrors& errors) {
    const HostImage testPicture = displayPicture(test.pixels.view(), errors.exposure);
    const HostImage referencePicture = displayPicture(reference.pixels.view(), errors.exposure);
    const HostImage difference = signedDifferencePicture(test.pixels.view(), reference.pixels.view(), errors, kFullRed);
    const HostImage& map = errors.hdrFlip ? errors.hdrFlip->errors : errors.ldrFlipMap;
    const HostImage flip = heatPicture(map.view(), errors.counted.view(), 1.0f);
    const Panel panels[] = {
        {"test", testPicture.view()},
        {"reference", referencePicture.view()},
        {fmt::format("relative difference, red +{:.0f} %", double(100 * kFullRed)), difference.view()},
        {errors.hdrFlip ? "hdr-flip, 0 to 1" : "ldr-flip, 0 to 1", flip.view()}};
    writePng(path, contactSheet(panels, 2).view());
}

void compareFiles(const CompareArguments& arguments) {
    if (!arguments.picture.empty() && std::filesystem::path(arguments.picture).extension() != ".png")
        throw UsageError(fmt::format("--picture: '{}' must end in .png", arguments.picture));
    if (!arguments.channels.empty() && arguments.channels.size() != 1 && arguments.channels.size() != 3)
        throw UsageError(fmt::format("--channels: give one or three names, not {}", arguments.channels.size()));
    OutputSet outputs;
    const auto picture = arguments.picture.empty() ? std::filesystem::path() : outputs.addFile(arguments.picture);

    const LoadedPicture test = loadPicture(arguments.test, arguments.layer, arguments.channels);
    const LoadedPicture reference = loadPicture(arguments.reference, arguments.layer, arguments.channels);
    requireAlike(test, reference);
    CompareOptions options;
    options.kind = reference.kind;
    options.pixelsPerDegree = double(arguments.pixelsPerDegree);
    const HostImage& mask = reference.skyMask.empty() ? test.skyMask : reference.skyMask;
    if (arguments.masksSky && !mask.empty()) options.mask = mask.view();
    const PictureErrors errors = measureErrors(test.pixels.view(), reference.pixels.view(), options);

    if (!picture.empty()) {
        writeSheet(picture, test, reference, errors);
        outputs.commit();
    }
    if (arguments.json) {
        nlohmann::ordered_json json = {{"test", arguments.test},
                                       {"reference", arguments.reference},
                                       {"channels", reference.channels},
                                       {"skyMask", !options.mask.empty()},
                                       {"pixelsPerDegree", arguments.pixelsPerDegree}};
        json.update(errorsJson(errors));
        fmt::print("{}\n", readableJson(json));
    } else {
        fmt::print("{}", errorsTable(errors));
        if (!picture.empty()) fmt::print("wrote {}\n", arguments.picture);
    }
}

}  // namespace

void addCompare(Options& program) {
    const auto arguments = std::make_shared<CompareArguments>();
    Options options = program.command("compare", "Measure how far a picture is from a reference",
                                      [arguments] { compareFiles(*arguments); });
    options.positional("test", arguments->test, "an EXR or PNG");
    options.positional("reference", arguments->reference, "the truth: the same kind, size and channels");
    options.text("--layer", "NAME", arguments->layer, "layer of the EXRs, as indirect-irradiance [the main picture]");
    options.option("--channels", "LIST", "", "one or three channels by their full names, in place of a layer",
                   [arguments](const std::string& text) { arguments->channels = splitCommas(text); });
    options.onOff("--mask-sky", arguments->masksSky,
                  "leave out what either file's depth layer, if there is one, says is sky");
    options.option("--ppd", "N", fmt::format("{:.2f}", kFlipPixelsPerDegree),
                   "FLIP: pixels a degree of sight [1; 1000]",
                   [arguments](const std::string& text) { arguments->pixelsPerDegree = parseFloat(text, 1, 1000); });
    options.flag("--json", arguments->json, "print JSON");
    options.text("--picture", "FILE", arguments->picture, "a PNG of test | reference | relative difference | FLIP");
}

}  // namespace earthshine::cli
