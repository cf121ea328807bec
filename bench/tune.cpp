// Lanes x storage first, with the groups of the table, for they decide most and every kernel shares surfaces; then, for
// what won, the group of each kernel. What is measured is the pipeline itself, by its stage times, on frames that
// between them launch every kernel but the full sum. Candidates take turns, round by round, since other programs come
// and go. One replaces what the table says only if it loses in no round and wins in the median one by kMinGain, and by
// more than the table's own, measured twice a round, differs from itself.

#include "tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compute/tuning.hpp"
#include "compute/tuning_table.hpp"
#include "earthshine/error.hpp"
#include "earthshine/pipeline.hpp"
#include "revision.hpp"
#include "room_frame.hpp"
#include "tune_arguments.hpp"

namespace earthshine::bench {

namespace {

constexpr double kMinGain = 1.05;    // what repeats of one candidate differ by on a machine with other programs
constexpr double kMinShare = 0.01;   // of all kernels' time: a kernel below it keeps the table's group
constexpr double kOutOfReach = 2.0;  // times the best of the first round: not measured again
// Timed frames of a round, after one that compiles and allocates: enough to meet quiet moments, few on slow devices.
constexpr int kMinFrames = 3, kMaxFrames = 10;
constexpr double kEnoughMs = 300.0, kTooLongMs = 2000.0;
constexpr int kRsmSizePx = 512;

struct Group {
    int x = 0, y = 0;  ///< 0 = the table's
    bool operator==(const Group&) const = default;
};
// Whole rows, squares and what lies between, of 32 to 256 work-items.
constexpr Group kGroups[] = {{8, 4},  {8, 8},  {16, 2}, {16, 4}, {16, 8},  {16, 16}, {32, 1},
                             {32, 4}, {32, 8}, {64, 1}, {64, 4}, {128, 1}, {128, 2}, {256, 1}};

std::string nameOf(Group group) {
    return group == Group{} ? "the table's groups" : fmt::format("{}x{}", group.x, group.y);
}

/// One frame that is measured.
struct Scenario {
    Settings settings;
    bool moves = false;
};

// The balanced preset first: its times decide lanes and storage. The others launch what it does not, and read history
// where it moved.
std::vector<Scenario> makeScenarios() {
    Scenario balanced{settingsOf(Preset::Balanced), false};
    Scenario tile = balanced, bilateral = balanced, interpolate = balanced;
    tile.moves = true;
    tile.settings.rotation = Rotation::Tile;
    tile.settings.pattern = DiskPattern::Line;
    tile.settings.mapping = RadiusMapping::Squared;
    tile.settings.rsmMinify = 2;
    tile.settings.filterKernel = FilterKernel::Square3x3;
    bilateral.settings.divisor = interpolate.settings.divisor = 2;
    bilateral.settings.upsampling = Upsampling::Bilateral;
    bilateral.settings.rotation = Rotation::Coherent;  // the other two gather at random
    interpolate.settings.upsampling = Upsampling::Interpolate;
    return {balanced, tile, bilateral, interpolate};
}

struct Frames {
    FrameImages still, moving;
};

Frames makeFrames(Extent extent) {
    Frames frames{makeRoomFrame(extent, kRsmSizePx), makeRoomFrame(extent, kRsmSizePx)};
    HostImage motion(PixelFormat::RGBA32F, extent);
    for (int y = 0; y < extent.heightPx; ++y)
        for (int x = 0; x < extent.widthPx; ++x) {
            motion.pixel(x, y)[0] = 1.3f;
            motion.pixel(x, y)[1] = 0.6f;
        }
    frames.still.motion = {};
    frames.moving.motion = toHalf(motion.view());
    return frames;
}

/// Milliseconds of each kernel in one round: the least over the timed frames, summed over the scenarios.
struct Times {
    std::map<std::string, double> kernels;
    double frame = 0.0, indirect = 0.0;  ///< of the balanced frame

    void add(const std::map<std::string, double>& least, bool isBalanced) {
        static const std::set<std::string> kDirect{"unpack", "direct_light", "luminance_sum", "exposure", "tone_map"};
        for (const auto& [kernel, ms] : least) {
            kernels[kernel] += ms;
            if (!isBalanced) continue;
            frame += ms;
            if (!kDirect.contains(kernel)) indirect += ms;
        }
    }
};

struct Candidate {
    int lanes = 0;
    std::string storage;
    Group group;
    std::vector<Times> rounds;
    std::string rejected;  ///< why
    bool isDropped = false;

    std::string name() const { return fmt::format("{} lanes, {}, {}", lanes, storage, nameOf(group)); }
    double best(const auto& of) const {
        double least = INFINITY;
        for (const Times& round : rounds) least = std::min(least, of(round));
        return least;
    }
};

/// What a scenario makes, to be compared.
struct Pictures {
    HostImage color, display;
};

// Like the tests of stages: floats differ by rounding, 2e-3 of a value or of the picture's mean; and where a threshold
// is met to the last bit, a pixel may be decided otherwise, which a wrong kernel does not do in so few.
constexpr double kRelative = 2e-3, kMaxOddPixels = 1e-4;

double oddPixels(const Pictures& expected, const Pictures& actual) {
    const Extent extent = expected.color.extent();
    const std::size_t count = std::size_t(extent.widthPx) * std::size_t(extent.heightPx);
    const float *a = expected.color.pixel(0, 0), *b = actual.color.pixel(0, 0);
    double mean = 0.0;
    for (std::size_t i = 0; i < count; ++i)
        mean += double(a[4 * i] + a[4 * i + 1] + a[4 * i + 2]) / (3.0 * double(count));
    const auto* bytesA = reinterpret_cast<const unsigned char*>(expected.display.data());
    const auto* bytesB = reinterpret_cast<const unsigned char*>(actual.display.data());
    std::size_t odd = 0;
    for (std::size_t i = 0; i < 4 * count; i += 4) {
        bool isOdd = false;
        for (std::size_t c = i; c < i + 3; ++c) {
            isOdd |= !(std::fabs(double(a[c]) - double(b[c])) <= kRelative * (std::fabs(double(a[c])) + mean));
            isOdd |= std::abs(int(bytesA[c]) - int(bytesB[c])) > 1;
        }
        odd += isOdd ? 1 : 0;
    }
    return double(odd) / double(count);
}

double medianOf(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[(values.size() - 1) / 2];
}

class Tuner {
public:
    Tuner(const DeviceCaps& caps, const TuneArguments& arguments)
        : caps_(caps),
          arguments_(arguments),
          table_(defaultTuning(caps)),
          scenarios_(makeScenarios()),
          frames_(makeFrames(arguments.extent)) {}

    std::vector<TuningRow> run() {
        fmt::print("{} ({}, {}), {} x {}, {} rounds; the table: {} lanes, {}, {} x {}\n", caps_.name,
                   caps_.platformName, caps_.driverVersion, arguments_.extent.widthPx, arguments_.extent.heightPx,
                   arguments_.rounds, table_.lanes, storageName(table_.storage), table_.localSizePx[0],
                   table_.localSizePx[1]);
        if (!arguments_.groupsOnly) return chooseGroups(chooseWay());
        Candidate tables;
        tables.lanes = table_.lanes;
        tables.storage = storageName(table_.storage);
        return chooseGroups(tables);
    }

private:
    // Opens a pipeline, measures it for one round, and closes it: a round holds the memory of one.
    void measure(Candidate& candidate, std::size_t scenarioCount, int round) {
        if (!candidate.rejected.empty() || candidate.isDropped) return;
        DeviceOptions options;
        options.profiling = true;
        options.lanes = candidate.lanes;
        options.storage = candidate.storage;
        options.localSizePx[0] = candidate.group.x;
        options.localSizePx[1] = candidate.group.y;
        try {
            Pipeline pipeline{Device(caps_, options)};
            Times times;
            for (std::size_t s = 0; s < scenarioCount && candidate.rejected.empty(); ++s)
                measure(pipeline, candidate, s, round == 0, times);
            candidate.rounds.push_back(times);
            fmt::print(stderr, "round {}: {}: {:.2f} ms {}\n", round + 1, candidate.name(), times.frame,
                       candidate.rejected);
        } catch (const Error& error) {
            candidate.rejected = error.what();
            fmt::print(stderr, "round {}: {}: {}\n", round + 1, candidate.name(), candidate.rejected);
        }
    }

    void measure(Pipeline& pipeline, Candidate& candidate, std::size_t s, bool compares, Times& times) {
        const Scenario& scenario = scenarios_[s];
        pipeline.setFrame((scenario.moves ? frames_.moving : frames_.still).inputs());
        pipeline.forgetHistory();
        pipeline.run(scenario.settings);
        std::map<std::string, double> least;
        double spentMs = 0.0;
        for (int i = 0; spentMs < (i < kMinFrames ? kTooLongMs : kEnoughMs) && i < kMaxFrames; ++i) {
            pipeline.run(scenario.settings);
            if (i == 0 && compares) compare(pipeline, candidate, s);
            for (const StageTime& time : pipeline.stageTimes()) {
                const auto at = least.try_emplace(time.stage, INFINITY).first;
                at->second = std::min(at->second, time.ms);
                spentMs += time.ms;
            }
        }
        times.add(least, s == 0);
    }

    // The first candidate of a storage has one lane: what it makes is what the others must make.
    void compare(Pipeline& pipeline, Candidate& candidate, std::size_t s) {
        Pictures pictures{pipeline.read(Output::Color), pipeline.read(Output::Display)};
        auto& expected = expected_[candidate.storage];
        expected.resize(scenarios_.size());
        if (!expected[s]) {
            if (candidate.lanes != 1) throw UsageError("tune: one lane must be measured first");
            expected[s] = std::move(pictures);
            return;
        }
        const double odd = oddPixels(*expected[s], pictures);
        if (odd > kMaxOddPixels)
            candidate.rejected = fmt::format("{:.3g} % of pixels differ from one lane's", 100.0 * odd);
    }

    // Is `candidate` faster than `base`, round by round, beyond what repeats of one differ by? The median ratio, or 0.
    double gain(const Candidate& base, const Candidate& candidate, const auto& of, double spread = 0.0) const {
        if (!candidate.rejected.empty() || candidate.rounds.size() < base.rounds.size()) return 0.0;
        std::vector<double> ratios;
        for (std::size_t i = 0; i < base.rounds.size(); ++i)
            ratios.push_back(of(base.rounds[i]) / of(candidate.rounds[i]));
        const double median = medianOf(ratios);
        const double least = *std::min_element(ratios.begin(), ratios.end());
        return least >= 1.0 && median >= std::max(kMinGain, 1.0 + spread) ? median : 0.0;
    }

    Candidate chooseWay() {
        std::vector<Candidate> candidates;
        for (const char* storage : kStorageNames) {
            if (std::string_view(storage) == "image" && !caps_.images) continue;
            for (int lanes : {1, 4, 8, 16}) {
                Candidate candidate;
                candidate.lanes = lanes;
                candidate.storage = storage;
                candidates.push_back(candidate);
            }
        }
        const auto frame = [](const Times& times) { return times.frame; };
        const auto isTables = [&](const Candidate& c) {
            return c.lanes == table_.lanes && c.storage == storageName(table_.storage);
        };
        for (int round = 0; round < arguments_.rounds; ++round) {
            for (Candidate& candidate : candidates) measure(candidate, 1, round);
            double least = INFINITY;
            for (const Candidate& c : candidates)
                if (c.rejected.empty()) least = std::min(least, c.best(frame));
            for (Candidate& c : candidates) c.isDropped = !isTables(c) && c.best(frame) > kOutOfReach * least;
        }
        const Candidate* const base = &*std::find_if(candidates.begin(), candidates.end(), isTables);
        const Candidate* chosen = base;
        double most = 0.0;
        for (const Candidate& candidate : candidates)
            if (const double g = gain(*base, candidate, frame); g > most) most = g, chosen = &candidate;
        const Candidate result = *chosen;
        const Candidate tables = *base;

        std::sort(candidates.begin(), candidates.end(),
                  [&](const Candidate& a, const Candidate& b) { return a.best(frame) < b.best(frame); });
        fmt::print("\n{:>6} {:<8} {:>12} {:>12} {:>12}\n", "lanes", "storage", "frame ms", "indirect ms",
                   "x the table");
        for (const Candidate& c : candidates) {
            const double ms = c.best(frame);
            fmt::print("{:>6} {:<8} {:>12.3f} {:>12.3f} {:>12.2f} {}{}{}\n", c.lanes, c.storage, ms,
                       c.best([](const Times& times) { return times.indirect; }), ms / tables.best(frame),
                       isTables(c) ? " the table's" : "",
                       c.lanes == result.lanes && c.storage == result.storage ? " chosen" : "",
                       c.rejected.empty() ? "" : " rejected: " + c.rejected);
        }
        return result;
    }

    std::vector<TuningRow> chooseGroups(const Candidate& way) {
        std::vector<Candidate> candidates;
        const auto add = [&](Group group) {
            Candidate candidate;
            candidate.lanes = way.lanes;
            candidate.storage = way.storage;
            candidate.group = group;
            candidates.push_back(candidate);
        };
        expected_.clear();
        if (way.lanes != 1) {  // only to compare with
            Candidate one;
            one.lanes = 1;
            one.storage = way.storage;
            measure(one, scenarios_.size(), 0);
        }
        add({});  // as the table has them, kernel by kernel
        const Group common{table_.localSizePx[0], table_.localSizePx[1]};
        for (const Group group : kGroups)
            if (std::size_t(group.x * group.y) <= caps_.maxWorkGroupSize && (group != common || !table_.groups.empty()))
                add(group);
        for (int round = 0; round < arguments_.rounds; ++round) {
            for (Candidate& candidate : candidates) measure(candidate, scenarios_.size(), round);
            // Once more: what the same differs by. The better one is what has to be beaten.
            Candidate again = candidates.front();
            again.rounds.clear();
            measure(again, scenarios_.size(), round);
            if (again.rounds.empty() || !again.rejected.empty() || !candidates.front().rejected.empty())
                throw DeviceError(fmt::format("tune: {} as the table has it: {}{}", caps_.name, again.rejected,
                                              candidates.front().rejected));
            takeBetter(candidates.front().rounds.back(), again.rounds.front());
            if (round == 0) dropHopeless(candidates);
        }
        const Candidate& base = candidates.front();

        double all = 0.0;
        for (const auto& [kernel, ms] : base.rounds.front().kernels) all += ms;
        std::map<std::string, Group> chosen;
        fmt::print("\nms a kernel and group, all frames; * the table's, > chosen\n");
        for (const auto& entry : base.rounds.front().kernels) {
            const std::string& kernel = entry.first;
            const auto of = [&](const Times& times) { return times.kernels.at(kernel); };
            const std::array<int, 2> own = localSizeOf(table_, kernel);
            chosen[kernel] = {own[0], own[1]};
            double most = 0.0;
            const double spread = medianOf(spreads_.at(kernel));
            if (entry.second >= kMinShare * all)
                for (const Candidate& candidate : candidates)
                    if (const double g = gain(base, candidate, of, spread); g > most)
                        most = g, chosen[kernel] = candidate.group;
            printKernel(kernel, candidates, of, chosen[kernel], own);
        }
        for (const Candidate& candidate : candidates)
            if (!candidate.rejected.empty())
                fmt::print("{} rejected: {}\n", nameOf(candidate.group), candidate.rejected);
        return rowsOf(way, chosen);
    }

    void takeBetter(Times& times, const Times& repeat) {
        for (auto& [kernel, ms] : times.kernels) {
            const double other = repeat.kernels.at(kernel);
            spreads_[kernel].push_back(std::max(ms, other) / std::min(ms, other) - 1.0);
            ms = std::min(ms, other);
        }
        times.frame = std::min(times.frame, repeat.frame);
        times.indirect = std::min(times.indirect, repeat.indirect);
    }

    // What is best, or nearly, for no kernel is not measured again.
    static void dropHopeless(std::vector<Candidate>& candidates) {
        std::map<std::string, double> least;
        for (const Candidate& c : candidates)
            if (c.rejected.empty())
                for (const auto& [kernel, ms] : c.rounds.front().kernels)
                    least[kernel] = std::min(least.try_emplace(kernel, ms).first->second, ms);
        for (std::size_t i = 1; i < candidates.size(); ++i) {
            if (!candidates[i].rejected.empty()) continue;
            const auto& own = candidates[i].rounds.front().kernels;
            candidates[i].isDropped = std::none_of(own.begin(), own.end(), [&](const auto& entry) {
                return entry.second <= kMinGain * least[entry.first];
            });
        }
    }

    void printKernel(const std::string& kernel, const std::vector<Candidate>& candidates, const auto& of, Group chosen,
                     const std::array<int, 2>& own) const {
        std::vector<const Candidate*> sorted;
        for (const Candidate& candidate : candidates)
            if (candidate.rejected.empty()) sorted.push_back(&candidate);
        std::sort(sorted.begin(), sorted.end(),
                  [&](const Candidate* a, const Candidate* b) { return a->best(of) < b->best(of); });
        fmt::print("{:<20}", kernel);
        for (const Candidate* candidate : sorted) {
            const bool isTables = candidate->group == Group{};
            const Group group = isTables ? Group{own[0], own[1]} : candidate->group;
            fmt::print(" {}{}{} {:.3f}", isTables ? "*" : "", group == chosen ? ">" : "", nameOf(group),
                       candidate->best(of));
        }
        fmt::print("; the table's twice a round: {:.1f} % apart\n", 100.0 * medianOf(spreads_.at(kernel)));
    }

    // A row for all kernels with the group that most have, and one for each that has another.
    std::vector<TuningRow> rowsOf(const Candidate& way, const std::map<std::string, Group>& chosen) const {
        std::vector<std::pair<Group, int>> counts;
        for (const auto& [kernel, group] : chosen) {
            auto at = std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.first == group; });
            if (at == counts.end()) at = counts.insert(counts.end(), {group, 0});
            ++at->second;
        }
        const Group common = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
                                 return a.second < b.second;
                             })->first;
        std::vector<TuningRow> rows(1);
        rows[0].scope = TuningScope::Device;
        rows[0].pattern = caps_.name;
        rows[0].lanes = way.lanes;
        rows[0].storage = way.storage;
        rows[0].localSizePx[0] = common.x;
        rows[0].localSizePx[1] = common.y;
        for (const auto& [kernel, group] : chosen) {
            if (group == common) continue;
            TuningRow row = rows[0];
            row.kernel = kernel;
            row.lanes = 0;
            row.storage.clear();
            row.localSizePx[0] = group.x;
            row.localSizePx[1] = group.y;
            rows.push_back(row);
        }
        return rows;
    }

    DeviceCaps caps_;
    TuneArguments arguments_;
    Tuning table_;
    std::vector<Scenario> scenarios_;
    Frames frames_;
    std::map<std::string, std::vector<std::optional<Pictures>>> expected_;  ///< a storage's, a scenario each
    /// Of a kernel: by how much the table's two times differ, a round each.
    std::map<std::string, std::vector<double>> spreads_;
};

}  // namespace

bool asksToTune(int argc, char** argv) {
    return std::any_of(argv + 1, argv + argc, [](const char* text) { return std::strcmp(text, "--tune") == 0; });
}

void tune(int argc, char** argv) {
    const TuneArguments arguments = parseTuneArguments(argc, argv);
    const DeviceCaps caps = selectDevice(arguments.device);
    std::string text = fmt::format("# {}, {} {}: earthshine_bench {} --tune, {} x {}\n{}\n", caps.name,
                                   caps.platformName, caps.driverVersion, kRevision, arguments.extent.widthPx,
                                   arguments.extent.heightPx, tuningHeading());
    for (const TuningRow& row : Tuner(caps, arguments).run()) text += formatTuningRow(row) + "\n";
    fmt::print("\n{}", text);
    if (arguments.out.empty()) return;
    std::ofstream out(arguments.out);
    if (!(out << text) || !out.flush()) throw InputError(arguments.out + ": cannot be written");
}

}  // namespace earthshine::bench
