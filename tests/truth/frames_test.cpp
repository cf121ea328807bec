// A mean over frames: each frame moves the pattern on, so that frames add up to one long pattern instead of repeating
// themselves or rolling dice.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "reference/device_variants.hpp"
#include "truth/truth_scene.hpp"

namespace earthshine::truth {
namespace {

class Frames : public testing::Test {
protected:
    // Mean of the indirect irradiance over frames of a fresh pipeline, first channel.
    std::vector<double> meanOver(int frameCount, const FrameImages& frame, const Settings& settings) {
        Pipeline pipeline(device_);
        pipeline.setFrame(frame.inputs());
        std::vector<double> mean;
        for (int i = 0; i < frameCount; ++i) {
            pipeline.run(settings);
            const HostImage image = pipeline.read(Output::IndirectIrradiance);
            mean.resize(std::size_t(image.extent().widthPx) * std::size_t(image.extent().heightPx));
            for (std::size_t p = 0; p < mean.size(); ++p) mean[p] += double(image.pixel(0, 0)[4 * p]) / frameCount;
        }
        return mean;
    }

    // Root of the mean square of the relative difference.
    static double rms(const std::vector<double>& a, const std::vector<double>& truth) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(a[i] / truth[i] - 1.0, 2.0);
        return std::sqrt(sum / double(a.size()));
    }

    reference::Variant variant_ = reference::defaultVariants().at(0);
    Device device_{variant_.caps, variant_.options};
};

TEST_F(Frames, AddUpToOneLongPattern) {
    const Rectangle emitter{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}, above{{0, 1, -1}, {1, 0, 0}, {0, 0, 1}};
    raster::Scene scene;
    addRectangle(scene, emitter, 0.5);
    addRectangle(scene, above, 1.0);
    const FrameImages frame = DrawnScene(scene).draw(squareView(above), {64, 64}, beamOnto(emitter, 1000.0, 1.0), 256);
    const std::vector<double> truth = meanOver(1, frame, fullSum());
    for (const int samples : {3, 8, 13, 32}) {
        Settings settings = wholeDisk(samples);
        settings.animatesNoise = true;
        const double one = rms(meanOver(1, frame, settings), truth);
        for (const int frames : {4, 16, 64}) {
            SCOPED_TRACE(fmt::format("{} samples in each of {} frames", samples, frames));
            const double mean = rms(meanOver(frames, frame, settings), truth);
            const double longPattern = rms(meanOver(1, frame, wholeDisk(samples * frames)), truth);
            const double independent = one / std::sqrt(double(frames));
            RecordProperty(fmt::format("{}spp_{}frames", samples, frames),
                           fmt::format("{:.4f} long {:.4f} independent {:.4f}", mean, longPattern, independent));
            // Measured: 1.1 to 1.6 times the error of as many samples in one Hammersley pattern, which knows its
            // length; of what independent frames would leave 0.78 at 4, 0.65 to 0.70 at 16, 0.40 to 0.47 at 64 frames.
            EXPECT_LT(mean, 1.7 * longPattern);
            EXPECT_LT(mean, (frames == 4 ? 0.85 : frames == 16 ? 0.75 : 0.5) * independent);
        }
    }
}

TEST_F(Frames, RepeatThemselvesOnRequest) {
    const Rectangle emitter{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}, above{{0, 1, -1}, {1, 0, 0}, {0, 0, 1}};
    raster::Scene scene;
    addRectangle(scene, emitter, 0.5);
    addRectangle(scene, above, 1.0);
    const FrameImages frame = DrawnScene(scene).draw(squareView(above), {16, 16}, beamOnto(emitter, 1000.0, 1.0), 64);
    Settings settings = wholeDisk(8);
    EXPECT_EQ(meanOver(4, frame, settings), meanOver(1, frame, settings));  // sums of four equal floats are exact
    settings.animatesNoise = true;
    EXPECT_NE(meanOver(4, frame, settings), meanOver(1, frame, settings));
}

}  // namespace
}  // namespace earthshine::truth
