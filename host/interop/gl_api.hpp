#pragma once
// The few functions and constants of OpenGL that transports call. The library links no GL and needs none of its
// headers.

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>

#include "earthshine/gl.hpp"

namespace earthshine {

namespace gl {
constexpr unsigned kTexture2d = 0x0DE1, kTextureBinding2d = 0x8069, kTextureWidth = 0x1000, kTextureHeight = 0x1001;
constexpr unsigned kPixelPackBuffer = 0x88EB, kPixelPackBufferBinding = 0x88ED;
constexpr unsigned kPixelUnpackBuffer = 0x88EC, kPixelUnpackBufferBinding = 0x88EF;
constexpr unsigned kPackRowLength = 0x0D02, kPackSkipRows = 0x0D03, kPackSkipPixels = 0x0D04, kPackAlignment = 0x0D05;
constexpr unsigned kUnpackRowLength = 0x0CF2, kUnpackSkipRows = 0x0CF3, kUnpackSkipPixels = 0x0CF4,
                   kUnpackAlignment = 0x0CF5;
constexpr unsigned kRed = 0x1903, kRgba = 0x1908, kFloat = 0x1406, kHalfFloat = 0x140B, kUnsignedByte = 0x1401;
constexpr unsigned kR32f = 0x822E, kRgba16f = 0x881A, kRgba32f = 0x8814, kRgba8 = 0x8058;
constexpr unsigned kTextureMaxLevel = 0x813D, kTextureMinFilter = 0x2801, kTextureMagFilter = 0x2800, kNearest = 0x2600;
constexpr unsigned kExtensions = 0x1F03, kNumExtensions = 0x821D;
constexpr unsigned kSyncGpuCommandsComplete = 0x9117, kSyncFlushCommandsBit = 1;
constexpr unsigned kTimeoutExpired = 0x911B, kWaitFailed = 0x911D;
constexpr std::uint64_t kTimeoutIgnored = ~std::uint64_t(0);
}  // namespace gl

/// Pixels of a format as glTexImage2D and glGetTexImage take them.
struct GlPixels {
    unsigned internalFormat, format, type;
};
GlPixels glPixels(PixelFormat format) noexcept;

/// Functions of the context that was current when it was made. X(name without "gl", result, arguments)
#define EARTHSHINE_GL_API(X)                                                                     \
    X(GetIntegerv, void, (unsigned, int*))                                                       \
    X(BindTexture, void, (unsigned, unsigned))                                                   \
    X(BindBuffer, void, (unsigned, unsigned))                                                    \
    X(PixelStorei, void, (unsigned, int))                                                        \
    X(GetTexImage, void, (unsigned, int, unsigned, unsigned, void*))                             \
    X(GetTexLevelParameteriv, void, (unsigned, int, unsigned, int*))                             \
    X(GetError, unsigned, ())                                                                    \
    X(Finish, void, ())                                                                          \
    X(Flush, void, ())                                                                           \
    X(GenTextures, void, (int, unsigned*))                                                       \
    X(DeleteTextures, void, (int, const unsigned*))                                              \
    X(TexParameteri, void, (unsigned, unsigned, int))                                            \
    X(TexImage2D, void, (unsigned, int, int, int, int, int, unsigned, unsigned, const void*))    \
    X(TexSubImage2D, void, (unsigned, int, int, int, int, int, unsigned, unsigned, const void*)) \
    X(GetStringi, const unsigned char*, (unsigned, unsigned))                                    \
    X(FenceSync, void*, (unsigned, unsigned))                                                    \
    X(ClientWaitSync, unsigned, (void*, unsigned, std::uint64_t))                                \
    X(WaitSync, void, (void*, unsigned, std::uint64_t))                                          \
    X(DeleteSync, void, (void*))

class GlApi {
public:
    /// Throws DeviceError, after `what`, naming the first function that is not there.
    GlApi(const char* what, const GlGetProcAddress& find);

#define EARTHSHINE_GL_MEMBER(NAME, RESULT, ARGUMENTS) RESULT(*NAME) ARGUMENTS = nullptr;
    EARTHSHINE_GL_API(EARTHSHINE_GL_MEMBER)
#undef EARTHSHINE_GL_MEMBER

    int integer(unsigned name) const;
    bool hasExtension(const char* name) const;

    /// Errors that the application left behind are not ours.
    void forgetErrors() const;
    /// Throws DeviceError "where: OpenGL error 0x..." if there was one.
    void check(const std::string& where) const;

    /// Waits at most so long for all that was drawn; false if it takes longer, or the context is lost.
    bool finishWithin(double seconds) const;
};

/// Keeps texture binding, pixel buffers and packing of the current context, and puts them back; in between, pixels are
/// rows of a HostImage and buffers are unbound.
class GlPixelState {
public:
    explicit GlPixelState(const GlApi& gl);
    ~GlPixelState();
    GlPixelState(const GlPixelState&) = delete;
    GlPixelState& operator=(const GlPixelState&) = delete;

private:
    static constexpr unsigned kStored[] = {gl::kPackRowLength,    gl::kPackSkipRows,    gl::kPackSkipPixels,
                                           gl::kPackAlignment,    gl::kUnpackRowLength, gl::kUnpackSkipRows,
                                           gl::kUnpackSkipPixels, gl::kUnpackAlignment};
    const GlApi& gl_;
    int texture_, packBuffer_, unpackBuffer_;
    int stored_[std::size(kStored)];
};

}  // namespace earthshine
