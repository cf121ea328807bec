#pragma once
// What stands in a file that the fake Vulkan exports: how the fake OpenGL and the OpenCL layer know the same thing.

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>

namespace test {

constexpr int kUuidByte = 0x5a;  ///< sixteen of these are the device's number, in all three

struct ExternalObject {
    std::uint32_t texture;      ///< memory: GL's texture in it; 0 = none yet
    std::uint32_t isSignalled;  ///< semaphore: for the other side to see
    std::uint32_t isPending;    ///< semaphore: signalled, but not flushed yet
};

/// Takes the descriptor over, as a driver does: it stays open until letGo(), and the object mapped until the process
/// ends.
struct Imported {
    ExternalObject* object = nullptr;
    int fd = -1;
    ino_t inode = 0;
};
inline Imported importObject(int fd) {
    struct stat status {};
    void* memory = ::mmap(nullptr, sizeof(ExternalObject), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (memory == MAP_FAILED || ::fstat(fd, &status) != 0) return {};
    return {static_cast<ExternalObject*>(memory), fd, status.st_ino};
}
/// False if someone else closed the descriptor in the meantime.
inline bool letGo(const Imported& imported) {
    struct stat status {};
    const bool isOurs = ::fstat(imported.fd, &status) == 0 && status.st_ino == imported.inode;
    return isOurs && ::close(imported.fd) == 0;
}

}  // namespace test
