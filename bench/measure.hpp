#pragma once
// The loop of every benchmark of launches.

#include <functional>

#include <benchmark/benchmark.h>

#include "compute/device_impl.hpp"

namespace earthshine::bench {

/// Runs `launch` once to warm up, since drivers compile at the first launch, then counts the device's own time of all
/// that it launches. `bytes`, if not 0, is what one run must move at least: the row then has GB/s.
inline void measure(benchmark::State& state, const Device& device, const std::function<void()>& launch,
                    double bytes = 0.0) {
    Device::Impl& impl = device.impl();
    const auto launchAll = [&] {
        impl.launches.clear();
        launch();
        impl.queue.finish();
    };
    launchAll();
    for (auto _ : state) {
        launchAll();
        double seconds = 0.0;
        for (const Launch& one : impl.launches) seconds += 1e-3 * one.ms();
        state.SetIterationTime(seconds);
    }
    if (bytes > 0.0)
        state.counters["GB/s"] = benchmark::Counter(1e-9 * bytes, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace earthshine::bench
