// The denoiser against plain doubles at every width and storage, on every device here: temporal accumulation along
// motion, and history that is dropped when the light changes.
// What the stages start from is the picture of a pipeline that does not denoise.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "earthshine/pipeline.hpp"
#include "reference/denoiser_reference.hpp"
#include "reference/device_variants.hpp"
#include "stages/denoiser_fixture.hpp"

namespace earthshine {
namespace {

using reference::accumulate;
using reference::filterPass;
using reference::luminanceOf;
using reference::Memory;
using reference::Move;
using reference::wallsFrame;

/// Runs as many frames as there are and compares each with the reference.
void followFrames(const Device& device, const std::vector<const FrameImages*>& frames, Settings settings) {
    Pipeline raw(device), denoised(device);
    Settings noise = settings;
    noise.accumulates = false;
    settings.accumulates = true;
    Memory memory;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "frame " << i);
        raw.setFrame(frames[i]->inputs());
        denoised.setFrame(frames[i]->inputs());
        raw.run(noise);
        denoised.run(settings);
        memory =
            accumulate(*frames[i], *frames[i > 0 ? i - 1 : 0], memory, colors(raw.read(Output::IndirectIrradiance)),
                       {double(settings.historyFrames), double(settings.fireflyFactor), double(settings.antiLag),
                        settings.filterWeights == FilterWeights::Plane});
        expectNear(denoised.read(Output::IndirectIrradiance), memory.irradiance);
    }
}

TEST_P(Denoiser, HistoryFollowsMotion) {
    Settings settings = fewSamples();
    settings.historyFrames = 3;
    for (const Extent extent : {Extent{53, 21}, Extent{1, 1}, Extent{7, 3}}) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        const FrameImages frame = slidingWalls(extent);
        followFrames(device_, std::vector(5, &frame), settings);
    }
    const FrameImages large = slidingWalls({191, 347});
    followFrames(device_, std::vector(2, &large), settings);
}

// Pixels that stand beside others that move: what a pixel remembers does not depend on those that share its work-item.
TEST_P(Denoiser, HistoryStandsBesideMotion) {
    Settings settings = fewSamples();
    settings.historyFrames = 5;
    const FrameImages frame = wallsFrame({{53, 37}, true, true});
    followFrames(device_, std::vector(5, &frame), settings);
}

TEST_P(Denoiser, HistoryFollowsACameraThatMoves) {
    std::vector<FrameImages> frames;
    Move before(1.0);
    for (int i = 0; i < 5; ++i) {
        const glm::dvec3 path(0.05 * i, -0.02 * i, -0.11 * i);
        const Move now = glm::rotate(glm::translate(glm::dmat4(1.0), path), 0.013 * i, glm::dvec3(0.3, 1.0, 0.1));
        frames.push_back(wallsFrame({{53, 37}, false, false, before, now}));
        before = now;
    }
    std::vector<const FrameImages*> all;
    for (const FrameImages& frame : frames) all.push_back(&frame);
    followFrames(device_, all, fewSamples());
}

// Normals that differ from pixel to pixel, as of leaves: a tap that is turned counts for less, and for fewer frames;
// for comparison with the field's weights, up to an angle in full.
TEST_P(Denoiser, HistoryOfWhatIsTurnedCountsForLess) {
    Settings settings = fewSamples();
    settings.historyFrames = 6;
    for (const FilterWeights weights : {FilterWeights::Plane, FilterWeights::Depth}) {
        SCOPED_TRACE(kFilterWeightsNames[int(weights)]);
        settings.filterWeights = weights;
        const FrameImages rough = wallsFrame({{53, 37}, true, true, Move(1.0), Move(1.0), true});
        followFrames(device_, std::vector(6, &rough), settings);
        // What rests, but has turned; and what has not, whose normals of 16 bits are not quite of length 1.
        FrameImages smooth = wallsFrame({{53, 37}, false});
        FrameImages turned = wallsFrame({{53, 37}, false, false, Move(1.0), Move(1.0), true});
        followFrames(device_, {&smooth, &smooth, &turned, &turned, &turned, &smooth}, settings);
    }
}

// With a bound that noise reaches, all degrees of confidence occur.
TEST_P(Denoiser, HistoryIsBelievedAsFarAsItFits) {
    Settings settings = fewSamples();
    settings.antiLag = 4.0f;
    settings.fireflyFactor = 2.0f;
    for (const Extent extent : {Extent{53, 37}, Extent{7, 3}, Extent{1, 1}}) {
        SCOPED_TRACE(testing::Message() << extent.widthPx << " x " << extent.heightPx);
        for (const bool hasBlock : {false, true}) {
            const FrameImages frame = wallsFrame({extent, true, hasBlock});
            followFrames(device_, std::vector(6, &frame), settings);
        }
    }
}

// What another size, resolution or guide left behind is no history, and neither are its tiles' sums.
TEST_P(Denoiser, AnotherSizeOrSettingBeginsAnew) {
    const FrameImages wide = slidingWalls({53, 37}), tall = slidingWalls({37, 53});
    Settings plain = fewSamples(), guided, half;
    plain.antiLag = 16.0f;
    guided = half = plain;
    guided.filterIterations = 1;
    guided.filterLuminance = 2.0f;
    guided.feedback = 1;  // else lone pixels are limited in one of the pictures that are compared below
    half.divisor = 2;
    Pipeline raw(device_), denoised(device_);
    const auto see = [&](const FrameImages& frame, Settings settings) {
        raw.setFrame(frame.inputs());
        raw.run(settings);
        settings.accumulates = true;
        denoised.setFrame(frame.inputs());
        denoised.run(settings);
    };
    for (const auto& [frame, settings] :
         {std::pair{&tall, &plain}, std::pair{&wide, &plain}, std::pair{&wide, &guided}, std::pair{&wide, &half}}) {
        for (int i = 0; i < 3; ++i) see(wide, plain);
        see(frame == &wide && settings == &plain ? tall : wide, plain);
        see(*frame, *settings);
        expectNear(denoised.read(Output::IndirectIrradiance), colors(raw.read(Output::IndirectIrradiance)));
    }
}

TEST_P(Denoiser, FirefliesAreLimitedAndTheirMomentsGuideTheFilter) {
    const FrameImages frame = slidingWalls({53, 21});
    Pipeline raw(device_), denoised(device_);
    raw.setFrame(frame.inputs());
    denoised.setFrame(frame.inputs());
    Settings settings = fewSamples();
    settings.accumulates = true;
    settings.fireflyFactor = 1.5f;
    settings.filterIterations = 2;
    settings.filterFade = 4.0f;
    settings.filterLuminance = 3.0f;
    settings.filterKernel = FilterKernel::Square3x3;
    for (const int feedback : {0, 1}) {
        settings.feedback = feedback;
        Memory memory;
        raw.forgetHistory();
        denoised.forgetHistory();
        for (int i = 0; i < 7; ++i) {
            SCOPED_TRACE(testing::Message() << "feedback " << feedback << ", frame " << i);
            raw.run(fewSamples());
            denoised.run(settings);
            memory = accumulate(frame, frame, memory, colors(raw.read(Output::IndirectIrradiance)), {32.0, 1.5, 0.0});
            const auto once = filterPass(frame, memory.irradiance, settings, 1, 1, 1, &memory);
            expectNear(denoised.read(Output::IndirectIrradiance), filterPass(frame, once, settings, 1, 1, 2, &memory));
            if (feedback > 0) memory.irradiance = once;
        }
    }
}

// Among normals that differ from pixel to pixel many pixels have no neighbour of their own: while they are young they
// are limited by what is around them, in the picture only. History is not, nor is a picture that no history will
// correct; and of a picture at rest next to nothing is taken once its history is long.
TEST_P(Denoiser, LonePixelsAreLimitedWhileTheyAreYoung) {
    const FrameImages frame = wallsFrame({{53, 37}, false, false, Move(1.0), Move(1.0), true});
    Pipeline raw(device_), denoised(device_);
    raw.setFrame(frame.inputs());
    denoised.setFrame(frame.inputs());
    const auto compare = [&](FilterKernel kernel, bool accumulates, int frames) {
        SCOPED_TRACE(testing::Message() << kFilterKernelNames[int(kernel)] << ", accumulate " << accumulates);
        Settings settings = fewSamples();
        settings.accumulates = accumulates;
        settings.filterIterations = 1;
        settings.filterKernel = kernel;
        Settings unlimited = settings;
        unlimited.accumulates = false;
        Memory memory;
        raw.forgetHistory();
        denoised.forgetHistory();
        std::vector<double> taken;  // of the picture's light
        for (int i = 0; i < frames; ++i) {
            SCOPED_TRACE(testing::Message() << "frame " << i);
            raw.run(fewSamples());
            denoised.run(settings);
            memory = accumulate(frame, frame, accumulates ? memory : Memory{},
                                colors(raw.read(Output::IndirectIrradiance)), {});
            const auto filtered = [&](const Settings& s) {
                if (kernel == FilterKernel::Separable)
                    return filterPass(frame, filterPass(frame, memory.irradiance, s, 2, 0, 1, &memory), s, 0, 2, 1,
                                      &memory);
                const int radius = kernel == FilterKernel::Square3x3 ? 1 : 2;
                return filterPass(frame, memory.irradiance, s, radius, radius, 1, &memory);
            };
            const std::vector<glm::dvec3> expected = filtered(settings);
            expectNear(denoised.read(Output::IndirectIrradiance), expected);
            taken.push_back(1.0 - meanOf(expected) / meanOf(filtered(unlimited)));
        }
        return taken;
    };
    for (const FilterKernel kernel : {FilterKernel::Separable, FilterKernel::Square3x3, FilterKernel::Square5x5}) {
        EXPECT_GT(compare(kernel, true, 2).front(), 0.01);
        EXPECT_EQ(compare(kernel, false, 1).front(), 0.0);
    }
    EXPECT_LT(compare(FilterKernel::Separable, true, 32).back(), 1e-3);
}

// Picked at half and a fourth: what is interpolated lies between what the picks have, what is gathered in full is as if
// nothing had been left out; and history works at lower resolution as at the picture's own.
TEST_P(Denoiser, LowerResolutions) {
    const FrameImages frame = slidingWalls({53, 37});
    Pipeline pipeline(device_);
    FrameInputs inputs = frame.inputs();
    inputs.gbuffer.motion = {};
    pipeline.setFrame(inputs);
    Settings settings = fewSamples();
    settings.sampleCount = 256;
    settings.animatesNoise = false;
    pipeline.run(settings);
    const std::vector<glm::dvec3> full = colors(pipeline.read(Output::IndirectIrradiance));
    EXPECT_EQ(pipeline.gatheredPixels(), 0);
    double mean = 0.0;
    for (const glm::dvec3& e : full) mean += luminanceOf(e);
    for (const int divisor : {2, 4}) {
        settings.divisor = divisor;
        for (const Upsampling upsampling : {Upsampling::Bilateral, Upsampling::Interpolate}) {
            SCOPED_TRACE(testing::Message() << "1/" << divisor << ", " << kUpsamplingNames[int(upsampling)]);
            settings.upsampling = upsampling;
            settings.accumulates = false;
            pipeline.run(settings);
            const HostImage once = pipeline.read(Output::IndirectIrradiance);
            const std::vector<glm::dvec3> low = colors(once);
            int same = 0, lit = 0;
            double lowMean = 0.0;
            for (std::size_t i = 0; i < full.size(); ++i) {
                lowMean += luminanceOf(low[i]);
                if (full[i] == glm::dvec3(0.0)) continue;
                ++lit;
                if (std::fabs(low[i].y - full[i].y) <= 1e-4 * full[i].y) ++same;
            }
            EXPECT_NEAR(lowMean / mean, 1.0, 0.1);  // noise of 256 samples, at a fourth or a sixteenth of the pixels
            if (upsampling == Upsampling::Interpolate) {
                EXPECT_GT(pipeline.gatheredPixels(), 0);
                EXPECT_LT(pipeline.gatheredPixels(), lit);
                EXPECT_GE(same, pipeline.gatheredPixels());
            } else {
                EXPECT_EQ(pipeline.gatheredPixels(), 0);
            }
            // The same frame again and again is its own mean.
            settings.accumulates = true;
            pipeline.forgetHistory();
            for (int i = 0; i < 3; ++i) pipeline.run(settings);
            expectNear(pipeline.read(Output::IndirectIrradiance), low);
        }
    }
}

// The thieves of energy are rounding and a blur that is fed back: the mean must be that of frames as they come.
class DenoiserOverTime : public Denoiser {};

TEST_P(DenoiserOverTime, NothingDriftsOver500Frames) {
    const FrameImages frame = slidingWalls({53, 37});
    FrameInputs inputs = frame.inputs();
    inputs.gbuffer.motion = {};
    Settings settings = settingsOf(Preset::Balanced);
    Settings noise = settings;
    noise.accumulates = false;
    noise.filterIterations = 0;
    Pipeline raw(device_);
    raw.setFrame(inputs);
    double truth = 0.0;
    for (int i = 0; i < 500; ++i) {
        raw.run(noise);
        truth += meanOf(colors(raw.read(Output::IndirectIrradiance))) / 500.0;
    }
    for (const int feedback : {0, 1}) {
        // Not the spatial filter's last word, whose edges weigh pixels unlike: what history holds, and what is fed
        // back.
        settings.filterIterations = feedback;
        settings.feedback = feedback;
        Pipeline pipeline(device_);
        pipeline.setFrame(inputs);
        double late = 0.0;
        for (int i = 0; i < 500; ++i) {
            pipeline.run(settings);
            if (i >= 436) late += meanOf(colors(pipeline.read(Output::IndirectIrradiance))) / 64.0;
        }

        EXPECT_NEAR(late / truth, 1.0, 0.005) << "feedback " << feedback;
    }
}

// Eight frames after the light has jumped to another place, nothing of the old light is left: of the old picture less
// the new one, which noise knows nothing of, the denoised picture holds no part.
TEST_P(DenoiserOverTime, ALightThatJumpsLeavesNoGhostAfterEightFrames) {
    const FrameImages before = slidingWalls({160, 120});
    FrameImages after = slidingWalls({160, 120});
    const Extent maps = after.rsmFlux.extent();
    for (int y = 0; y < maps.heightPx; ++y)  // what was lit from one half is lit, four times as much, from the other
        for (int x = 0; x < maps.widthPx; ++x)
            for (int c = 0; c < 3; ++c) after.rsmFlux.pixel(x, y)[c] *= 2 * x < maps.widthPx ? 4.0f : 0.0f;
    Pipeline pipeline(device_);
    const auto see = [&](const FrameImages& frame, const Settings& settings, int frames) {
        FrameInputs inputs = frame.inputs();
        inputs.gbuffer.motion = {};
        pipeline.setFrame(inputs);
        for (int i = 0; i < frames; ++i) pipeline.run(settings);
        return colors(pipeline.read(Output::IndirectIrradiance));
    };
    Settings sum;
    sum.estimator = Estimator::Sum;
    const std::vector<glm::dvec3> oldLight = see(before, sum, 1), newLight = see(after, sum, 1);
    const auto ghostOf = [&](float antiLag, bool hasPast) {
        Settings settings = settingsOf(Preset::Balanced);
        settings.antiLag = antiLag;
        pipeline.forgetHistory();
        if (hasPast) see(before, settings, 40);
        const std::vector<glm::dvec3> picture = see(after, settings, 8);
        double shared = 0.0, all = 0.0;
        for (std::size_t i = 0; i < picture.size(); ++i) {
            const double change = luminanceOf(oldLight[i]) - luminanceOf(newLight[i]);
            shared += change * (luminanceOf(picture[i]) - luminanceOf(newLight[i]));
            all += change * change;
        }
        return shared / all;
    };
    const float antiLag = Settings().antiLag;
    // What the filter blurs of the new light looks like a bit of another: that part a picture without a past has too.
    const double blur = ghostOf(antiLag, false);
    EXPECT_LT(std::fabs(ghostOf(antiLag, true) - blur), 0.05);
    EXPECT_GT(ghostOf(0.0f, true) - blur, 0.5);
}

TEST_P(Denoiser, ALightThatGoesOutLeavesNoGhost) {
    const FrameImages lit = slidingWalls({53, 37});
    FrameImages dark = slidingWalls({53, 37});
    std::fill_n(dark.rsmFlux.data(), dark.rsmFlux.sizeBytes(), std::byte(0));
    const auto peakAfter = [&](float antiLag) {
        Pipeline pipeline(device_);
        Settings settings = fewSamples();
        settings.accumulates = true;
        settings.antiLag = antiLag;
        FrameInputs inputs = lit.inputs();
        inputs.gbuffer.motion = {};  // at rest: what moved in from the border would have no history to forget
        pipeline.setFrame(inputs);
        for (int i = 0; i < 16; ++i) pipeline.run(settings);
        inputs = dark.inputs();
        inputs.gbuffer.motion = {};
        pipeline.setFrame(inputs);
        for (int i = 0; i < 4; ++i) pipeline.run(settings);
        double peak = 0.0;
        for (const glm::dvec3& e : colors(pipeline.read(Output::IndirectIrradiance))) peak = std::max(peak, e.y);
        return peak;
    };
    EXPECT_GT(peakAfter(0.0f), 0.0);
    EXPECT_LT(peakAfter(16.0f), 0.02 * peakAfter(0.0f));
}

INSTANTIATE_TEST_SUITE_P(All, DenoiserOverTime, testing::ValuesIn(reference::defaultVariants()),
                         [](const auto& variant) { return variant.param.name; });
INSTANTIATE_TEST_SUITE_P(All, Denoiser, testing::ValuesIn(reference::quickVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
