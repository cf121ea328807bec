#pragma once
// The official C++ bindings, with exceptions. Users of the library never see them.

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>

#include <string>

namespace earthshine {

/// "CL_OUT_OF_RESOURCES (-5)".
std::string clErrorName(cl_int code);

/// Is the extension one of the device's?
bool hasExtension(const cl::Device& device, const std::string& name);

[[noreturn]] void throwDeviceError(const std::string& what, const std::string& device, const cl::Error& error);

/// Runs `body`; a cl::Error becomes a DeviceError "what: clCall: CL_NAME (code) on \"device\"".
template <class Body>
auto clChecked(const std::string& what, const std::string& device, Body&& body) {
    try {
        return body();
    } catch (const cl::Error& error) {
        throwDeviceError(what, device, error);
    }
}

}  // namespace earthshine
