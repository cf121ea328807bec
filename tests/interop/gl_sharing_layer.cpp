// An OpenCL layer (OPENCL_LAYERS) that gives every device cl_khr_gl_sharing, by copies, and keeps its rules: no driver
// within reach has the extension, but its call sequence is to be tested.
//
// clCreateFromGLTexture gives a plain image that holds NaN; clEnqueueAcquireGLObjects fills it from the texture,
// clEnqueueReleaseGLObjects writes it back and fills it with NaN again. A broken rule is refused (CL_INVALID_OPERATION)
// and logged as "violation: ...":
//   - an image is used (kernel, copy) or given away while it is not acquired
//   - GL draws into a texture while it is acquired: its pixels are no longer those that were acquired
//   - the texture was deleted, and its name given out again
//   - another GL context, or none, is current, or the queue is of another OpenCL context
//
// Environment, read at each call:
//   EARTHSHINE_LAYER_LOG=FILE      one line a call is appended
//   EARTHSHINE_LAYER_EVENTS=1      cl_khr_gl_event, too
//   EARTHSHINE_LAYER_FAIL=CALL:N   the N-th create, acquire or release is refused as if the device were out of
//   resources EARTHSHINE_LAYER_DEVICE=none   no device goes along with the GL context

#include "interop/layer_support.hpp"

namespace {

using namespace layer_support;

cl_icd_dispatch target;  ///< what lies below
cl_icd_dispatch layer;   ///< the same, with ours in place of some

struct SharedImage {
    cl_context context;
    GLuint texture;
    std::size_t width, height, bytesPerPixel;
    GLenum format, type;
    bool isAcquired = false;
    std::vector<std::uint8_t> asAcquired;  ///< pixels of the texture
    float mark = 0.0f;  ///< that the texture bears as its border's colour: a new one of the same name has none

    std::size_t bytes() const { return width * height * bytesPerPixel; }
};

struct SharingContext {
    void* glContext = nullptr;
    void* display = nullptr;
    bool isGlx = false;
};

std::map<cl_mem, SharedImage> images;
std::map<cl_context, SharingContext> contexts;
std::map<std::pair<cl_kernel, cl_uint>, cl_mem> kernelImages;

bool isCurrent(cl_context context) {
    const auto found = contexts.find(context);
    return found != contexts.end() && gl().getCurrentContext() == found->second.glContext &&
           gl().getCurrentDisplay() == found->second.display;
}

float markOf(const SharedImage& image) {
    float color[4] = {};
    const Bound bound(image.texture);
    gl().getTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, color);
    return color[0];
}

std::vector<std::uint8_t> texturePixels(const SharedImage& image) {
    std::vector<std::uint8_t> pixels(image.bytes());
    const Bound bound(image.texture);
    gl().getTexImage(GL_TEXTURE_2D, 0, image.format, image.type, pixels.data());
    return pixels;
}

/// Bytes of all ones are NaN in every float format, and no picture has them.
cl_int poison(cl_command_queue queue, cl_mem mem, const SharedImage& image) {
    const std::vector<std::uint8_t> ones(image.bytes(), 0xff);
    const std::size_t origin[3] = {0, 0, 0}, region[3] = {image.width, image.height, 1};
    return target.clEnqueueWriteImage(queue, mem, CL_TRUE, origin, region, 0, 0, ones.data(), 0, nullptr, nullptr);
}

/// The rule for every command that touches a shared image.
cl_int use(cl_mem mem, const char* call) {
    const auto found = images.find(mem);
    if (found == images.end() || found->second.isAcquired) return CL_SUCCESS;
    return violation(std::string(call) + " of texture " + std::to_string(found->second.texture) +
                     ", which is not acquired");
}

// --- what is overridden ---

cl_int CL_API_CALL getDeviceInfo(cl_device_id device, cl_device_info name, std::size_t size, void* value,
                                 std::size_t* sizeOut) {
    if (name != CL_DEVICE_EXTENSIONS) return target.clGetDeviceInfo(device, name, size, value, sizeOut);
    std::string more = "cl_khr_gl_sharing";
    if (environment("EARTHSHINE_LAYER_EVENTS") == "1") more += " cl_khr_gl_event";
    // Not what a driver has of these by itself, nor what the other transport would open with.
    return extensionsWith(target, more, {"cl_khr_gl_", "cl_khr_external_"}, device, size, value, sizeOut);
}

/// Takes the sharing properties out.
SharingContext takeSharing(const cl_context_properties* properties, std::vector<cl_context_properties>& rest) {
    SharingContext sharing;
    for (; properties && properties[0] != 0; properties += 2) {
        if (properties[0] == CL_GL_CONTEXT_KHR)
            sharing.glContext = reinterpret_cast<void*>(properties[1]);
        else if (properties[0] == CL_EGL_DISPLAY_KHR || properties[0] == CL_GLX_DISPLAY_KHR)
            sharing.display = reinterpret_cast<void*>(properties[1]);
        else
            rest.insert(rest.end(), {properties[0], properties[1]});
        sharing.isGlx = sharing.isGlx || properties[0] == CL_GLX_DISPLAY_KHR;
    }
    rest.push_back(0);
    return sharing;
}

cl_context CL_API_CALL createContext(const cl_context_properties* properties, cl_uint count,
                                     const cl_device_id* devices,
                                     void(CL_CALLBACK* notify)(const char*, const void*, std::size_t, void*),
                                     void* user, cl_int* codeOut) {
    std::vector<cl_context_properties> rest;
    const SharingContext sharing = takeSharing(properties, rest);
    if (sharing.glContext &&
        (sharing.glContext != gl().getCurrentContext() || sharing.display != gl().getCurrentDisplay())) {
        violation("clCreateContext with a GL context that is not current");
        if (codeOut) *codeOut = CL_INVALID_GL_SHAREGROUP_REFERENCE_KHR;
        return nullptr;
    }
    const cl_context context =
        target.clCreateContext(rest.size() > 1 ? rest.data() : nullptr, count, devices, notify, user, codeOut);
    contexts.erase(context);
    if (context && sharing.glContext) {
        contexts[context] = sharing;
        note(sharing.isGlx ? "context glx" : "context egl");
    }
    return context;
}

cl_int CL_API_CALL getGlContextInfo(const cl_context_properties* properties, cl_gl_context_info, std::size_t size,
                                    void* value, std::size_t* sizeOut) {
    std::vector<cl_context_properties> rest;
    const SharingContext sharing = takeSharing(properties, rest);
    if (!sharing.glContext || !sharing.display) return CL_INVALID_GL_SHAREGROUP_REFERENCE_KHR;
    cl_platform_id platform = nullptr;
    for (std::size_t i = 0; i + 1 < rest.size(); i += 2)
        if (rest[i] == CL_CONTEXT_PLATFORM) platform = reinterpret_cast<cl_platform_id>(rest[i + 1]);
    if (!platform) return CL_INVALID_PLATFORM;
    cl_uint count = 0;
    if (environment("EARTHSHINE_LAYER_DEVICE") != "none")
        target.clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count);
    if (sizeOut) *sizeOut = count * sizeof(cl_device_id);
    if (value && size >= sizeof(cl_device_id) && count > 0)
        target.clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, cl_uint(size / sizeof(cl_device_id)),
                              static_cast<cl_device_id*>(value), nullptr);
    return CL_SUCCESS;
}

cl_event CL_API_CALL createEventFromGlSync(cl_context context, cl_GLsync sync, cl_int* codeOut) {
    cl_int code = CL_SUCCESS;
    cl_event event = nullptr;
    if (!isCurrent(context)) {
        code = violation("clCreateEventFromGLsyncKHR without its GL context");
    } else {
        constexpr GLuint64 kTenSeconds = 10'000'000'000;
        const GLenum status = gl().clientWaitSync(reinterpret_cast<GLsync>(sync), 0, kTenSeconds);
        if (status == GL_TIMEOUT_EXPIRED || status == GL_WAIT_FAILED) {
            code = violation("a fence that was not flushed, or is none");
        } else {
            note("fence");
            event = target.clCreateUserEvent(context, &code);
            if (code == CL_SUCCESS) code = target.clSetUserEventStatus(event, CL_COMPLETE);
        }
    }
    if (codeOut) *codeOut = code;
    return event;
}

void* CL_API_CALL extensionFunction(cl_platform_id platform, const char* name) {
    if (std::strcmp(name, "clGetGLContextInfoKHR") == 0) return reinterpret_cast<void*>(getGlContextInfo);
    if (std::strcmp(name, "clCreateEventFromGLsyncKHR") == 0) return reinterpret_cast<void*>(createEventFromGlSync);
    return target.clGetExtensionFunctionAddressForPlatform(platform, name);
}

cl_mem CL_API_CALL createFromGlTexture(cl_context context, cl_mem_flags flags, cl_GLenum textureTarget, cl_GLint level,
                                       cl_GLuint texture, cl_int* codeOut) {
    const auto refuse = [&](cl_int code) -> cl_mem {
        if (codeOut) *codeOut = code;
        return nullptr;
    };
    if (!isCurrent(context)) return refuse(violation("clCreateFromGLTexture without its GL context"));
    if (fails("create")) return refuse(CL_OUT_OF_RESOURCES);
    if (textureTarget != GL_TEXTURE_2D || level != 0 || !gl().isTexture(texture)) return refuse(CL_INVALID_GL_OBJECT);
    GLint width = 0, height = 0, internalFormat = 0;
    {
        const Bound bound(texture);
        gl().getTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
        gl().getTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
        gl().getTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &internalFormat);
    }
    SharedImage image{context, texture, std::size_t(width), std::size_t(height), 0, GL_RGBA, GL_FLOAT, false, {}, 0.0f};
    cl_image_format format{CL_RGBA, CL_FLOAT};
    if (internalFormat == GL_RGBA32F) {
        image.bytesPerPixel = 16;
    } else if (internalFormat == GL_RGBA16F) {
        image.bytesPerPixel = 8;
        image.type = GL_HALF_FLOAT;
        format.image_channel_data_type = CL_HALF_FLOAT;
    } else if (internalFormat == GL_R32F) {
        image.bytesPerPixel = 4;
        image.format = GL_RED;
        format.image_channel_order = CL_R;
    } else {
        return refuse(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR);
    }
    cl_image_desc desc{};
    desc.image_type = CL_MEM_OBJECT_IMAGE2D;
    desc.image_width = image.width;
    desc.image_height = image.height;
    // Starts with NaN, as after a release.
    std::vector<std::uint8_t> ones(image.bytes(), 0xff);
    const cl_mem mem =
        target.clCreateImage(context, flags | CL_MEM_COPY_HOST_PTR, &format, &desc, ones.data(), codeOut);
    if (!mem) return nullptr;
    static float lastMark = 0.0f;
    const float color[4] = {lastMark += 1.0f, 0.0f, 0.0f, 0.0f};
    image.mark = lastMark;
    {
        const Bound bound(texture);
        gl().texParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, color);
    }
    images[mem] = std::move(image);
    note("create " + std::to_string(width) + "x" + std::to_string(height));
    return mem;
}

cl_int CL_API_CALL releaseMemObject(cl_mem mem) {
    const auto found = images.find(mem);
    cl_uint references = 0;
    if (found != images.end() &&
        target.clGetMemObjectInfo(mem, CL_MEM_REFERENCE_COUNT, sizeof references, &references, nullptr) == CL_SUCCESS &&
        references == 1) {
        if (found->second.isAcquired)
            violation("texture " + std::to_string(found->second.texture) + " is let go while it is acquired");
        else if (isCurrent(found->second.context) && !gl().isTexture(found->second.texture))
            violation("texture " + std::to_string(found->second.texture) + " was deleted before its image");
        note("destroy");
        images.erase(found);
    }
    return target.clReleaseMemObject(mem);
}

/// What acquire and release have in common; null if a rule is broken.
SharedImage* exchanged(cl_command_queue queue, cl_mem mem, const char* call, bool wasAcquired, cl_int& code) {
    const auto found = images.find(mem);
    if (found == images.end()) {
        code = violation(std::string(call) + " of what is no texture");
        return nullptr;
    }
    SharedImage& image = found->second;
    cl_context context = nullptr;
    target.clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof context, &context, nullptr);
    if (context != image.context)
        code = violation(std::string(call) + " in a queue of another context");
    else if (!isCurrent(context))
        code = violation(std::string(call) + " without its GL context");
    else if (image.isAcquired != wasAcquired)
        code = violation(std::string(call) + " of texture " + std::to_string(image.texture) + ", which is " +
                         (image.isAcquired ? "acquired already" : "not acquired"));
    else if (markOf(image) != image.mark)
        code = violation(std::string(call) + " of texture " + std::to_string(image.texture) +
                         ", which is no longer the one that was shared");
    else
        return &image;
    return nullptr;
}

cl_int CL_API_CALL acquire(cl_command_queue queue, cl_uint count, const cl_mem* mems, cl_uint waitCount,
                           const cl_event* waits, cl_event* event) {
    if (fails("acquire")) return CL_OUT_OF_RESOURCES;
    cl_int code = CL_SUCCESS;
    if (waitCount > 0) code = target.clWaitForEvents(waitCount, waits);
    for (cl_uint i = 0; i < count && code == CL_SUCCESS; ++i) {
        SharedImage* image = exchanged(queue, mems[i], "acquire", false, code);
        if (!image) break;
        image->asAcquired = texturePixels(*image);
        const std::size_t origin[3] = {0, 0, 0}, region[3] = {image->width, image->height, 1};
        code = target.clEnqueueWriteImage(queue, mems[i], CL_TRUE, origin, region, 0, 0, image->asAcquired.data(), 0,
                                          nullptr, nullptr);
        image->isAcquired = true;
    }
    if (code != CL_SUCCESS) return code;
    note("acquire " + std::to_string(count));
    return event ? target.clEnqueueMarkerWithWaitList(queue, 0, nullptr, event) : CL_SUCCESS;
}

cl_int CL_API_CALL release(cl_command_queue queue, cl_uint count, const cl_mem* mems, cl_uint waitCount,
                           const cl_event* waits, cl_event* event) {
    if (fails("release")) return CL_OUT_OF_RESOURCES;
    cl_int code = CL_SUCCESS;
    if (waitCount > 0) code = target.clWaitForEvents(waitCount, waits);
    for (cl_uint i = 0; i < count && code == CL_SUCCESS; ++i) {
        SharedImage* image = exchanged(queue, mems[i], "release", true, code);
        if (!image) break;
        if (texturePixels(*image) != image->asAcquired)
            return violation("GL touched texture " + std::to_string(image->texture) + " while it was acquired");
        std::vector<std::uint8_t> pixels(image->bytes());
        const std::size_t origin[3] = {0, 0, 0}, region[3] = {image->width, image->height, 1};
        code = target.clEnqueueReadImage(queue, mems[i], CL_TRUE, origin, region, 0, 0, pixels.data(), 0, nullptr,
                                         nullptr);
        {
            const Bound bound(image->texture);
            gl().texSubImage2D(GL_TEXTURE_2D, 0, 0, 0, GLsizei(image->width), GLsizei(image->height), image->format,
                               image->type, pixels.data());
        }
        if (code == CL_SUCCESS) code = poison(queue, mems[i], *image);
        image->isAcquired = false;
    }
    if (code != CL_SUCCESS) return code;
    note("release " + std::to_string(count));
    return event ? target.clEnqueueMarkerWithWaitList(queue, 0, nullptr, event) : CL_SUCCESS;
}

cl_int CL_API_CALL setKernelArg(cl_kernel kernel, cl_uint index, std::size_t size, const void* value) {
    cl_mem mem = nullptr;
    if (size == sizeof mem && value) std::memcpy(&mem, value, size);
    if (images.count(mem) > 0)
        kernelImages[{kernel, index}] = mem;
    else
        kernelImages.erase({kernel, index});
    return target.clSetKernelArg(kernel, index, size, value);
}

cl_int CL_API_CALL enqueueKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                 const std::size_t* offset, const std::size_t* global, const std::size_t* local,
                                 cl_uint waitCount, const cl_event* waits, cl_event* event) {
    for (const auto& [argument, mem] : kernelImages)
        if (argument.first == kernel)
            if (const cl_int code = use(mem, "a kernel's use"); code != CL_SUCCESS) return code;
    return target.clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local, waitCount, waits, event);
}

cl_int CL_API_CALL readImage(cl_command_queue queue, cl_mem image, cl_bool blocking, const std::size_t* origin,
                             const std::size_t* region, std::size_t rowPitch, std::size_t slicePitch, void* pointer,
                             cl_uint waitCount, const cl_event* waits, cl_event* event) {
    if (const cl_int code = use(image, "reading"); code != CL_SUCCESS) return code;
    return target.clEnqueueReadImage(queue, image, blocking, origin, region, rowPitch, slicePitch, pointer, waitCount,
                                     waits, event);
}

cl_int CL_API_CALL writeImage(cl_command_queue queue, cl_mem image, cl_bool blocking, const std::size_t* origin,
                              const std::size_t* region, std::size_t rowPitch, std::size_t slicePitch,
                              const void* pointer, cl_uint waitCount, const cl_event* waits, cl_event* event) {
    if (const cl_int code = use(image, "writing"); code != CL_SUCCESS) return code;
    return target.clEnqueueWriteImage(queue, image, blocking, origin, region, rowPitch, slicePitch, pointer, waitCount,
                                      waits, event);
}

cl_int CL_API_CALL copyImage(cl_command_queue queue, cl_mem from, cl_mem to, const std::size_t* fromOrigin,
                             const std::size_t* toOrigin, const std::size_t* region, cl_uint waitCount,
                             const cl_event* waits, cl_event* event) {
    for (const cl_mem image : {from, to})
        if (const cl_int code = use(image, "copying"); code != CL_SUCCESS) return code;
    return target.clEnqueueCopyImage(queue, from, to, fromOrigin, toOrigin, region, waitCount, waits, event);
}

}  // namespace

CL_API_ENTRY cl_int CL_API_CALL clGetLayerInfo(cl_layer_info name, std::size_t size, void* value,
                                               std::size_t* sizeOut) {
    return layerInfo("gl_sharing by copies", name, size, value, sizeOut);
}

CL_API_ENTRY cl_int CL_API_CALL clInitLayer(cl_uint count, const cl_icd_dispatch* below, cl_uint* countOut,
                                            const cl_icd_dispatch** layerOut) {
    if (!below || !layerOut || !countOut || count < sizeof(cl_icd_dispatch) / sizeof(void*)) return CL_INVALID_VALUE;
    target = *below;
    layer = target;
    layer.clGetDeviceInfo = getDeviceInfo;
    layer.clCreateContext = createContext;
    layer.clGetGLContextInfoKHR = getGlContextInfo;
    layer.clGetExtensionFunctionAddressForPlatform = extensionFunction;
    layer.clCreateFromGLTexture = createFromGlTexture;
    layer.clReleaseMemObject = releaseMemObject;
    layer.clEnqueueAcquireGLObjects = acquire;
    layer.clEnqueueReleaseGLObjects = release;
    layer.clSetKernelArg = setKernelArg;
    layer.clEnqueueNDRangeKernel = enqueueKernel;
    layer.clEnqueueReadImage = readImage;
    layer.clEnqueueWriteImage = writeImage;
    layer.clEnqueueCopyImage = copyImage;
    *countOut = sizeof(cl_icd_dispatch) / sizeof(void*);
    *layerOut = &layer;
    return CL_SUCCESS;
}
