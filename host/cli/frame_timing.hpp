#pragma once
// How long the parts of a frame took, over many frames.

#include <string>
#include <utility>
#include <vector>

#include "earthshine/pipeline.hpp"

namespace earthshine::cli {

/// Milliseconds of one thing, once a frame.
struct Series {
    std::vector<double> ms;

    double median() const;  ///< 0 if there are none; of an even number the mean of the two in the middle
    double min() const;
    double max() const;
};

/// The stages of a frame (time on the device) and the steps around them (wall clock), in the order first heard of.
class FrameTiming {
public:
    void addStages(const std::vector<StageTime>& times);  ///< also their sum, as deviceTotal
    void addStep(const std::string& step, double ms);

    /// What bringing the frame from OpenGL to OpenCL cost.
    void addTransport(const TransportCost& cost);

    /// Forgets all so far, when the first of several frames is over: it compiles and allocates.
    void clear();

    const std::vector<std::pair<std::string, Series>>& stages() const { return stages_; }
    const std::vector<std::pair<std::string, Series>>& steps() const { return steps_; }
    const Series& deviceTotal() const { return deviceTotal_; }
    const std::vector<std::pair<std::string, Series>>& transport() const { return transport_; }
    std::size_t transportHostBytes() const { return transportHostBytes_; }  ///< of the last frame

    /// A table for people: a line a stage, then the sum, then the steps.
    std::string table() const;

private:
    std::vector<std::pair<std::string, Series>> stages_, steps_, transport_;
    std::size_t transportHostBytes_ = 0;
    Series deviceTotal_;
    bool isCold_ = true;
};

/// Milliseconds of the stages of indirect light: what reads the RSM, what denoises, what changes the resolution.
double indirectMs(const std::vector<StageTime>& times);

/// Milliseconds since the system started this process, in ticks of 10 ms; 0 if it does not say.
double processMs();

/// Milliseconds since it was made.
class Stopwatch {
public:
    Stopwatch();
    double ms() const;

private:
    long long startNs_;
};

}  // namespace earthshine::cli
