#pragma once
// A copy of the kernel sources to be changed by a test: what DeviceOptions::kernelFolder takes.

#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "image/temp_folder.hpp"

namespace earthshine::test {

class KernelFolder {
public:
    KernelFolder() {
        std::filesystem::copy(EARTHSHINE_KERNEL_DIR, folder_.path(), std::filesystem::copy_options::recursive);
    }

    std::string path() const { return folder_.path().string(); }

    /// Adds a file of a test's own beside the kernels.
    void add(const std::filesystem::path& source) {
        std::filesystem::copy_file(source, folder_ / source.filename().string());
    }

    /// Puts `to` in place of `from`, which `file` ("rsm_sum.cl", "common/rsm.clh") must hold exactly once.
    void replace(const std::string& file, const std::string& from, const std::string& to) {
        std::string text = readText(folder_ / file);
        const auto at = text.find(from);
        ASSERT_NE(at, std::string::npos) << file << " no longer holds: " << from;
        ASSERT_EQ(text.find(from, at + 1), std::string::npos) << file << " holds more than once: " << from;
        writeText(folder_ / file, text.replace(at, from.size(), to));
    }

private:
    TempFolder folder_;
};

}  // namespace earthshine::test
