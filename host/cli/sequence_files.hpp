#pragma once
// The files of a sequence: pictures of every frame, of the last one, and a film.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/film.hpp"
#include "cli/frame_files.hpp"

namespace earthshine::cli {

/// `path` with the run of # in its file's name, if there is one, replaced by `frame`, padded with zeros to that length.
/// Throws UsageError, after `option`, if there are two runs.
std::string numbered(const char* option, const std::string& path, int frame);

/// Files whose name has a run of # are written for every frame, and are in place when the frame is done, so that what
/// was rendered outlasts a run that is cut short. The others hold the last frame and come with the commit of the
/// OutputSet.
class SequenceFiles {
public:
    /// Announces every file of the frames [firstFrame; frameCount), and tries out those of single frames. Throws as
    /// FrameFiles, and Error if a film is asked for and there is no ffmpeg.
    SequenceFiles(const FrameFileArguments& arguments, const std::string& film, int firstFrame, int frameCount,
                  OutputSet& outputs);

    /// Starts the film, if there is one. Throws as Film.
    void begin(Extent extent, double framesPerSecond);

    /// As FrameFiles::needsInputs.
    bool needsInputs() const { return last_.needsInputs(); }

    /// As FrameFiles::check. Before run().
    void check(const FrameInputs& frame) const { last_.check(frame); }

    /// Writes what belongs to this frame, the pipeline's last. Warns of values that are not finite.
    void write(int frame, Pipeline& pipeline, const FrameInputs& inputs);

    /// How many values were not finite, in all frames written so far; one entry a layer.
    const std::vector<NonFiniteLayer>& nonFinite() const { return nonFinite_; }

    /// The files of single frames written so far, and those announced. Before the commit of the OutputSet.
    std::vector<std::filesystem::path> paths() const;

    /// Ends the film, and writes the report, if one was asked for.
    void finish(const std::string& report);

private:
    FrameFileArguments numberedArguments(int frame) const;
    void add(const std::vector<NonFiniteLayer>& layers);

    FrameFileArguments arguments_;
    int lastFrame_;
    OutputSet& outputs_;
    FrameFiles last_;
    bool numbersFrames_;
    std::vector<std::filesystem::path> framePaths_;
    std::vector<NonFiniteLayer> nonFinite_;

    std::filesystem::path ffmpeg_, filmPath_, filmTemporary_;
    std::optional<Film> film_;
};

}  // namespace earthshine::cli
