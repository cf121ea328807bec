#include "cli/frame_files.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "earthshine/error.hpp"
#include "earthshine/log.hpp"
#include "image/contact_sheet.hpp"
#include "image/image_file.hpp"

namespace fs = std::filesystem;

namespace earthshine::cli {

namespace {

const std::vector<std::string> kRgb{"R", "G", "B"}, kXyz{"X", "Y", "Z"}, kZ{"Z"};

void requireEnding(const char* option, const std::string& path, std::initializer_list<const char*> endings) {
    const std::string ending = fs::path(path).extension().string();
    if (std::find(endings.begin(), endings.end(), ending) == endings.end())
        throw UsageError(fmt::format("{}: '{}' must end in {}", option, path, fmt::join(endings, " or ")));
}

/// One EXR in the making: owns what its layers borrow.
class ExrLayers {
public:
    void add(std::string name, const ImageView& image, const std::vector<std::string>& channels) {
        layers_.push_back({std::move(name), image, channels});
    }
    void add(std::string name, HostImage image, const std::vector<std::string>& channels) {
        owned_.push_back(std::move(image));
        add(std::move(name), owned_.back().view(), channels);
    }
    void write(const fs::path& temporary, const fs::path& path, const Attributes& attributes,
               std::vector<NonFiniteLayer>& nonFinite) const {
        for (const Layer& layer : layers_) {
            const std::string name = layer.name.empty() ? "color" : layer.name;
            const NonFinite found = findNonFinite(layer.image);
            nonFinite.push_back({name, found.count});
            if (found.count > 0)
                log(LogLevel::Warning, fmt::format("{}: {}: {} values are not finite, the first at pixel ({}, {})",
                                                   path.string(), name, found.count, found.xPx, found.yPx));
        }
        writeExr(temporary, layers_, attributes);
    }

private:
    std::vector<Layer> layers_;
    std::vector<HostImage> owned_;
};

}  // namespace

void addFrameFileOptions(Options& options, FrameFileArguments& arguments) {
    options.group("Files");
    options.text("-o,--out", "FILE", arguments.out,
                 "picture.exr (scene-linear, cd/m^2; picture.png comes beside it) or picture.png (tone-mapped)", true);
    options.option("--aov", "LIST", "",
                   fmt::format("more layers for the EXR, with commas: {}, or all", fmt::join(kAovNames, ", ")),
                   [&arguments](const std::string& text) {
                       for (const std::string& name : splitCommas(text)) {
                           if (name == "all")
                               arguments.aovs.assign(std::begin(kAovNames), std::end(kAovNames));
                           else
                               arguments.aovs.emplace_back(kAovNames[parseChoice(name, kAovNames)]);
                       }
                   });
    options.text("--sheet", "FILE", arguments.sheet, "one PNG of direct | indirect | both | difference");
    options.text("--report", "FILE", arguments.report, "a JSON file with device, settings and stage times");
}

FrameFiles::FrameFiles(const FrameFileArguments& arguments, OutputSet& outputs) : arguments_(arguments) {
    const bool hasPicture = !arguments.out.empty();
    if (hasPicture) requireEnding("--out", arguments.out, {".exr", ".png"});
    if (!arguments.sheet.empty()) requireEnding("--sheet", arguments.sheet, {".png"});
    if (!arguments.report.empty()) requireEnding("--report", arguments.report, {".json"});
    const auto announce = [&outputs](const fs::path& path) { return File{path, outputs.addFile(path)}; };
    const fs::path out = arguments.out;
    if (out.extension() == ".exr") {
        exr_ = announce(out);
        if (wants("rsm-depth") || wants("rsm-normal") || wants("rsm-flux"))
            rsm_ = announce(fs::path(out).replace_extension(".rsm.exr"));
        if (wants("shadow-depth")) shadow_ = announce(fs::path(out).replace_extension(".shadow.exr"));
    } else if (hasPicture && !arguments.aovs.empty()) {
        throw UsageError("--aov: needs an --out that ends in .exr");
    }
    if (hasPicture) png_ = announce(fs::path(out).replace_extension(".png"));
    if (!arguments.sheet.empty()) sheet_ = announce(arguments.sheet);
    if (!arguments.report.empty()) report_ = announce(arguments.report);
}

bool FrameFiles::wants(const char* aov) const {
    return std::find(arguments_.aovs.begin(), arguments_.aovs.end(), aov) != arguments_.aovs.end();
}

bool FrameFiles::needsInputs() const {
    constexpr const char* kOfInputs[] = {"albedo",    "normal",     "depth",    "motion",      "emission",
                                         "rsm-depth", "rsm-normal", "rsm-flux", "shadow-depth"};
    return std::any_of(std::begin(kOfInputs), std::end(kOfInputs), [this](const char* aov) { return wants(aov); });
}

void FrameFiles::check(const FrameInputs& frame) const {
    if (wants("motion") && frame.gbuffer.motion.empty()) throw InputError("--aov: these inputs have no motion");
    if (wants("emission") && frame.gbuffer.emission.empty()) throw InputError("--aov: these inputs have no emission");
    const bool wantsMaps = wants("rsm-depth") || wants("rsm-normal") || wants("rsm-flux") || wants("shadow-depth");
    if (wantsMaps && frame.lights.empty()) throw InputError("--aov: there is no light, so no map of one");
}

std::vector<NonFiniteLayer> FrameFiles::writePictures(Pipeline& pipeline, const FrameInputs& frame) const {
    std::vector<NonFiniteLayer> nonFinite;
    if (exr_) {
        ExrLayers layers;
        layers.add("", pipeline.read(Output::Color), kRgb);
        const GBuffer& g = frame.gbuffer;
        if (wants("albedo")) layers.add("albedo", g.albedo, kRgb);
        if (wants("normal")) layers.add("normal", g.normalWs, kXyz);
        if (wants("depth")) layers.add("depth", g.depth, kZ);
        if (wants("motion")) layers.add("motion", g.motion, kXyz);
        if (wants("emission")) layers.add("emission", g.emission, kRgb);
        for (const Output output :
             {Output::DirectIrradiance, Output::IndirectIrradiance, Output::Direct, Output::Indirect})
            if (const char* name = kOutputNames[int(output)]; wants(name))
                layers.add(name, pipeline.read(output), kRgb);
        layers.write(exr_->temporary, exr_->path, {{"earthshine:exposure", pipeline.exposure()}}, nonFinite);
    }
    if (rsm_) {
        ExrLayers layers;
        for (std::size_t i = 0; i < frame.lightMaps.size(); ++i) {
            const LightMaps& maps = frame.lightMaps[i];
            if (wants("rsm-depth")) layers.add(fmt::format("light{}.depth", i), maps.rsmDepth, kZ);
            if (wants("rsm-normal")) layers.add(fmt::format("light{}.normal", i), maps.rsmNormalWs, kXyz);
            if (wants("rsm-flux")) layers.add(fmt::format("light{}.flux", i), maps.rsmFlux, kRgb);
        }
        layers.write(rsm_->temporary, rsm_->path, {}, nonFinite);
    }
    if (shadow_) {
        ExrLayers layers;
        for (std::size_t i = 0; i < frame.lightMaps.size(); ++i)
            layers.add(fmt::format("light{}.shadow", i), frame.lightMaps[i].shadowDepth, kZ);
        layers.write(shadow_->temporary, shadow_->path, {}, nonFinite);
    }
    if (!png_ && !sheet_) return nonFinite;
    const HostImage both = pipeline.read(Output::Display);
    if (png_) writePng(png_->temporary, both.view());
    if (sheet_) {
        const HostImage direct = pipeline.toDisplay(pipeline.read(Output::Direct).view());
        const HostImage indirect = pipeline.toDisplay(pipeline.read(Output::Indirect).view());
        const HostImage difference = displayDifference(both.view(), direct.view(), 1.0f);
        const Panel panels[] = {{"direct", direct.view()},
                                {"indirect", indirect.view()},
                                {"both", both.view()},
                                {"difference (both - direct)", difference.view()}};
        writePng(sheet_->temporary, contactSheet(panels, 2).view());
    }
    return nonFinite;
}

void FrameFiles::writeReport(const std::string& text) const {
    if (!report_) return;
    std::ofstream stream(report_->temporary, std::ios::binary);
    stream << text << std::flush;
    if (!stream) throw Error(fmt::format("{}: cannot be written", report_->path.string()));
}

}  // namespace earthshine::cli
