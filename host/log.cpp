#include "earthshine/log.hpp"

#include <utility>

namespace earthshine {

namespace {
LogSink& sink() {
    static LogSink instance;
    return instance;
}
}  // namespace

void setLogSink(LogSink newSink) {
    sink() = std::move(newSink);
}

void log(LogLevel level, std::string_view message) {
    if (sink()) sink()(level, message);
}

}  // namespace earthshine
