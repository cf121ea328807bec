#pragma once
// A library opened at run time. It stays open until the process ends: GL drivers leave threads and exit handlers
// behind.

#include <initializer_list>
#include <string>

#include <dlfcn.h>

#include "earthshine/error.hpp"

namespace earthshine::raster {

class SharedLibrary {
public:
    /// Opens the first of `names` that is there; throws DeviceError with the loader's own words about the first.
    explicit SharedLibrary(std::initializer_list<const char*> names) {
        std::string firstError;
        for (const char* name : names) {
            handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
            if (handle_) return;
            if (firstError.empty()) firstError = dlerror();
        }
        throw DeviceError(firstError);
    }

    /// The function `name`; throws DeviceError if the library lacks it.
    template <typename Function>
    Function function(const char* name) const {
        void* address = dlsym(handle_, name);
        if (!address) throw DeviceError(std::string(dlerror()));
        return reinterpret_cast<Function>(address);
    }

private:
    void* handle_ = nullptr;
};

}  // namespace earthshine::raster
