#pragma once
// Ctrl-C leaves nothing half-written behind.

namespace earthshine::cli {

/// From here on SIGINT, SIGTERM and SIGHUP first remove the temporary outputs of every OutputSet and then end the
/// process as they would have. Call it before any other thread starts, because threads inherit which signals wait.
void cleanUpOnSignals();

}  // namespace earthshine::cli
