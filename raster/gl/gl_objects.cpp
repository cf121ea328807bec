#include "raster/gl/gl_objects.hpp"

#include <cstdint>

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine::raster {

namespace {

struct GlFormat {
    GLint internalFormat;
    GLenum format;
    GLenum type;
};

GlFormat glFormat(PixelFormat format) {
    switch (format) {
        case PixelFormat::R32F:
            return {GL_R32F, GL_RED, GL_FLOAT};
        case PixelFormat::RGBA16F:
            return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
        case PixelFormat::RGBA32F:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
        case PixelFormat::RGBA8:
            return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    }
    return {};
}

template <typename Object, typename Generate>
Object make(const GlFunctions& gl, Generate generate) {
    GLuint name = 0;
    generate(1, &name);
    return Object(gl, name);
}

/// Storage of GL's own for the texture that is bound.
void allocate(const GlFunctions& gl, const GlFormat& format, Extent extent) {
    gl.TexImage2D(GL_TEXTURE_2D, 0, format.internalFormat, extent.widthPx, extent.heightPx, 0, format.format,
                  format.type, nullptr);
}

/// One level, nearest filtering.
void setParameters(const GlFunctions& gl) {
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

}  // namespace

TextureObject makeTexture(const GlFunctions& gl) {
    return make<TextureObject>(gl, gl.GenTextures);
}
BufferObject makeBuffer(const GlFunctions& gl) {
    return make<BufferObject>(gl, gl.GenBuffers);
}
VertexArrayObject makeVertexArray(const GlFunctions& gl) {
    return make<VertexArrayObject>(gl, gl.GenVertexArrays);
}
FramebufferObject makeFramebuffer(const GlFunctions& gl) {
    return make<FramebufferObject>(gl, gl.GenFramebuffers);
}

RenderTarget::RenderTarget(const GlFunctions& gl, std::span<const PixelFormat> formats)
    : gl_(&gl), formats_(formats.begin(), formats.end()) {}

RenderTarget::~RenderTarget() {
    forgetTextures();
}

void RenderTarget::forgetTextures() noexcept {
    if (storage_)
        for (const TextureObject& texture : textures_) storage_->forget(texture.name());
    textures_.clear();
}

void RenderTarget::resize(GlContext& context, Extent extent, std::string_view what) {
    if (extent == extent_) return;
    const int most = context.description().maxTextureSizePx;
    if (extent.widthPx > most || extent.heightPx > most)
        throw DeviceError(fmt::format("{}: {}x{} is larger than the {} texels a side that \"{}\" allows", what,
                                      extent.widthPx, extent.heightPx, most, context.description().renderer));
    // Made anew rather than resized in place: whoever shared the old textures must see that they are gone.
    const GlFunctions& gl = *gl_;
    extent_ = {};
    forgetTextures();
    storage_ = context.textureStorage();
    framebuffer_ = makeFramebuffer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    std::vector<GLenum> attachments;
    for (const PixelFormat format : formats_) {
        textures_.push_back(makeTexture(gl));
        const GLuint texture = textures_.back().name();
        gl.BindTexture(GL_TEXTURE_2D, texture);
        if (!storage_ || !storage_->allocate({texture, format, extent})) allocate(gl, glFormat(format), extent);
        setParameters(gl);
        attachments.push_back(GL_COLOR_ATTACHMENT0 + GLenum(attachments.size()));
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, attachments.back(), GL_TEXTURE_2D, textures_.back().name(), 0);
    }
    depth_ = makeTexture(gl);
    gl.BindTexture(GL_TEXTURE_2D, depth_.name());
    allocate(gl, {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT}, extent);
    setParameters(gl);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
    gl.DrawBuffers(GLsizei(attachments.size()), attachments.data());
    context.check(fmt::format("{}: textures of {}x{}", what, extent.widthPx, extent.heightPx));
    const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw DeviceError(fmt::format("{}: glCheckFramebufferStatus: 0x{:x} at {}x{} on \"{}\"", what, status,
                                      extent.widthPx, extent.heightPx, context.description().renderer));
    extent_ = extent;
}

void RenderTarget::bind() const {
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl_->Viewport(0, 0, extent_.widthPx, extent_.heightPx);
}

void RenderTarget::bindAtlas(GlContext& context, int sizePx, int count, std::string_view what) {
    const int most = context.description().maxTextureSizePx;
    if (std::int64_t(sizePx) * count > most)
        throw DeviceError(
            fmt::format("{}: {} lights of {}x{} texels stand {} texels high, \"{}\" allows {}: use a size "
                        "of {} or less, or fewer lights",
                        what, count, sizePx, sizePx, std::int64_t(sizePx) * count, context.description().renderer, most,
                        most / count));
    resize(context, {sizePx, sizePx * count}, what);
    bind();
}

void RenderTarget::selectAtlasEntry(int index) const {
    gl_->Viewport(0, index * extent_.widthPx, extent_.widthPx, extent_.widthPx);
}

void RenderTarget::clearColor(int index, const float (&value)[4]) const {
    gl_->ClearBufferfv(GL_COLOR, index, value);
}

void RenderTarget::clearDepth() const {
    const float farthest = 1.0f;
    gl_->DepthMask(GL_TRUE);
    gl_->ClearBufferfv(GL_DEPTH, 0, &farthest);
}

GlTexture RenderTarget::texture(int index) const {
    return {textures_[std::size_t(index)].name(), formats_[std::size_t(index)], extent_};
}

HostImage readTexture(GlContext& context, const GlTexture& texture) {
    context.makeCurrent();
    const GlFunctions& gl = context.gl();
    HostImage image(texture.format, texture.extent);
    const GlFormat format = glFormat(texture.format);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.BindTexture(GL_TEXTURE_2D, texture.name);
    gl.GetTexImage(GL_TEXTURE_2D, 0, format.format, format.type, image.data());
    context.check("readTexture: glGetTexImage");
    return image;
}

}  // namespace earthshine::raster
