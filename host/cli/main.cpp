// The earthshine program. Results go to stdout, everything else to stderr.
// Exit codes: 0 done, 1 failed, 2 wrong usage.

#include <exception>
#include <new>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interrupt.hpp"
#include "cli/options.hpp"
#include "earthshine/error.hpp"

namespace {

int runProgram(int argc, char** argv) {
    using namespace earthshine::cli;
    bool verbose = false, quiet = false;
    Program program("earthshine", EARTHSHINE_VERSION,
                    "Real-time indirect light from reflective shadow maps, on any OpenCL device");
    program.options().flag("-v,--verbose", verbose, "Say what is done");
    program.options().flag("-q,--quiet", quiet, "Say only what fails");
    addRender(program.options());
    addIndirect(program.options());
    addReference(program.options());
    addCompare(program.options());
    addQuality(program.options());
    addMotion(program.options());
    addDevices(program.options());
    if (!program.parse(argc, argv)) return 0;
    openConsole(quiet ? Verbosity::Quiet : verbose ? Verbosity::Verbose : Verbosity::Normal);
    program.run();
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace earthshine;
    cli::cleanUpOnSignals();
    try {
        return runProgram(argc, argv);
    } catch (const UsageError& e) {
        cli::complain(e.what());
        return 2;
    } catch (const BuildError& e) {
        cli::complain(std::string(e.what()) + "\n" + e.log());
    } catch (const std::bad_alloc&) {
        cli::complain("out of memory");
    } catch (const std::exception& e) {
        cli::complain(e.what());
    }
    return 1;
}
