#pragma once
// The library prints nothing: it hands one-line messages to whoever listens.

#include <functional>
#include <string_view>

namespace earthshine {

enum class LogLevel {
    Debug,
    Info,
    Progress,  ///< slow work has begun: shown until the next one; an empty line says that it is over
    Warning
};

using LogSink = std::function<void(LogLevel, std::string_view)>;

/// Sends every later message to `sink`; an empty sink (the default) drops them. Not thread-safe: call it once, first.
void setLogSink(LogSink sink);

/// Hands one line, without its line break, to the sink.
void log(LogLevel level, std::string_view message);

}  // namespace earthshine
