#include "interop/gl_api.hpp"

#include <fmt/format.h>

#include <cstring>
#include <type_traits>

#include "earthshine/error.hpp"

namespace earthshine {

GlPixels glPixels(PixelFormat format) noexcept {
    switch (format) {
        case PixelFormat::R32F:
            return {gl::kR32f, gl::kRed, gl::kFloat};
        case PixelFormat::RGBA16F:
            return {gl::kRgba16f, gl::kRgba, gl::kHalfFloat};
        case PixelFormat::RGBA8:
            return {gl::kRgba8, gl::kRgba, gl::kUnsignedByte};
        case PixelFormat::RGBA32F:
            break;
    }
    return {gl::kRgba32f, gl::kRgba, gl::kFloat};
}

GlApi::GlApi(const char* what, const GlGetProcAddress& find) {
    if (!find) throw DeviceError(fmt::format("{}: there is no OpenGL context", what));
    const auto load = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(find(name));
        if (!function) throw DeviceError(fmt::format("{}: this OpenGL has no {}", what, name));
    };
#define EARTHSHINE_GL_LOAD(NAME, RESULT, ARGUMENTS) load(NAME, "gl" #NAME);
    EARTHSHINE_GL_API(EARTHSHINE_GL_LOAD)
#undef EARTHSHINE_GL_LOAD
}

int GlApi::integer(unsigned name) const {
    int value = 0;
    GetIntegerv(name, &value);
    return value;
}

bool GlApi::hasExtension(const char* name) const {
    const int count = integer(gl::kNumExtensions);
    for (int i = 0; i < count; ++i) {
        const unsigned char* extension = GetStringi(gl::kExtensions, unsigned(i));
        if (extension && std::strcmp(reinterpret_cast<const char*>(extension), name) == 0) return true;
    }
    return false;
}

void GlApi::forgetErrors() const {
    constexpr int kMostErrors = 16;  // a lost context never runs out of them
    for (int i = 0; i < kMostErrors && GetError() != 0; ++i) {
    }
}

void GlApi::check(const std::string& where) const {
    const unsigned error = GetError();
    if (error == 0) return;
    forgetErrors();
    throw DeviceError(fmt::format("{}: OpenGL error 0x{:04x}", where, error));
}

bool GlApi::finishWithin(double seconds) const {
    void* fence = FenceSync(gl::kSyncGpuCommandsComplete, 0);
    if (!fence) return false;
    const unsigned status = ClientWaitSync(fence, gl::kSyncFlushCommandsBit, std::uint64_t(seconds * 1e9));
    DeleteSync(fence);
    return status != gl::kTimeoutExpired && status != gl::kWaitFailed;
}

GlPixelState::GlPixelState(const GlApi& api)
    : gl_(api),
      texture_(api.integer(gl::kTextureBinding2d)),
      packBuffer_(api.integer(gl::kPixelPackBufferBinding)),
      unpackBuffer_(api.integer(gl::kPixelUnpackBufferBinding)) {
    for (std::size_t i = 0; i < std::size(kStored); ++i) {
        stored_[i] = api.integer(kStored[i]);
        const bool isAlignment = kStored[i] == gl::kPackAlignment || kStored[i] == gl::kUnpackAlignment;
        api.PixelStorei(kStored[i], isAlignment ? 4 : 0);
    }
    api.BindBuffer(gl::kPixelPackBuffer, 0);
    api.BindBuffer(gl::kPixelUnpackBuffer, 0);
}

GlPixelState::~GlPixelState() {
    for (std::size_t i = 0; i < std::size(kStored); ++i) gl_.PixelStorei(kStored[i], stored_[i]);
    gl_.BindBuffer(gl::kPixelPackBuffer, unsigned(packBuffer_));
    gl_.BindBuffer(gl::kPixelUnpackBuffer, unsigned(unpackBuffer_));
    gl_.BindTexture(gl::kTexture2d, unsigned(texture_));
}

}  // namespace earthshine
