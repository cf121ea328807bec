#pragma once
// Names of rows in tables and files.

#include <string>

namespace earthshine::bench {

/// A row's own name: without what Google Benchmark puts behind it ("/manual_time", "/repeats:5").
inline std::string rowName(const std::string& name) {
    return name.substr(0, name.find('/'));
}

}  // namespace earthshine::bench
