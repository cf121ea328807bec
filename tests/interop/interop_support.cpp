#include "interop/interop_support.hpp"

namespace earthshine::test {

using namespace raster;

Scene boxScene() {
    Scene scene;
    scene.meshes = {raster::test::unitBox(0, true), raster::test::unitBox(1)};
    scene.materials = {raster::test::diffuse({0.7f, 0.6f, 0.5f}), raster::test::diffuse({0.2f, 0.4f, 0.8f})};
    scene.materials[1].emission = glm::vec3(0.25f, 0.0f, 0.5f);
    scene.instances = {
        {0, glm::scale(glm::mat4(1), glm::vec3(3, 2, 3))},
        {1, glm::translate(glm::mat4(1), glm::vec3(0.4f, -1.2f, -0.5f)) * glm::scale(glm::mat4(1), glm::vec3(0.7f))}};
    scene.boundsMin = {-3, -2, -3};
    scene.boundsMax = {3, 2, 3};
    return scene;
}

std::vector<Light> boxLights() {
    return {raster::test::directionalLight({900, 800, 700},
                                           raster::test::orthographicCamera({1, 1.9, 1}, {0, -2, 0}, 2, 6)),
            raster::test::spotLight({50, 60, 80}, {-2, 1.5, 2}, {1, -2, -1}, 0.4f, 0.7f, 9)};
}

BoxRun::BoxRun(GlContext& context, const DeviceCaps& caps, const DeviceOptions& options, const std::string& transport,
               const GlContextHandle& handle)
    : opened([&] {
          context.makeCurrent();
          return openForGl(caps, options, handle, transport);
      }()),
      context_(&context),
      renderer_(
          [&]() -> GlContext& {
              context.setTextureStorage(&opened.transport);
              return context;
          }(),
          boxScene()),
      pipeline_(opened.device) {}

GlFrame BoxRun::draw(const Camera& camera, Extent extent) {
    return renderer_.render(camera, std::exchange(previous_, camera), boxLights(),
                            {extent, rsmSizePx, shadowSizePx, glm::vec3(0.5f, 1.0f, 2.0f)});
}

void BoxRun::compute(Extent extent, int index) {
    const Camera camera = raster::test::lookAtCamera({-2.0 + 0.05 * index, 0.5, 2.5}, {0.3, -0.8, -0.5}, extent, 1.1);
    if (index == 0) previous_ = camera;
    const GlFrame drawn = draw(camera, extent);
    Settings settings;
    settings.sampleCount = 8;
    settings.accumulates = true;
    settings.filterIterations = filterIterations;
    pipeline_.setFrame(opened.transport, drawn, camera, boxLights());
    pipeline_.run(settings);
}

double BoxRun::stageMs(const std::string& stage) const {
    double sum = 0.0;
    for (const StageTime& time : pipeline_.stageTimes())
        if (stage.empty() || time.stage == stage) sum += time.ms;
    return sum;
}

std::vector<std::byte> BoxRun::frame(Extent extent, int index) {
    compute(extent, index);
    std::vector<std::byte> bytes;
    for (const Output output : {Output::DirectIrradiance, Output::IndirectIrradiance, Output::Color, Output::Display}) {
        const HostImage image = pipeline_.read(output);
        bytes.insert(bytes.end(), image.data(), image.data() + image.sizeBytes());
    }
    return bytes;
}

void expectSame(const std::vector<std::byte>& is, const std::vector<std::byte>& should) {
    ASSERT_EQ(is.size(), should.size());
    std::size_t different = 0, first = 0;
    for (std::size_t i = is.size(); i-- > 0;) {
        if (is[i] == should[i]) continue;
        ++different;
        first = i;
    }
    EXPECT_EQ(different, 0u) << "bytes of " << is.size() << ", the first at " << first;
}

LogCapture::LogCapture(LogLevel wanted) {
    setLogSink([this, wanted](LogLevel level, std::string_view line) {
        if (level == wanted) lines.emplace_back(line);
    });
}
LogCapture::~LogCapture() {
    setLogSink({});
}

}  // namespace earthshine::test
