#pragma once
// The OpenGL functions that raster calls, looked up at run time: nothing links libGL. `gl.DrawElements(...)`.

#include <functional>

#include <GL/glcorearb.h>

#include "earthshine/gl.hpp"

namespace earthshine::raster {

// X(name without "gl", name of its type between "PFNGL" and "PROC")
#define EARTHSHINE_GL_FUNCTIONS(X)                      \
    X(ActiveTexture, ACTIVETEXTURE)                     \
    X(AttachShader, ATTACHSHADER)                       \
    X(BindBuffer, BINDBUFFER)                           \
    X(BindBufferRange, BINDBUFFERRANGE)                 \
    X(BindFramebuffer, BINDFRAMEBUFFER)                 \
    X(BindTexture, BINDTEXTURE)                         \
    X(BindVertexArray, BINDVERTEXARRAY)                 \
    X(BufferData, BUFFERDATA)                           \
    X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)   \
    X(ClearBufferfv, CLEARBUFFERFV)                     \
    X(CompileShader, COMPILESHADER)                     \
    X(CreateProgram, CREATEPROGRAM)                     \
    X(CreateShader, CREATESHADER)                       \
    X(CullFace, CULLFACE)                               \
    X(DeleteBuffers, DELETEBUFFERS)                     \
    X(DeleteFramebuffers, DELETEFRAMEBUFFERS)           \
    X(DeleteProgram, DELETEPROGRAM)                     \
    X(DeleteShader, DELETESHADER)                       \
    X(DeleteTextures, DELETETEXTURES)                   \
    X(DeleteVertexArrays, DELETEVERTEXARRAYS)           \
    X(DepthFunc, DEPTHFUNC)                             \
    X(DepthMask, DEPTHMASK)                             \
    X(Disable, DISABLE)                                 \
    X(DrawBuffers, DRAWBUFFERS)                         \
    X(DrawElementsBaseVertex, DRAWELEMENTSBASEVERTEX)   \
    X(Enable, ENABLE)                                   \
    X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) \
    X(Finish, FINISH)                                   \
    X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)       \
    X(FrontFace, FRONTFACE)                             \
    X(GenBuffers, GENBUFFERS)                           \
    X(GenFramebuffers, GENFRAMEBUFFERS)                 \
    X(GenTextures, GENTEXTURES)                         \
    X(GenVertexArrays, GENVERTEXARRAYS)                 \
    X(GetError, GETERROR)                               \
    X(GetIntegerv, GETINTEGERV)                         \
    X(GetProgramInfoLog, GETPROGRAMINFOLOG)             \
    X(GetProgramiv, GETPROGRAMIV)                       \
    X(GetShaderInfoLog, GETSHADERINFOLOG)               \
    X(GetShaderiv, GETSHADERIV)                         \
    X(GetString, GETSTRING)                             \
    X(GetTexImage, GETTEXIMAGE)                         \
    X(GetUniformBlockIndex, GETUNIFORMBLOCKINDEX)       \
    X(GetUniformLocation, GETUNIFORMLOCATION)           \
    X(LinkProgram, LINKPROGRAM)                         \
    X(PixelStorei, PIXELSTOREI)                         \
    X(ShaderSource, SHADERSOURCE)                       \
    X(TexImage2D, TEXIMAGE2D)                           \
    X(TexParameteri, TEXPARAMETERI)                     \
    X(Uniform1f, UNIFORM1F)                             \
    X(Uniform1i, UNIFORM1I)                             \
    X(Uniform2f, UNIFORM2F)                             \
    X(Uniform3fv, UNIFORM3FV)                           \
    X(UniformBlockBinding, UNIFORMBLOCKBINDING)         \
    X(UniformMatrix4fv, UNIFORMMATRIX4FV)               \
    X(UseProgram, USEPROGRAM)                           \
    X(VertexAttribPointer, VERTEXATTRIBPOINTER)         \
    X(Viewport, VIEWPORT)

struct GlFunctions {
#define EARTHSHINE_GL_MEMBER(name, type) PFNGL##type##PROC name = nullptr;
    EARTHSHINE_GL_FUNCTIONS(EARTHSHINE_GL_MEMBER)
#undef EARTHSHINE_GL_MEMBER
};

/// The functions of the context that is current. Throws DeviceError naming the first one that is missing.
GlFunctions loadGlFunctions(const GlGetProcAddress& getProcAddress);

}  // namespace earthshine::raster
