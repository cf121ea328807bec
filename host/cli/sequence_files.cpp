#include "cli/sequence_files.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace fs = std::filesystem;

namespace earthshine::cli {

namespace {

bool isNumbered(const std::string& path) {
    return fs::path(path).filename().string().find('#') != std::string::npos;
}

/// What is written of the last frame alone.
FrameFileArguments unnumbered(FrameFileArguments arguments) {
    if (isNumbered(arguments.out)) arguments.out.clear();
    if (isNumbered(arguments.sheet)) arguments.sheet.clear();
    return arguments;
}

}  // namespace

std::string numbered(const char* option, const std::string& path, int frame) {
    const fs::path whole = path;
    std::string name = whole.filename().string();
    const auto first = name.find('#');
    if (first == std::string::npos) return path;
    const auto end = std::min(name.find_first_not_of('#', first), name.size());
    if (name.find('#', end) != std::string::npos)
        throw UsageError(fmt::format("{}: '{}' has more than one run of #", option, path));
    name.replace(first, end - first, fmt::format("{:0{}}", frame, end - first));
    return (whole.parent_path() / name).string();
}

SequenceFiles::SequenceFiles(const FrameFileArguments& arguments, const std::string& film, int firstFrame,
                             int frameCount, OutputSet& outputs)
    : arguments_(arguments),
      lastFrame_(frameCount - 1),
      outputs_(outputs),
      last_(unnumbered(arguments), outputs),
      numbersFrames_(isNumbered(arguments.out) || isNumbered(arguments.sheet)) {
    if (!film.empty()) {
        ffmpeg_ = findFfmpeg(film);
        filmPath_ = film;
        filmTemporary_ = outputs.addFile(filmPath_);
    }
    if (!numbersFrames_) return;
    // What can be refused is refused before anything slow is done, the frames' names beside those announced, too. Of a
    // very long sequence the first frames and the last stand for all: each costs files that are made and removed.
    constexpr int kMostTried = 256;
    OutputSet rehearsal;
    for (const fs::path& path : outputs.paths()) rehearsal.addFile(path);
    for (int frame = firstFrame; frame < frameCount; ++frame)
        if (frame - firstFrame < kMostTried || frame == lastFrame_) FrameFiles(numberedArguments(frame), rehearsal);
}

FrameFileArguments SequenceFiles::numberedArguments(int frame) const {
    FrameFileArguments result = arguments_;
    result.out = isNumbered(arguments_.out) ? numbered("--out", arguments_.out, frame) : "";
    result.sheet = isNumbered(arguments_.sheet) ? numbered("--sheet", arguments_.sheet, frame) : "";
    result.report.clear();
    return result;
}

void SequenceFiles::begin(Extent extent, double framesPerSecond) {
    if (!filmPath_.empty()) film_.emplace(ffmpeg_, filmPath_, filmTemporary_, extent, framesPerSecond);
}

void SequenceFiles::write(int frame, Pipeline& pipeline, const FrameInputs& inputs) {
    if (numbersFrames_) {
        OutputSet outputs;
        const FrameFiles files(numberedArguments(frame), outputs);
        add(files.writePictures(pipeline, inputs));
        for (const fs::path& path : outputs.paths()) framePaths_.push_back(path);
        outputs.commit();
    }
    if (film_) film_->add(pipeline.read(Output::Display).view());
    if (frame == lastFrame_) add(last_.writePictures(pipeline, inputs));
}

void SequenceFiles::add(const std::vector<NonFiniteLayer>& layers) {
    for (const NonFiniteLayer& layer : layers) {
        const auto same = std::find_if(nonFinite_.begin(), nonFinite_.end(),
                                       [&](const NonFiniteLayer& other) { return other.layer == layer.layer; });
        if (same == nonFinite_.end())
            nonFinite_.push_back(layer);
        else
            same->count += layer.count;
    }
}

std::vector<fs::path> SequenceFiles::paths() const {
    std::vector<fs::path> result = framePaths_;
    for (const fs::path& path : outputs_.paths()) result.push_back(path);
    return result;
}

void SequenceFiles::finish(const std::string& report) {
    if (film_) film_->finish();
    last_.writeReport(report);
}

}  // namespace earthshine::cli
