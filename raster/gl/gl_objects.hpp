#pragma once
// Owners of GL names. Each must be destroyed while its context is current: who owns some calls makeCurrent() first.

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "earthshine/gl.hpp"
#include "raster/gl/gl_context.hpp"

namespace earthshine::raster {

/// A GL name that `Delete` (a member of GlFunctions) gives back. Movable; empty when default-made.
template <auto Delete>
class GlObject {
public:
    GlObject() = default;
    GlObject(const GlFunctions& gl, GLuint name) : gl_(&gl), name_(name) {}
    GlObject(GlObject&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(gl_, other.gl_);
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlObject() {
        if (!name_) return;
        if constexpr (requires { (gl_->*Delete)(1, &name_); })
            (gl_->*Delete)(1, &name_);
        else
            (gl_->*Delete)(name_);
    }
    GLuint name() const noexcept { return name_; }

private:
    const GlFunctions* gl_ = nullptr;
    GLuint name_ = 0;
};

using TextureObject = GlObject<&GlFunctions::DeleteTextures>;
using BufferObject = GlObject<&GlFunctions::DeleteBuffers>;
using VertexArrayObject = GlObject<&GlFunctions::DeleteVertexArrays>;
using FramebufferObject = GlObject<&GlFunctions::DeleteFramebuffers>;
using ShaderObject = GlObject<&GlFunctions::DeleteShader>;
using ProgramObject = GlObject<&GlFunctions::DeleteProgram>;

TextureObject makeTexture(const GlFunctions& gl);
BufferObject makeBuffer(const GlFunctions& gl);
VertexArrayObject makeVertexArray(const GlFunctions& gl);
FramebufferObject makeFramebuffer(const GlFunctions& gl);

/// Textures of one extent that a pass draws into together, with a depth buffer of their own. The textures have one
/// level and nearest filtering, so that OpenCL can share them (an incomplete mip chain makes clCreateFromGLTexture
/// fail).
class RenderTarget {
public:
    /// `formats` in the order of the fragment shader's outputs.
    RenderTarget(const GlFunctions& gl, std::span<const PixelFormat> formats);
    ~RenderTarget();
    RenderTarget(const RenderTarget&) = delete;
    RenderTarget& operator=(const RenderTarget&) = delete;

    /// Gives all textures this extent, if they have another; their contents are then undefined. Throws DeviceError if
    /// the textures would be larger than the context allows (`what` says whose they are) or cannot be drawn into.
    void resize(GlContext& context, Extent extent, std::string_view what);

    /// Draws go here from now on; the viewport is all of it.
    void bind() const;

    /// For `count` square maps below one another (map 0 on top): resizes, binds.
    void bindAtlas(GlContext& context, int sizePx, int count, std::string_view what);

    /// The viewport becomes the map `index` of an atlas.
    void selectAtlasEntry(int index) const;

    /// Fills the colour texture `index` with one value, and the depth buffer with the farthest depth.
    void clearColor(int index, const float (&value)[4]) const;
    void clearDepth() const;

    GlTexture texture(int index) const;

private:
    void forgetTextures() noexcept;

    const GlFunctions* gl_;
    GlTextureStorage* storage_ = nullptr;  ///< of the textures, whoever owns them
    std::vector<PixelFormat> formats_;
    std::vector<TextureObject> textures_;
    TextureObject depth_;
    FramebufferObject framebuffer_;
    Extent extent_;
};

/// The pixels of a texture, read back. Makes the context current and waits for it. Throws DeviceError.
HostImage readTexture(GlContext& context, const GlTexture& texture);

}  // namespace earthshine::raster
