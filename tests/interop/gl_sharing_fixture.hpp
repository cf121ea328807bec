#pragma once
// A GL context beside the layer that gives the devices here cl_khr_gl_sharing (gl_sharing_layer.cpp), and what it
// wrote.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "image/temp_folder.hpp"
#include "interop/interop_support.hpp"
#include "reference/device_variants.hpp"

namespace earthshine {

// Before anything asks OpenCL for its platforms: the loader looks once.
inline const bool kHasLayer = ::setenv("OPENCL_LAYERS", EARTHSHINE_GL_SHARING_LAYER, 1) == 0;

/// What the layer wrote.
inline std::vector<std::string> linesOf(const std::filesystem::path& path) {
    std::istringstream stream(test::readText(path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}
inline std::ptrdiff_t countOf(const std::vector<std::string>& lines, const std::string& start) {
    return std::count_if(lines.begin(), lines.end(), [&](const std::string& line) { return line.starts_with(start); });
}
inline std::vector<std::string> violationsOf(const std::vector<std::string>& lines) {
    std::vector<std::string> some;
    for (const std::string& line : lines)
        if (line.starts_with("violation")) some.push_back(line);
    return some;
}

class GlSharing : public ::testing::Test {
protected:
    GlSharing() {
        EXPECT_TRUE(kHasLayer);
        set("LOG", (folder / "layer.log").string());
        for (const char* name : {"EVENTS", "FAIL", "DEVICE"}) set(name, "");
        context = raster::createContext(raster::test::testedKind());
    }
    ~GlSharing() override {
        context.reset();
        set("LOG", "");
    }
    static void set(const std::string& name, const std::string& value) {
        ::setenv(("EARTHSHINE_LAYER_" + name).c_str(), value.c_str(), 1);
    }
    std::vector<std::string> layerLines() const { return linesOf(folder / "layer.log"); }

    static DeviceCaps device() { return reference::defaultVariants().at(0).caps; }

    test::TempFolder folder;
    std::unique_ptr<raster::GlContext> context;
};

}  // namespace earthshine
