#pragma once
// Loops over rows, tiles or pictures on every core.

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace earthshine {

/// Calls body(i) once for each i in [0; count), from `threads` threads (0 = one a core, the caller is one of them). The
/// order is not defined. What a body throws ends the loop early and is thrown again here.
template <class Body>
void parallelFor(int count, int threads, Body&& body) {
    if (threads <= 0) threads = std::max(1, int(std::thread::hardware_concurrency()));
    std::atomic<int> next{0};
    std::exception_ptr failure;
    std::mutex failureMutex;
    const auto work = [&] {
        try {
            for (int i = next.fetch_add(1); i < count; i = next.fetch_add(1)) body(i);
        } catch (...) {
            const std::lock_guard lock(failureMutex);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> others;
        for (int t = 1; t < std::min(threads, count); ++t) others.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace earthshine
