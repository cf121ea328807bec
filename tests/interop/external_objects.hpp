#pragma once
// What stands in a file that the fake Vulkan exports: how the fake OpenGL and the OpenCL layer know the same thing.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace test {

constexpr int kUuidByte = 0x5a;  ///< sixteen of these are the device's number, in all three

struct ExternalObject {
    std::uint32_t texture;      ///< memory: GL's texture in it; 0 = none yet
    std::uint32_t isSignalled;  ///< semaphore: for the other side to see
    std::uint32_t isPending;    ///< semaphore: signalled, but not flushed yet
};

/// Takes the descriptor over, as a driver does; the object stays mapped until the process ends.
inline ExternalObject* importObject(int fd) {
    void* memory = ::mmap(nullptr, sizeof(ExternalObject), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (memory == MAP_FAILED) return nullptr;
    ::close(fd);
    return static_cast<ExternalObject*>(memory);
}

}  // namespace test
