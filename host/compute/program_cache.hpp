#pragma once
// Compiled programs: from the driver, or from a file that an earlier run left behind.

#include <string>

#include "compute/cl.hpp"

namespace earthshine {

/// Builds `source` for one device with `options`. A binary kept in `cacheFolder` ("" = none) is used if its key is the
/// same in full: source, options, device, driver, platform. An entry that is damaged, or that the driver refuses, is
/// written anew; a cache that cannot be written is passed over. Throws BuildError with the log.
cl::Program buildProgram(const cl::Context& context, const cl::Device& device, const std::string& name,
                         const std::string& source, const std::string& options, const std::string& cacheFolder);

/// $EARTHSHINE_CACHE, else $XDG_CACHE_HOME/earthshine, else ~/.cache/earthshine; "" if there is no home or "none" is
/// asked.
std::string cacheFolderFor(const std::string& asked);

}  // namespace earthshine
