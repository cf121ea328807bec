#include "interop/vulkan_exporter.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

#include "earthshine/error.hpp"

namespace earthshine {

namespace {

constexpr const char* kDeviceExtensions[] = {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME,
                                             VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME};
constexpr VkExternalMemoryHandleTypeFlagBits kMemoryHandle = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
constexpr VkExternalSemaphoreHandleTypeFlagBits kSemaphoreHandle = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
// All that a GL texture may be used for: drivers lay an image out by its usage, and GL says none when it imports.
constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;

std::string resultName(VkResult code) {
    static constexpr struct {
        VkResult code;
        const char* name;
    } kNames[] = {
        {VK_ERROR_OUT_OF_HOST_MEMORY, "VK_ERROR_OUT_OF_HOST_MEMORY"},
        {VK_ERROR_OUT_OF_DEVICE_MEMORY, "VK_ERROR_OUT_OF_DEVICE_MEMORY"},
        {VK_ERROR_INITIALIZATION_FAILED, "VK_ERROR_INITIALIZATION_FAILED"},
        {VK_ERROR_DEVICE_LOST, "VK_ERROR_DEVICE_LOST"},
        {VK_ERROR_EXTENSION_NOT_PRESENT, "VK_ERROR_EXTENSION_NOT_PRESENT"},
        {VK_ERROR_FEATURE_NOT_PRESENT, "VK_ERROR_FEATURE_NOT_PRESENT"},
        {VK_ERROR_INCOMPATIBLE_DRIVER, "VK_ERROR_INCOMPATIBLE_DRIVER"},
        {VK_ERROR_TOO_MANY_OBJECTS, "VK_ERROR_TOO_MANY_OBJECTS"},
        {VK_ERROR_FORMAT_NOT_SUPPORTED, "VK_ERROR_FORMAT_NOT_SUPPORTED"},
    };
    for (const auto& entry : kNames)
        if (entry.code == code) return fmt::format("{} ({})", entry.name, int(code));
    return fmt::format("VkResult {}", int(code));
}

void check(VkResult code, const char* call) {
    if (code != VK_SUCCESS) throw DeviceError(fmt::format("{}: {}", call, resultName(code)));
}

VkFormat vulkanFormat(PixelFormat format) {
    switch (format) {
        case PixelFormat::R32F:
            return VK_FORMAT_R32_SFLOAT;
        case PixelFormat::RGBA16F:
            return VK_FORMAT_R16G16B16A16_SFLOAT;
        case PixelFormat::RGBA8:
            return VK_FORMAT_R8G8B8A8_UNORM;
        case PixelFormat::RGBA32F:
            break;
    }
    return VK_FORMAT_R32G32B32A32_SFLOAT;
}

std::string text(const DeviceUuid& uuid) {
    return fmt::format("{:02x}", fmt::join(uuid, ""));
}

// X(name without "vk"); looked up in the loader's library, with the instance, with the device.
#define EARTHSHINE_VK_INSTANCE(X)                   \
    X(EnumeratePhysicalDevices)                     \
    X(GetPhysicalDeviceProperties2)                 \
    X(GetPhysicalDeviceMemoryProperties)            \
    X(GetPhysicalDeviceImageFormatProperties2)      \
    X(GetPhysicalDeviceExternalSemaphoreProperties) \
    X(EnumerateDeviceExtensionProperties)           \
    X(CreateDevice)                                 \
    X(GetDeviceProcAddr)
#define EARTHSHINE_VK_DEVICE(X)   \
    X(DestroyDevice)              \
    X(CreateImage)                \
    X(DestroyImage)               \
    X(GetImageMemoryRequirements) \
    X(AllocateMemory)             \
    X(FreeMemory)                 \
    X(BindImageMemory)            \
    X(GetMemoryFdKHR)             \
    X(CreateSemaphore)            \
    X(DestroySemaphore)           \
    X(GetSemaphoreFdKHR)

}  // namespace

Fd::Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
Fd& Fd::operator=(Fd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
}
Fd::~Fd() {
    if (fd_ >= 0) ::close(fd_);
}

struct VulkanExporter::Impl {
#define EARTHSHINE_VK_MEMBER(NAME) PFN_vk##NAME NAME = nullptr;
    EARTHSHINE_VK_INSTANCE(EARTHSHINE_VK_MEMBER)
    EARTHSHINE_VK_DEVICE(EARTHSHINE_VK_MEMBER)
#undef EARTHSHINE_VK_MEMBER
    VkInstance instance = nullptr;
    VkPhysicalDevice physical = nullptr;
    VkDevice device = nullptr;
    VkPhysicalDeviceMemoryProperties memoryTypes{};
    struct Owned {
        VkImage image;
        VkDeviceMemory memory;
    };
    std::map<std::uint64_t, Owned> images;
    std::uint64_t lastId = 0;
    std::vector<VkSemaphore> semaphores;

    ~Impl() {
        for (const auto& [id, owned] : images) release(owned);
        for (const VkSemaphore semaphore : semaphores) DestroySemaphore(device, semaphore, nullptr);
        if (device) DestroyDevice(device, nullptr);
    }
    void release(const Owned& owned) const {
        if (owned.image) DestroyImage(device, owned.image, nullptr);
        if (owned.memory) FreeMemory(device, owned.memory, nullptr);
    }

    void open(const DeviceUuid& uuid) {
        openInstance();
        findDevice(uuid);
        requireExtensions();
        openDevice();
    }

    void openInstance() {
        // Never closed: drivers leave threads and exit handlers behind.
        void* library = ::dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
        if (!library) throw DeviceError(fmt::format("no Vulkan loader: {}", ::dlerror()));
        const auto find = reinterpret_cast<PFN_vkGetInstanceProcAddr>(::dlsym(library, "vkGetInstanceProcAddr"));
        if (!find) throw DeviceError("libvulkan.so.1 has no vkGetInstanceProcAddr");
        const auto createInstance = reinterpret_cast<PFN_vkCreateInstance>(find(nullptr, "vkCreateInstance"));
        if (!createInstance) throw DeviceError("libvulkan.so.1 has no vkCreateInstance");
        VkApplicationInfo application{};
        application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
        application.pApplicationName = "earthshine";
        application.apiVersion = VK_API_VERSION_1_1;  // external memory and semaphores, dedicated allocations
        VkInstanceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        info.pApplicationInfo = &application;
        // One for the process, never destroyed: on NVIDIA's driver, whose OpenGL shares libraries with its Vulkan,
        // every GL call after the instance's end finds no context (580.159, EGL's device platform).
        static std::mutex mutex;
        static VkInstance kept = nullptr;
        const std::lock_guard lock(mutex);
        if (!kept) check(createInstance(&info, nullptr, &kept), "vkCreateInstance");
        instance = kept;
#define EARTHSHINE_VK_LOAD(NAME)                                       \
    NAME = reinterpret_cast<PFN_vk##NAME>(find(instance, "vk" #NAME)); \
    if (!NAME) throw DeviceError("this Vulkan has no vk" #NAME ": 1.1 is needed");
        EARTHSHINE_VK_INSTANCE(EARTHSHINE_VK_LOAD)
#undef EARTHSHINE_VK_LOAD
    }

    void findDevice(const DeviceUuid& uuid) {
        std::uint32_t count = 0;
        check(EnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
        std::vector<VkPhysicalDevice> devices(count);
        check(EnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
        std::string others;
        for (const VkPhysicalDevice candidate : devices) {
            VkPhysicalDeviceIDProperties ids{};
            ids.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES;
            VkPhysicalDeviceProperties2 properties{};
            properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
            properties.pNext = &ids;
            GetPhysicalDeviceProperties2(candidate, &properties);
            others += fmt::format("{}\"{}\"", others.empty() ? "" : ", ", properties.properties.deviceName);
            if (properties.properties.apiVersion < VK_API_VERSION_1_1 ||
                std::memcmp(ids.deviceUUID, uuid.data(), uuid.size()) != 0)
                continue;
            physical = candidate;
            return;
        }
        throw DeviceError(fmt::format("Vulkan has no device with OpenGL's number {}, only {}", text(uuid),
                                      others.empty() ? "none at all" : others));
    }

    void requireExtensions() const {
        std::uint32_t count = 0;
        check(EnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr),
              "vkEnumerateDeviceExtensionProperties");
        std::vector<VkExtensionProperties> extensions(count);
        check(EnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()),
              "vkEnumerateDeviceExtensionProperties");
        for (const char* wanted : kDeviceExtensions)
            if (std::none_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
                    return std::strcmp(extension.extensionName, wanted) == 0;
                }))
                throw DeviceError(fmt::format("Vulkan's device has no {}", wanted));
        VkPhysicalDeviceExternalSemaphoreInfo info{};
        info.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_SEMAPHORE_INFO;
        info.handleType = kSemaphoreHandle;
        VkExternalSemaphoreProperties properties{};
        properties.sType = VK_STRUCTURE_TYPE_EXTERNAL_SEMAPHORE_PROPERTIES;
        GetPhysicalDeviceExternalSemaphoreProperties(physical, &info, &properties);
        if (!(properties.externalSemaphoreFeatures & VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT))
            throw DeviceError("Vulkan's device exports no semaphores as opaque descriptors");
    }

    void openDevice() {
        GetPhysicalDeviceMemoryProperties(physical, &memoryTypes);
        const float priority = 1.0f;
        VkDeviceQueueCreateInfo queue{};
        queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        queue.queueCount = 1;  // a device must have one; nothing is submitted to it
        queue.pQueuePriorities = &priority;
        VkDeviceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queue;
        info.enabledExtensionCount = std::uint32_t(std::size(kDeviceExtensions));
        info.ppEnabledExtensionNames = kDeviceExtensions;
        check(CreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
#define EARTHSHINE_VK_LOAD(NAME)                                                  \
    NAME = reinterpret_cast<PFN_vk##NAME>(GetDeviceProcAddr(device, "vk" #NAME)); \
    if (!NAME) throw DeviceError("this Vulkan has no vk" #NAME);
        EARTHSHINE_VK_DEVICE(EARTHSHINE_VK_LOAD)
#undef EARTHSHINE_VK_LOAD
    }

    void requireExportable(VkFormat format, PixelFormat name) const {
        VkPhysicalDeviceExternalImageFormatInfo external{};
        external.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_IMAGE_FORMAT_INFO;
        external.handleType = kMemoryHandle;
        VkPhysicalDeviceImageFormatInfo2 info{};
        info.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_FORMAT_INFO_2;
        info.pNext = &external;
        info.format = format;
        info.type = VK_IMAGE_TYPE_2D;
        info.tiling = VK_IMAGE_TILING_OPTIMAL;
        info.usage = kUsage;
        VkExternalImageFormatProperties exported{};
        exported.sType = VK_STRUCTURE_TYPE_EXTERNAL_IMAGE_FORMAT_PROPERTIES;
        VkImageFormatProperties2 properties{};
        properties.sType = VK_STRUCTURE_TYPE_IMAGE_FORMAT_PROPERTIES_2;
        properties.pNext = &exported;
        check(GetPhysicalDeviceImageFormatProperties2(physical, &info, &properties),
              "vkGetPhysicalDeviceImageFormatProperties2");
        if (!(exported.externalMemoryProperties.externalMemoryFeatures & VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT))
            throw DeviceError(fmt::format("Vulkan's device exports no {} images", formatName(name)));
    }

    std::uint32_t deviceMemoryType(std::uint32_t allowed) const {
        for (std::uint32_t i = 0; i < memoryTypes.memoryTypeCount; ++i)
            if ((allowed >> i & 1u) && (memoryTypes.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))
                return i;
        throw DeviceError("Vulkan has no memory of the device's own for an image");
    }

    Fd memoryFd(VkDeviceMemory memory) const {
        VkMemoryGetFdInfoKHR info{};
        info.sType = VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR;
        info.memory = memory;
        info.handleType = kMemoryHandle;
        int fd = -1;
        check(GetMemoryFdKHR(device, &info, &fd), "vkGetMemoryFdKHR");
        return Fd(fd);
    }
    Fd semaphoreFd(VkSemaphore semaphore) const {
        VkSemaphoreGetFdInfoKHR info{};
        info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR;
        info.semaphore = semaphore;
        info.handleType = kSemaphoreHandle;
        int fd = -1;
        check(GetSemaphoreFdKHR(device, &info, &fd), "vkGetSemaphoreFdKHR");
        return Fd(fd);
    }
};

VulkanExporter::VulkanExporter(const DeviceUuid& uuid) : impl_(std::make_unique<Impl>()) {
    impl_->open(uuid);
}
VulkanExporter::~VulkanExporter() = default;

VulkanExporter::Image VulkanExporter::makeImage(PixelFormat format, Extent extent) {
    Impl& vk = *impl_;
    vk.requireExportable(vulkanFormat(format), format);
    const std::uint64_t id = ++vk.lastId;
    Impl::Owned& owned = vk.images[id] = {};
    try {
        VkExternalMemoryImageCreateInfo external{};
        external.sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO;
        external.handleTypes = kMemoryHandle;
        VkImageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        info.pNext = &external;
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = vulkanFormat(format);
        info.extent = {std::uint32_t(extent.widthPx), std::uint32_t(extent.heightPx), 1};
        info.mipLevels = 1;
        info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.tiling = VK_IMAGE_TILING_OPTIMAL;
        info.usage = kUsage;
        info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
        info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        check(vk.CreateImage(vk.device, &info, nullptr, &owned.image), "vkCreateImage");

        VkMemoryRequirements needs{};
        vk.GetImageMemoryRequirements(vk.device, owned.image, &needs);
        VkMemoryDedicatedAllocateInfo dedicated{};
        dedicated.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO;
        dedicated.image = owned.image;
        VkExportMemoryAllocateInfo exported{};
        exported.sType = VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO;
        exported.pNext = &dedicated;
        exported.handleTypes = kMemoryHandle;
        VkMemoryAllocateInfo allocation{};
        allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocation.pNext = &exported;
        allocation.allocationSize = needs.size;
        allocation.memoryTypeIndex = vk.deviceMemoryType(needs.memoryTypeBits);
        check(vk.AllocateMemory(vk.device, &allocation, nullptr, &owned.memory), "vkAllocateMemory");
        check(vk.BindImageMemory(vk.device, owned.image, owned.memory, 0), "vkBindImageMemory");
        return {id, needs.size, vk.memoryFd(owned.memory), vk.memoryFd(owned.memory)};
    } catch (...) {
        free(id);
        throw;
    }
}

void VulkanExporter::free(std::uint64_t imageId) noexcept {
    const auto found = impl_->images.find(imageId);
    if (found == impl_->images.end()) return;
    impl_->release(found->second);
    impl_->images.erase(found);
}

VulkanExporter::Semaphore VulkanExporter::makeSemaphore() {
    Impl& vk = *impl_;
    VkExportSemaphoreCreateInfo exported{};
    exported.sType = VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO;
    exported.handleTypes = kSemaphoreHandle;
    VkSemaphoreCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    info.pNext = &exported;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    check(vk.CreateSemaphore(vk.device, &info, nullptr, &semaphore), "vkCreateSemaphore");
    vk.semaphores.push_back(semaphore);
    return {vk.semaphoreFd(semaphore), vk.semaphoreFd(semaphore)};
}

}  // namespace earthshine
