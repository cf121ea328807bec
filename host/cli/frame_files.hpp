#pragma once
// The pictures that a computed frame becomes: the same options and the same files for every command that computes.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "earthshine/pipeline.hpp"
#include "image/output_set.hpp"

namespace earthshine::cli {

struct FrameFileArguments {
    std::string out;                ///< .exr or .png; "" = none
    std::string sheet;              ///< .png; "" = none
    std::string report;             ///< .json; "" = none
    std::vector<std::string> aovs;  ///< of kAovNames
};

/// What may be asked for beside the picture. The maps of lights are not of the picture's extent, and go into files of
/// their own beside it: picture.rsm.exr and picture.shadow.exr.
inline constexpr const char* kAovNames[] = {
    "albedo", "normal",   "depth",     "motion",     "emission", "direct-irradiance", "indirect-irradiance",
    "direct", "indirect", "rsm-depth", "rsm-normal", "rsm-flux", "shadow-depth"};

void addFrameFileOptions(Options& options, FrameFileArguments& arguments);

/// How many values of one layer are not finite.
struct NonFiniteLayer {
    std::string layer;
    std::size_t count = 0;
};

class FrameFiles {
public:
    /// Announces every file. Throws UsageError for names that do not end as they should, or as OutputSet does.
    FrameFiles(const FrameFileArguments& arguments, OutputSet& outputs);

    /// Do the pictures need the frame's own images, and not only what the pipeline computes?
    bool needsInputs() const;

    /// Throws InputError if an AOV is asked for that the frame does not have. Before run().
    void check(const FrameInputs& frame) const;

    /// Writes the pictures of the pipeline's last run; `frame` may be empty if they do not need it. Warns of values
    /// that are not finite, and returns their counts, one entry a layer.
    std::vector<NonFiniteLayer> writePictures(Pipeline& pipeline, const FrameInputs& frame) const;

    /// Writes the report, if one was asked for.
    void writeReport(const std::string& text) const;

private:
    struct File {
        std::filesystem::path path, temporary;
    };
    bool wants(const char* aov) const;

    FrameFileArguments arguments_;
    std::optional<File> exr_, png_, rsm_, shadow_, sheet_, report_;
};

}  // namespace earthshine::cli
