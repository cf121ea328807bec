// An OpenCL layer that gives every device external memory and semaphores (cl_khr_external_memory_opaque_fd,
// cl_khr_external_semaphore_opaque_fd), by copies, over the fake Vulkan and OpenGL of these tests. It keeps the rules
// as gl_sharing_layer.cpp does, and those of semaphores: none is waited for before its signal was flushed, none is
// signalled twice, textures are acquired after the wait and released before the signal.
//
// Environment: EARTHSHINE_LAYER_LOG, EARTHSHINE_LAYER_FAIL (import, semaphore, wait, acquire, release, signal),
// EARTHSHINE_LAYER_DEVICE=opencl (another device's number than OpenGL's).

#include "interop/external_objects.hpp"
#include "interop/layer_support.hpp"

namespace {

using namespace layer_support;

cl_icd_dispatch target;
cl_icd_dispatch layer;

struct SharedImage {
    test::Imported memory;
    std::size_t width, height, bytesPerPixel;
    GLenum format, type;
    bool isAcquired = false;
    std::vector<std::uint8_t> asAcquired;
};
std::map<cl_mem, SharedImage> images;
std::map<std::pair<cl_kernel, cl_uint>, cl_mem> kernelImages;
std::vector<test::ExternalObject*> pending;  ///< signalled by OpenCL, not flushed
bool hasWaited = false;                      ///< since the last signal

std::vector<std::uint8_t> texturePixels(const SharedImage& image) {
    std::vector<std::uint8_t> pixels(image.width * image.height * image.bytesPerPixel);
    const Bound bound(image.memory.object->texture);
    gl().getTexImage(GL_TEXTURE_2D, 0, image.format, image.type, pixels.data());
    return pixels;
}

cl_int use(cl_mem mem, const char* call) {
    const auto found = images.find(mem);
    if (found == images.end() || found->second.isAcquired) return CL_SUCCESS;
    return violation(std::string(call) + " of an image that is not acquired");
}

void submit() {
    for (test::ExternalObject* semaphore : pending) {
        semaphore->isPending = 0;
        semaphore->isSignalled = 1;
    }
    pending.clear();
}

cl_int CL_API_CALL getDeviceInfo(cl_device_id device, cl_device_info name, std::size_t size, void* value,
                                 std::size_t* sizeOut) {
    if (name == CL_DEVICE_UUID_KHR) {
        if (sizeOut) *sizeOut = 16;
        const bool isOther = environment("EARTHSHINE_LAYER_DEVICE") == "opencl";
        if (value && size >= 16) std::memset(value, isOther ? 2 : test::kUuidByte, 16);
        return CL_SUCCESS;
    }
    if (name != CL_DEVICE_EXTENSIONS) return target.clGetDeviceInfo(device, name, size, value, sizeOut);
    return extensionsWith(target,
                          "cl_khr_device_uuid cl_khr_external_memory cl_khr_external_memory_opaque_fd"
                          " cl_khr_semaphore cl_khr_external_semaphore cl_khr_external_semaphore_opaque_fd",
                          {"cl_khr_gl_"}, device, size, value, sizeOut);
}

cl_mem CL_API_CALL createImageWithProperties(cl_context context, const cl_mem_properties* properties,
                                             cl_mem_flags flags, const cl_image_format* format,
                                             const cl_image_desc* desc, void* host, cl_int* codeOut) {
    if (!properties || properties[0] != CL_EXTERNAL_MEMORY_HANDLE_OPAQUE_FD_KHR)
        return target.clCreateImageWithProperties(context, properties, flags, format, desc, host, codeOut);
    if (properties[2] != CL_DEVICE_HANDLE_LIST_KHR || properties[4] != CL_DEVICE_HANDLE_LIST_END_KHR ||
        properties[5] != 0)
        violation("an external image's properties");
    // Mipmaps must be said not to be there in the way that a test asks for: 0 or 1.
    const cl_uint levels = environment("EARTHSHINE_LAYER_DEVICE") == "levels" ? 1 : 0;
    if (desc->num_mip_levels != levels) {
        *codeOut = CL_INVALID_IMAGE_DESCRIPTOR;
        return nullptr;
    }
    if (fails("import")) {
        *codeOut = CL_OUT_OF_RESOURCES;
        return nullptr;
    }
    const bool isOne = format->image_channel_order == CL_R;
    const bool isHalf = format->image_channel_data_type == CL_HALF_FLOAT;
    SharedImage image{test::importObject(int(properties[1])),
                      desc->image_width,
                      desc->image_height,
                      std::size_t(isOne    ? 4
                                  : isHalf ? 8
                                           : 16),
                      GLenum(isOne ? GL_RED : GL_RGBA),
                      GLenum(isHalf ? GL_HALF_FLOAT : GL_FLOAT),
                      false,
                      {}};
    if (!image.memory.object) {
        *codeOut = CL_INVALID_VALUE;
        return nullptr;
    }
    cl_image_desc plain = *desc;
    plain.num_mip_levels = 0;
    std::vector<std::uint8_t> ones(image.width * image.height * image.bytesPerPixel, 0xff);  // NaN
    const cl_mem mem =
        target.clCreateImage(context, flags | CL_MEM_COPY_HOST_PTR, format, &plain, ones.data(), codeOut);
    if (mem) images[mem] = std::move(image);
    if (mem) note("import");
    return mem;
}

cl_int CL_API_CALL releaseMemObject(cl_mem mem) {
    const auto found = images.find(mem);
    cl_uint references = 0;
    if (found != images.end() &&
        target.clGetMemObjectInfo(mem, CL_MEM_REFERENCE_COUNT, sizeof references, &references, nullptr) == CL_SUCCESS &&
        references == 1) {
        if (found->second.isAcquired) violation("an image is let go while it is acquired");
        if (!gl().isTexture(found->second.memory.object->texture)) violation("a texture was deleted before its image");
        if (!test::letGo(found->second.memory)) violation("an image's descriptor was closed by another than OpenCL");
        note("let go");
        images.erase(found);
    }
    return target.clReleaseMemObject(mem);
}

cl_semaphore_khr CL_API_CALL createSemaphore(cl_context, const cl_semaphore_properties_khr* p, cl_int* codeOut) {
    *codeOut = CL_SUCCESS;
    if (fails("semaphore")) {
        *codeOut = CL_OUT_OF_RESOURCES;
        return nullptr;
    }
    if (p[0] != CL_SEMAPHORE_TYPE_KHR || p[1] != CL_SEMAPHORE_TYPE_BINARY_KHR ||
        p[2] != CL_SEMAPHORE_HANDLE_OPAQUE_FD_KHR || p[4] != 0) {
        *codeOut = CL_INVALID_PROPERTY;
        return nullptr;
    }
    return reinterpret_cast<cl_semaphore_khr>(new test::Imported(test::importObject(int(p[3]))));
}
test::ExternalObject* objectOf(cl_semaphore_khr semaphore) {
    return reinterpret_cast<test::Imported*>(semaphore)->object;
}
cl_int CL_API_CALL releaseSemaphore(cl_semaphore_khr semaphore) {
    auto* imported = reinterpret_cast<test::Imported*>(semaphore);
    if (!test::letGo(*imported)) violation("a semaphore's descriptor was closed by another than OpenCL");
    delete imported;
    note("semaphore let go");
    return CL_SUCCESS;
}

cl_int CL_API_CALL waitSemaphores(cl_command_queue, cl_uint count, const cl_semaphore_khr* semaphores,
                                  const cl_semaphore_payload_khr*, cl_uint, const cl_event*, cl_event*) {
    if (fails("wait")) return CL_OUT_OF_RESOURCES;
    for (cl_uint i = 0; i < count; ++i) {
        test::ExternalObject* semaphore = objectOf(semaphores[i]);
        if (!semaphore->isSignalled)
            return violation(semaphore->isPending ? "OpenCL waits for what OpenGL did not flush"
                                                  : "OpenCL waits for what OpenGL did not signal");
        semaphore->isSignalled = 0;
    }
    hasWaited = true;
    return CL_SUCCESS;
}
cl_int CL_API_CALL signalSemaphores(cl_command_queue, cl_uint count, const cl_semaphore_khr* semaphores,
                                    const cl_semaphore_payload_khr*, cl_uint, const cl_event*, cl_event*) {
    if (fails("signal")) return CL_OUT_OF_RESOURCES;
    for (const auto& [mem, image] : images)
        if (image.isAcquired) return violation("OpenCL signals while an image is acquired");
    for (cl_uint i = 0; i < count; ++i) {
        test::ExternalObject* semaphore = objectOf(semaphores[i]);
        if (semaphore->isSignalled || semaphore->isPending) return violation("OpenCL signals twice");
        semaphore->isPending = 1;
        pending.push_back(semaphore);
    }
    hasWaited = false;
    return CL_SUCCESS;
}

cl_int CL_API_CALL acquire(cl_command_queue queue, cl_uint count, const cl_mem* mems, cl_uint, const cl_event*,
                           cl_event*) {
    if (fails("acquire")) return CL_OUT_OF_RESOURCES;
    if (!hasWaited) return violation("OpenCL acquires without waiting for OpenGL");
    for (cl_uint i = 0; i < count; ++i) {
        const auto found = images.find(mems[i]);
        if (found == images.end()) return violation("acquire of what is not external");
        SharedImage& image = found->second;
        if (image.isAcquired) return violation("acquire of what is acquired already");
        if (image.memory.object->texture == 0) return violation("acquire of memory that is no texture yet");
        image.asAcquired = texturePixels(image);
        const std::size_t origin[3] = {0, 0, 0}, region[3] = {image.width, image.height, 1};
        const cl_int code = target.clEnqueueWriteImage(queue, mems[i], CL_TRUE, origin, region, 0, 0,
                                                       image.asAcquired.data(), 0, nullptr, nullptr);
        if (code != CL_SUCCESS) return code;
        image.isAcquired = true;
    }
    note("acquire " + std::to_string(count));
    return CL_SUCCESS;
}
cl_int CL_API_CALL release(cl_command_queue queue, cl_uint count, const cl_mem* mems, cl_uint, const cl_event*,
                           cl_event*) {
    if (fails("release")) return CL_OUT_OF_RESOURCES;
    for (cl_uint i = 0; i < count; ++i) {
        const auto found = images.find(mems[i]);
        if (found == images.end() || !found->second.isAcquired) return violation("release of what is not acquired");
        SharedImage& image = found->second;
        if (texturePixels(image) != image.asAcquired) return violation("GL touched a texture while it was acquired");
        std::vector<std::uint8_t> pixels(image.asAcquired.size());
        const std::size_t origin[3] = {0, 0, 0}, region[3] = {image.width, image.height, 1};
        target.clEnqueueReadImage(queue, mems[i], CL_TRUE, origin, region, 0, 0, pixels.data(), 0, nullptr, nullptr);
        {
            const Bound bound(image.memory.object->texture);
            gl().texSubImage2D(GL_TEXTURE_2D, 0, 0, 0, GLsizei(image.width), GLsizei(image.height), image.format,
                               image.type, pixels.data());
        }
        const std::vector<std::uint8_t> ones(pixels.size(), 0xff);
        target.clEnqueueWriteImage(queue, mems[i], CL_TRUE, origin, region, 0, 0, ones.data(), 0, nullptr, nullptr);
        image.isAcquired = false;
    }
    note("release " + std::to_string(count));
    return CL_SUCCESS;
}

cl_int CL_API_CALL flush(cl_command_queue queue) {
    submit();
    return target.clFlush(queue);
}
cl_int CL_API_CALL finish(cl_command_queue queue) {
    submit();
    return target.clFinish(queue);
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

void* CL_API_CALL extensionFunction(cl_platform_id platform, const char* name) {
    const std::string function = name;
    if (function == "clCreateSemaphoreWithPropertiesKHR") return reinterpret_cast<void*>(createSemaphore);
    if (function == "clReleaseSemaphoreKHR") return reinterpret_cast<void*>(releaseSemaphore);
    if (function == "clEnqueueWaitSemaphoresKHR") return reinterpret_cast<void*>(waitSemaphores);
    if (function == "clEnqueueSignalSemaphoresKHR") return reinterpret_cast<void*>(signalSemaphores);
    if (function == "clEnqueueAcquireExternalMemObjectsKHR") return reinterpret_cast<void*>(acquire);
    if (function == "clEnqueueReleaseExternalMemObjectsKHR") return reinterpret_cast<void*>(release);
    return target.clGetExtensionFunctionAddressForPlatform(platform, name);
}

}  // namespace

CL_API_ENTRY cl_int CL_API_CALL clGetLayerInfo(cl_layer_info name, std::size_t size, void* value,
                                               std::size_t* sizeOut) {
    return layerInfo("external memory by copies", name, size, value, sizeOut);
}

CL_API_ENTRY cl_int CL_API_CALL clInitLayer(cl_uint count, const cl_icd_dispatch* below, cl_uint* countOut,
                                            const cl_icd_dispatch** layerOut) {
    if (!below || !layerOut || !countOut || count < sizeof(cl_icd_dispatch) / sizeof(void*)) return CL_INVALID_VALUE;
    target = *below;
    layer = target;
    layer.clGetDeviceInfo = getDeviceInfo;
    layer.clGetExtensionFunctionAddressForPlatform = extensionFunction;
    layer.clCreateImageWithProperties = createImageWithProperties;
    layer.clReleaseMemObject = releaseMemObject;
    layer.clFlush = flush;
    layer.clFinish = finish;
    layer.clSetKernelArg = setKernelArg;
    layer.clEnqueueNDRangeKernel = enqueueKernel;
    *countOut = sizeof(cl_icd_dispatch) / sizeof(void*);
    *layerOut = &layer;
    return CL_SUCCESS;
}
