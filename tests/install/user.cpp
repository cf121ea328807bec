// What the README shows a renderer's author: plain images in, irradiance out. Here a floor under the sun, and a wall.

#include <earthshine/error.hpp>
#include <earthshine/pipeline.hpp>

#include <cstdio>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

namespace {

using namespace earthshine;

// A picture of one value everywhere.
HostImage filled(PixelFormat format, Extent extent, glm::vec4 value) {
    HostImage image(format == PixelFormat::R32F ? format : PixelFormat::RGBA32F, extent);
    const int channels = channelCount(image.format());
    for (int i = 0; i < extent.widthPx * extent.heightPx; ++i)
        for (int c = 0; c < channels; ++c) image.pixel(0, 0)[i * channels + c] = value[c];
    return format == PixelFormat::RGBA16F ? toHalf(image.view()) : std::move(image);
}

}  // namespace

int main() try {
    constexpr Extent kExtent{8, 8}, kMap{32, 32};
    const glm::vec3 up(0.0f, 1.0f, 0.0f);

    // The camera looks at a wall 2 m before it; the sun shines straight down on a floor 1 m below.
    Camera camera{glm::lookAt(glm::vec3(0.0f), glm::vec3(0.0f, 0.0f, -1.0f), up),
                  glm::perspective(1.0f, 1.0f, 0.1f, 10.0f)};
    Light sun;
    sun.intensity = glm::vec3(1000.0f);
    sun.camera = {glm::lookAt(glm::vec3(0.0f, 5.0f, 0.0f), glm::vec3(0.0f), glm::vec3(0.0f, 0.0f, -1.0f)),
                  glm::ortho(-2.0f, 2.0f, -2.0f, 2.0f, 0.1f, 10.0f)};
    const float albedo = 0.5f, flux = albedo * sun.intensity.x * texelPowerOnAxis(sun, kMap);

    FrameImages frame;
    frame.camera = camera;
    frame.albedo = filled(PixelFormat::RGBA16F, kExtent, glm::vec4(albedo));
    frame.normalWs = filled(PixelFormat::RGBA16F, kExtent, {0.0f, 0.0f, 1.0f, 1.0f});
    frame.depth = filled(PixelFormat::R32F, kExtent, glm::vec4(2.0f));
    frame.lights = {sun};
    frame.rsmDepth = filled(PixelFormat::R32F, kMap, glm::vec4(6.0f));
    frame.rsmNormalWs = filled(PixelFormat::RGBA16F, kMap, {0.0f, 1.0f, 0.0f, 1.0f});
    frame.rsmFlux = filled(PixelFormat::RGBA32F, kMap, glm::vec4(flux));
    frame.shadowDepth = filled(PixelFormat::R32F, kMap, glm::vec4(0.0f));

    Settings settings;
    settings.estimator = Estimator::Sum;
    Pipeline pipeline{Device(selectDevice(""))};
    pipeline.setFrame(frame.inputs());
    pipeline.run(settings);
    const HostImage irradiance = pipeline.read(Output::IndirectIrradiance);
    const float lux = irradiance.pixel(4, 4)[0];
    std::printf("irradiance at the middle of the wall: %.2f lx\n", double(lux));
    // The floor below reflects 500 lm/m^2 and fills less than half of the wall's view of it.
    return lux > 20.0f && lux < 250.0f ? 0 : 1;
} catch (const earthshine::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
