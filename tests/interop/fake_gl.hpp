#pragma once
// An OpenGL context with GL_EXT_memory_object_fd and GL_EXT_semaphore_fd over one that has neither, for files of the
// fake Vulkan (fake_vulkan.cpp). Broken rules are logged as the layers log theirs.

#include "earthshine/gl.hpp"

namespace earthshine::test {

/// The context, whose functions those of the fake go before. One at a time.
GlContextHandle withExternalObjects(const GlContextHandle& gl);

/// How often the host waited for OpenGL by glFinish since the last withExternalObjects().
int finishCount();

}  // namespace earthshine::test
