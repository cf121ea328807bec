#include "interop/fake_gl.hpp"

#include <sys/stat.h>

#include <set>

#include "interop/external_objects.hpp"
#include "interop/layer_support.hpp"

namespace earthshine::test {

namespace {

using namespace layer_support;
using ::test::ExternalObject;

constexpr const char* kExtensions[] = {"GL_EXT_memory_object", "GL_EXT_memory_object_fd", "GL_EXT_semaphore",
                                       "GL_EXT_semaphore_fd"};
constexpr GLenum kHandleTypeOpaqueFd = 0x9586, kDedicated = 0x9581, kLayoutGeneral = 0x958D, kDeviceUuid = 0x9597;

struct Memory {
    bool isDedicated = false;
    ::test::Imported memory;
    GLuint texture = 0;
    float mark = 0.0f;  ///< that the texture bears as its border's colour: a later one of the same name has another
};

GlGetProcAddress find;
std::map<unsigned, Memory> memories;
std::map<unsigned, ::test::Imported> semaphores;
unsigned lastName = 0;
std::vector<ExternalObject*> pending;
GLenum error = GL_NO_ERROR;
int finishes = 0;

template <class Function>
Function real(const char* name) {
    return reinterpret_cast<Function>(find(name));
}

std::size_t extensionCount() {
    // One is left out on demand: the last.
    return std::size(kExtensions) - (environment("EARTHSHINE_LAYER_FAIL") == "glExtension" ? 1 : 0);
}

/// The border's colour of a texture, its first number.
float markOf(GLuint texture) {
    float color[4] = {};
    const Bound bound(texture);
    gl().getTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, color);
    return color[0];
}

void submit() {
    for (ExternalObject* object : pending) {
        object->isPending = 0;
        object->isSignalled = 1;
    }
    pending.clear();
}

void getIntegerv(GLenum name, GLint* value) {
    real<PFNGLGETINTEGERVPROC>("glGetIntegerv")(name, value);
    if (name == GL_NUM_EXTENSIONS) *value += GLint(extensionCount());
}
const GLubyte* getStringi(GLenum name, GLuint index) {
    GLint count = 0;
    real<PFNGLGETINTEGERVPROC>("glGetIntegerv")(GL_NUM_EXTENSIONS, &count);
    if (name == GL_EXTENSIONS && index >= GLuint(count))
        return reinterpret_cast<const GLubyte*>(kExtensions[index - GLuint(count)]);
    const GLubyte* theirs = real<PFNGLGETSTRINGIPROC>("glGetStringi")(name, index);
    // A GPU's driver has them, too: what is left out must not be found there.
    for (const char* ours : kExtensions)
        if (name == GL_EXTENSIONS && theirs && std::strcmp(reinterpret_cast<const char*>(theirs), ours) == 0)
            return reinterpret_cast<const GLubyte*>("");
    return theirs;
}
GLenum getError() {
    if (error != GL_NO_ERROR) return std::exchange(error, GLenum(GL_NO_ERROR));
    return real<PFNGLGETERRORPROC>("glGetError")();
}
void flush() {
    submit();
    real<PFNGLFLUSHPROC>("glFlush")();
}
void finish() {
    ++finishes;
    submit();
    real<PFNGLFINISHPROC>("glFinish")();
}
void getUnsignedBytei(GLenum name, GLuint, GLubyte* value) {
    if (name == kDeviceUuid) std::memset(value, ::test::kUuidByte, 16);
}

void createMemoryObjects(GLsizei count, GLuint* names) {
    for (GLsizei i = 0; i < count; ++i) memories[names[i] = ++lastName] = {};
    note("gl memory");
}
void deleteMemoryObjects(GLsizei count, const GLuint* names) {
    for (GLsizei i = 0; i < count; ++i) {
        const auto [texture, mark] = std::pair(memories[names[i]].texture, memories[names[i]].mark);
        // Drivers give names of deleted textures out again, some at once.
        if (texture != 0 && gl().isTexture(texture) && markOf(texture) == mark)
            violation("a memory object is deleted before its texture");
        if (memories[names[i]].memory.object && !::test::letGo(memories[names[i]].memory))
            violation("a memory's descriptor was closed by another than OpenGL");
        if (memories.erase(names[i]) == 0) violation("a memory object is deleted that is none");
        note("gl memory deleted");
    }
}
void memoryObjectParameter(GLuint name, GLenum parameter, const GLint* value) {
    if (parameter == kDedicated) memories[name].isDedicated = *value != 0;
}
void importMemoryFd(GLuint name, GLuint64 size, GLenum type, GLint fd) {
    if (fails("glImportMemoryFdEXT")) {
        error = GL_OUT_OF_MEMORY;
        return;
    }
    if (type != kHandleTypeOpaqueFd || size == 0) violation("glImportMemoryFdEXT's arguments");
    if (!memories[name].isDedicated) violation("memory of an image was not said to be dedicated");
    memories[name].memory = ::test::importObject(fd);
}
void texStorageMem2D(GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height, GLuint name,
                     GLuint64 offset) {
    if (fails("glTexStorageMem2DEXT") || !memories[name].memory.object || offset != 0) {
        error = GL_INVALID_VALUE;
        return;
    }
    GLint texture = 0;
    real<PFNGLGETINTEGERVPROC>("glGetIntegerv")(GL_TEXTURE_BINDING_2D, &texture);
    real<PFNGLTEXSTORAGE2DPROC>("glTexStorage2D")(target, levels, format, width, height);
    memories[name].texture = memories[name].memory.object->texture = GLuint(texture);
    static float lastMark = 0.0f;
    const float color[4] = {memories[name].mark = lastMark += 1.0f, 0.0f, 0.0f, 0.0f};
    real<PFNGLTEXPARAMETERFVPROC>("glTexParameterfv")(target, GL_TEXTURE_BORDER_COLOR, color);
}

void genSemaphores(GLsizei count, GLuint* names) {
    for (GLsizei i = 0; i < count; ++i) semaphores[names[i] = ++lastName] = {};
}
void deleteSemaphores(GLsizei count, const GLuint* names) {
    for (GLsizei i = 0; i < count; ++i) {
        if (semaphores[names[i]].object && !::test::letGo(semaphores[names[i]]))
            violation("a semaphore's descriptor was closed by another than OpenGL");
        semaphores.erase(names[i]);
    }
}
void importSemaphoreFd(GLuint name, GLenum type, GLint fd) {
    if (fails("glImportSemaphoreFdEXT")) {
        error = GL_OUT_OF_MEMORY;
        return;
    }
    if (type != kHandleTypeOpaqueFd) violation("glImportSemaphoreFdEXT's type");
    semaphores[name] = ::test::importObject(fd);
}
void checkBarrier(GLuint count, const GLuint* textures, const GLenum* layouts) {
    for (GLuint i = 0; i < count; ++i) {
        bool isImported = false;
        for (const auto& [name, memory] : memories) isImported = isImported || memory.texture == textures[i];
        if (!isImported || layouts[i] != kLayoutGeneral) violation("a semaphore's texture or layout");
    }
    if (count == 0) violation("a semaphore without textures");
}
void signalSemaphore(GLuint name, GLuint, const GLuint*, GLuint count, const GLuint* textures, const GLenum* layouts) {
    checkBarrier(count, textures, layouts);
    ExternalObject* object = semaphores[name].object;
    if (object->isSignalled || object->isPending) violation("OpenGL signals twice");
    object->isPending = 1;
    pending.push_back(object);
}
void waitSemaphore(GLuint name, GLuint, const GLuint*, GLuint count, const GLuint* textures, const GLenum* layouts) {
    checkBarrier(count, textures, layouts);
    ExternalObject* object = semaphores[name].object;
    if (!object->isSignalled)
        violation(object->isPending ? "OpenGL waits for what OpenCL did not flush"
                                    : "OpenGL waits for what OpenCL did not signal");
    object->isSignalled = 0;
}

}  // namespace

GlContextHandle withExternalObjects(const GlContextHandle& gl) {
    find = gl.getProcAddress;
    finishes = 0;
    GlContextHandle fake = gl;
    fake.getProcAddress = [](const char* name) -> void* {
        static const std::map<std::string, void*> kFunctions{
            {"glGetIntegerv", reinterpret_cast<void*>(getIntegerv)},
            {"glGetStringi", reinterpret_cast<void*>(getStringi)},
            {"glGetError", reinterpret_cast<void*>(getError)},
            {"glFlush", reinterpret_cast<void*>(flush)},
            {"glFinish", reinterpret_cast<void*>(finish)},
            {"glGetUnsignedBytei_vEXT", reinterpret_cast<void*>(getUnsignedBytei)},
            {"glCreateMemoryObjectsEXT", reinterpret_cast<void*>(createMemoryObjects)},
            {"glDeleteMemoryObjectsEXT", reinterpret_cast<void*>(deleteMemoryObjects)},
            {"glMemoryObjectParameterivEXT", reinterpret_cast<void*>(memoryObjectParameter)},
            {"glImportMemoryFdEXT", reinterpret_cast<void*>(importMemoryFd)},
            {"glTexStorageMem2DEXT", reinterpret_cast<void*>(texStorageMem2D)},
            {"glGenSemaphoresEXT", reinterpret_cast<void*>(genSemaphores)},
            {"glDeleteSemaphoresEXT", reinterpret_cast<void*>(deleteSemaphores)},
            {"glImportSemaphoreFdEXT", reinterpret_cast<void*>(importSemaphoreFd)},
            {"glSignalSemaphoreEXT", reinterpret_cast<void*>(signalSemaphore)},
            {"glWaitSemaphoreEXT", reinterpret_cast<void*>(waitSemaphore)},
        };
        const auto found = kFunctions.find(name);
        return found == kFunctions.end() ? find(name) : found->second;
    };
    return fake;
}

int finishCount() {
    return finishes;
}

}  // namespace earthshine::test
