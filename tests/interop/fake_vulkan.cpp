// A libvulkan.so.1 of the tests' own: it allocates nothing but numbered files in memory, so that the call sequence of
// the transport `external-memory` runs where no driver exports anything. What the specification asks for is checked:
// external images in dedicated, exported memory, nothing left when the device goes. What is handed over carries, as its
// first words, what the fake OpenGL and the OpenCL layer say to each other (external_objects.hpp).

#include <sys/mman.h>
#include <unistd.h>

#include <set>

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

#include "interop/external_objects.hpp"
#include "interop/layer_support.hpp"

namespace {

using namespace layer_support;

struct Object {
    const char* kind;
    int fd = -1;
    std::uint64_t sizeBytes = 0;
};
std::set<Object*>& live() {
    static std::set<Object*> objects;
    return objects;
}
template <class Handle>
Handle make(const char* kind, std::uint64_t bytes = 0) {
    auto* object = new Object{kind, -1, bytes};
    if (bytes > 0) {
        object->fd = ::memfd_create((std::string("fake-vulkan-") + kind).c_str(), MFD_CLOEXEC);
        if (::ftruncate(object->fd, off_t(sizeof(test::ExternalObject))) != 0) violation("ftruncate");
    }
    live().insert(object);
    note(std::string("vk make ") + kind);
    return reinterpret_cast<Handle>(object);
}
template <class Handle>
void destroy(Handle handle) {
    auto* object = reinterpret_cast<Object*>(handle);
    if (live().erase(object) == 0) {
        violation("Vulkan destroys what is not there");
        return;
    }
    note(std::string("vk destroy ") + object->kind);
    if (object->fd >= 0) ::close(object->fd);
    delete object;
}

/// The structure of a type in a pNext chain; null if there is none.
template <class Struct>
const Struct* next(const void* chain, VkStructureType type) {
    for (auto* s = static_cast<const VkBaseInStructure*>(chain); s; s = s->pNext)
        if (s->sType == type) return reinterpret_cast<const Struct*>(s);
    return nullptr;
}

VkResult exportFd(Object* object, int* fd) {
    *fd = ::dup(object->fd);
    return *fd >= 0 ? VK_SUCCESS : VK_ERROR_TOO_MANY_OBJECTS;
}

#define FAILS(CALL, CODE) \
    if (fails(CALL)) return CODE

VkResult createInstance(const VkInstanceCreateInfo*, const VkAllocationCallbacks*, VkInstance* out) {
    FAILS("vkCreateInstance", VK_ERROR_INCOMPATIBLE_DRIVER);
    static int instance = 0;
    *out = reinterpret_cast<VkInstance>(&instance);
    return VK_SUCCESS;
}
void destroyInstance(VkInstance, const VkAllocationCallbacks*) {
    violation("Vulkan's instance is destroyed, and NVIDIA's OpenGL with it");
}
VkResult enumeratePhysicalDevices(VkInstance, std::uint32_t* count, VkPhysicalDevice* devices) {
    static int device = 0;
    if (devices && *count > 0) devices[0] = reinterpret_cast<VkPhysicalDevice>(&device);
    *count = 1;
    return VK_SUCCESS;
}
void physicalDeviceProperties2(VkPhysicalDevice, VkPhysicalDeviceProperties2* properties) {
    std::strcpy(properties->properties.deviceName, "fake");
    properties->properties.apiVersion = VK_API_VERSION_1_1;
    auto* ids = const_cast<VkPhysicalDeviceIDProperties*>(
        next<VkPhysicalDeviceIDProperties>(properties->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES));
    const bool isOther = environment("EARTHSHINE_LAYER_DEVICE") == "vulkan";
    if (ids) std::memset(ids->deviceUUID, isOther ? 1 : test::kUuidByte, VK_UUID_SIZE);
}
void physicalDeviceMemoryProperties(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* properties) {
    *properties = {};
    properties->memoryTypeCount = 2;
    properties->memoryTypes[1].propertyFlags = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
}
VkResult imageFormatProperties2(VkPhysicalDevice, const VkPhysicalDeviceImageFormatInfo2* info,
                                VkImageFormatProperties2* properties) {
    FAILS("vkGetPhysicalDeviceImageFormatProperties2", VK_ERROR_FORMAT_NOT_SUPPORTED);
    const auto* external = next<VkPhysicalDeviceExternalImageFormatInfo>(
        info->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_IMAGE_FORMAT_INFO);
    auto* exported = const_cast<VkExternalImageFormatProperties*>(
        next<VkExternalImageFormatProperties>(properties->pNext, VK_STRUCTURE_TYPE_EXTERNAL_IMAGE_FORMAT_PROPERTIES));
    if (external && exported && external->handleType == VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT)
        exported->externalMemoryProperties.externalMemoryFeatures = VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT;
    return VK_SUCCESS;
}
void externalSemaphoreProperties(VkPhysicalDevice, const VkPhysicalDeviceExternalSemaphoreInfo*,
                                 VkExternalSemaphoreProperties* properties) {
    properties->externalSemaphoreFeatures = VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT;
}
VkResult deviceExtensions(VkPhysicalDevice, const char*, std::uint32_t* count, VkExtensionProperties* out) {
    const char* kNames[] = {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME};
    const bool hasNone = environment("EARTHSHINE_LAYER_FAIL") == "extensions";
    *count = hasNone ? 1 : 2;
    for (std::uint32_t i = 0; out && i < *count; ++i) std::strcpy(out[i].extensionName, kNames[i]);
    return VK_SUCCESS;
}
VkResult createDevice(VkPhysicalDevice, const VkDeviceCreateInfo* info, const VkAllocationCallbacks*, VkDevice* out) {
    FAILS("vkCreateDevice", VK_ERROR_INITIALIZATION_FAILED);
    if (info->queueCreateInfoCount < 1 || info->enabledExtensionCount != 2) violation("vkCreateDevice's queues");
    *out = make<VkDevice>("device");
    return VK_SUCCESS;
}
void destroyDevice(VkDevice device, const VkAllocationCallbacks*) {
    destroy(device);
    for (const Object* object : live()) violation(std::string("Vulkan's device goes before a ") + object->kind);
}
VkResult createImage(VkDevice, const VkImageCreateInfo* info, const VkAllocationCallbacks*, VkImage* out) {
    FAILS("vkCreateImage", VK_ERROR_OUT_OF_DEVICE_MEMORY);
    const auto* external =
        next<VkExternalMemoryImageCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO);
    if (!external || external->handleTypes != VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT)
        violation("vkCreateImage without external memory");
    if (info->tiling != VK_IMAGE_TILING_OPTIMAL || !(info->usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT))
        violation("vkCreateImage's tiling or usage");
    *out = make<VkImage>("image");
    return VK_SUCCESS;
}
void destroyImage(VkDevice, VkImage image, const VkAllocationCallbacks*) {
    destroy(image);
}
void imageMemoryRequirements(VkDevice, VkImage, VkMemoryRequirements* needs) {
    *needs = {1 << 20, 65536, 2};  // the second type of memory alone
}
VkResult allocateMemory(VkDevice, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks*, VkDeviceMemory* out) {
    FAILS("vkAllocateMemory", VK_ERROR_OUT_OF_DEVICE_MEMORY);
    const auto* exported = next<VkExportMemoryAllocateInfo>(info->pNext, VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
    const auto* dedicated =
        next<VkMemoryDedicatedAllocateInfo>(info->pNext, VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
    if (!exported || exported->handleTypes != VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT)
        violation("vkAllocateMemory without export");
    if (!dedicated || dedicated->image == VK_NULL_HANDLE || info->memoryTypeIndex != 1)
        violation("vkAllocateMemory: not dedicated, or not the device's");
    *out = make<VkDeviceMemory>("memory", info->allocationSize);
    return VK_SUCCESS;
}
void freeMemory(VkDevice, VkDeviceMemory memory, const VkAllocationCallbacks*) {
    destroy(memory);
}
VkResult bindImageMemory(VkDevice, VkImage, VkDeviceMemory, VkDeviceSize) {
    FAILS("vkBindImageMemory", VK_ERROR_OUT_OF_DEVICE_MEMORY);
    return VK_SUCCESS;
}
VkResult getMemoryFd(VkDevice, const VkMemoryGetFdInfoKHR* info, int* fd) {
    FAILS("vkGetMemoryFdKHR", VK_ERROR_TOO_MANY_OBJECTS);
    return exportFd(reinterpret_cast<Object*>(info->memory), fd);
}
VkResult createSemaphore(VkDevice, const VkSemaphoreCreateInfo* info, const VkAllocationCallbacks*, VkSemaphore* out) {
    FAILS("vkCreateSemaphore", VK_ERROR_OUT_OF_HOST_MEMORY);
    const auto* exported =
        next<VkExportSemaphoreCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO);
    if (!exported || exported->handleTypes != VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT)
        violation("vkCreateSemaphore without export");
    *out = make<VkSemaphore>("semaphore", 1);
    return VK_SUCCESS;
}
void destroySemaphore(VkDevice, VkSemaphore semaphore, const VkAllocationCallbacks*) {
    destroy(semaphore);
}
VkResult getSemaphoreFd(VkDevice, const VkSemaphoreGetFdInfoKHR* info, int* fd) {
    FAILS("vkGetSemaphoreFdKHR", VK_ERROR_TOO_MANY_OBJECTS);
    return exportFd(reinterpret_cast<Object*>(info->semaphore), fd);
}

PFN_vkVoidFunction deviceFunction(VkDevice, const char* name);

PFN_vkVoidFunction function(const char* name) {
#define ENTRY(NAME, FUNCTION) \
    { NAME, reinterpret_cast<PFN_vkVoidFunction>(FUNCTION) }
    static const std::map<std::string, PFN_vkVoidFunction> kFunctions{
        ENTRY("vkCreateInstance", createInstance),
        ENTRY("vkDestroyInstance", destroyInstance),
        ENTRY("vkEnumeratePhysicalDevices", enumeratePhysicalDevices),
        ENTRY("vkGetPhysicalDeviceProperties2", physicalDeviceProperties2),
        ENTRY("vkGetPhysicalDeviceMemoryProperties", physicalDeviceMemoryProperties),
        ENTRY("vkGetPhysicalDeviceImageFormatProperties2", imageFormatProperties2),
        ENTRY("vkGetPhysicalDeviceExternalSemaphoreProperties", externalSemaphoreProperties),
        ENTRY("vkEnumerateDeviceExtensionProperties", deviceExtensions),
        ENTRY("vkCreateDevice", createDevice),
        ENTRY("vkGetDeviceProcAddr", deviceFunction),
        ENTRY("vkDestroyDevice", destroyDevice),
        ENTRY("vkCreateImage", createImage),
        ENTRY("vkDestroyImage", destroyImage),
        ENTRY("vkGetImageMemoryRequirements", imageMemoryRequirements),
        ENTRY("vkAllocateMemory", allocateMemory),
        ENTRY("vkFreeMemory", freeMemory),
        ENTRY("vkBindImageMemory", bindImageMemory),
        ENTRY("vkGetMemoryFdKHR", getMemoryFd),
        ENTRY("vkCreateSemaphore", createSemaphore),
        ENTRY("vkDestroySemaphore", destroySemaphore),
        ENTRY("vkGetSemaphoreFdKHR", getSemaphoreFd),
    };
#undef ENTRY
    const auto found = kFunctions.find(name);
    return found == kFunctions.end() ? nullptr : found->second;
}
PFN_vkVoidFunction deviceFunction(VkDevice, const char* name) {
    return function(name);
}

}  // namespace

extern "C" PFN_vkVoidFunction vkGetInstanceProcAddr(VkInstance, const char* name);
extern "C" PFN_vkVoidFunction vkGetInstanceProcAddr(VkInstance, const char* name) {
    return function(name);
}
