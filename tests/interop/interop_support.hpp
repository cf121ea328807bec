#pragma once
// A small scene drawn by OpenGL, brought to OpenCL by any transport, and everything that comes of it.

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "earthshine/error.hpp"
#include "earthshine/log.hpp"
#include "earthshine/pipeline.hpp"
#include "raster/raster_support.hpp"
#include "raster/scene_renderer.hpp"

namespace earthshine::test {

/// An open box with a block in it, all of one texel colour a wall.
raster::Scene boxScene();
/// A sun and a spot, each with maps.
std::vector<Light> boxLights();

/// Draws and computes frames of boxScene(). The context outlives it.
class BoxRun {
public:
    BoxRun(raster::GlContext& context, const DeviceCaps& caps, const DeviceOptions& options,
           const std::string& transport, const GlContextHandle& handle);
    BoxRun(raster::GlContext& context, const DeviceCaps& caps, const DeviceOptions& options,
           const std::string& transport)
        : BoxRun(context, caps, options, transport, context.handle()) {}

    ~BoxRun() { context_->setTextureStorage(nullptr); }
    BoxRun(const BoxRun&) = delete;
    BoxRun& operator=(const BoxRun&) = delete;

    /// Draws a frame from a camera that stands elsewhere in every frame, and returns the pixels of every output.
    std::vector<std::byte> frame(Extent extent, int index);

    /// The same, and leaves the outputs on the device.
    void compute(Extent extent, int index);

    /// Draws and computes nothing.
    GlFrame draw(const Camera& camera, Extent extent);

    /// Milliseconds of a stage of the last frame, or of all of them for ""; 0 unless the device was opened to profile.
    double stageMs(const std::string& stage) const;

    GlDevice opened;
    int rsmSizePx = 48, shadowSizePx = 80;
    int filterIterations = 2;

private:
    raster::GlContext* context_;
    raster::SceneRenderer renderer_;
    Pipeline pipeline_;
    Camera previous_;
};

/// Two pictures' bytes are the same; says where they part.
void expectSame(const std::vector<std::byte>& is, const std::vector<std::byte>& should);

/// Collects what the library logs at a level, while it lives.
class LogCapture {
public:
    explicit LogCapture(LogLevel level);
    ~LogCapture();
    LogCapture(const LogCapture&) = delete;
    LogCapture& operator=(const LogCapture&) = delete;
    std::vector<std::string> lines;
};

/// What `call` throws as a DeviceError; fails the test if it throws nothing.
template <class Call>
std::string deviceErrorOf(Call&& call) {
    try {
        call();
    } catch (const DeviceError& error) {
        return error.what();
    }
    ADD_FAILURE() << "threw nothing";
    return "";
}

}  // namespace earthshine::test
