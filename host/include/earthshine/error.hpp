#pragma once
// What goes wrong, by who can mend it. Every message is one line: what was wrong, where, and what to do.

#include <stdexcept>
#include <string>

namespace earthshine {

/// The base of everything that Earthshine throws. `what()` is one line, fit to be shown to a user as it is.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The caller asked for something that has no meaning (an unknown option, a negative size): exit code 2.
class UsageError : public Error {
public:
    using Error::Error;
};

/// A file or a picture is not what it should be. The message starts with the file and the place in it.
class InputError : public Error {
public:
    using Error::Error;
};

/// A device, driver or context refused an operation. The message names the call, the code and the device.
class DeviceError : public Error {
public:
    using Error::Error;
};

/// A kernel or shader did not compile. `log()` is the compiler's own text, with file names and lines.
class BuildError : public Error {
public:
    BuildError(const std::string& message, std::string log) : Error(message), log_(std::move(log)) {}
    const std::string& log() const noexcept { return log_; }

private:
    std::string log_;
};

}  // namespace earthshine
