#include "cli/interrupt.hpp"

#include <csignal>
#include <thread>

#include "image/output_set.hpp"

namespace earthshine::cli {

void cleanUpOnSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction current {};
        sigaction(number, nullptr, &current);
        if (current.sa_handler != SIG_IGN) sigaddset(&signals, number);  // nohup ignores SIGHUP: so do we
    }
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    // A thread that waits may do what a signal handler may not: lock, allocate, remove files.
    std::thread([signals] {
        int number = 0;
        if (sigwait(&signals, &number) != 0) return;
        OutputSet::discardAllForGood();
        std::signal(number, SIG_DFL);
        pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
        std::raise(number);
    }).detach();
}

}  // namespace earthshine::cli
