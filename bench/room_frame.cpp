#include "room_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace earthshine::bench {

namespace {

struct Box {
    glm::vec3 low, high, albedo;
};

// Walls and floor of the room from thin boxes, so that the sun comes in over the missing ceiling; and furniture.
constexpr std::array kBoxes{
    Box{{-4.0f, -0.1f, -3.0f}, {4.0f, 0.0f, 3.0f}, {0.6f, 0.55f, 0.5f}},
    Box{{-4.1f, 0.0f, -3.0f}, {-4.0f, 4.0f, 3.0f}, {0.6f, 0.1f, 0.1f}},
    Box{{4.0f, 0.0f, -3.0f}, {4.1f, 4.0f, 3.0f}, {0.1f, 0.5f, 0.15f}},
    Box{{-4.0f, 0.0f, -3.1f}, {4.0f, 4.0f, -3.0f}, {0.7f, 0.7f, 0.7f}},
    Box{{-2.5f, 0.0f, -1.5f}, {-1.2f, 2.2f, -0.4f}, {0.7f, 0.6f, 0.3f}},
    Box{{0.8f, 0.0f, -0.9f}, {2.0f, 1.1f, 0.6f}, {0.3f, 0.4f, 0.7f}},
    Box{{-0.4f, 0.0f, 0.6f}, {0.2f, 0.6f, 1.4f}, {0.8f, 0.8f, 0.8f}},
};

struct Hit {
    float distance = std::numeric_limits<float>::infinity();
    glm::vec3 normal{0.0f}, albedo{0.0f};
};

Hit trace(glm::vec3 origin, glm::vec3 direction) {
    Hit nearest;
    for (const Box& box : kBoxes) {
        const glm::vec3 a = (box.low - origin) / direction, b = (box.high - origin) / direction;
        const glm::vec3 low = glm::min(a, b), high = glm::max(a, b);
        const float enter = std::max({low.x, low.y, low.z}), leave = std::min({high.x, high.y, high.z});
        if (enter > leave || enter <= 1e-4f || enter >= nearest.distance) continue;
        glm::vec3 normal(0.0f);
        const int axis = low.x == enter ? 0 : low.y == enter ? 1 : 2;
        normal[axis] = direction[axis] > 0.0f ? -1.0f : 1.0f;
        nearest = {enter, normal, box.albedo};
    }
    return nearest;
}

struct Maps {
    HostImage depth, normal, color;
};

// What a camera sees; color is the albedo, times `scale`.
Maps cast(const Camera& camera, Extent extent, float scale) {
    Maps maps{HostImage(PixelFormat::R32F, extent), HostImage(PixelFormat::RGBA32F, extent),
              HostImage(PixelFormat::RGBA32F, extent)};
    const glm::mat4 worldFromClip = glm::inverse(camera.clipFromView * camera.viewFromWorld);
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            const float ndcX = (float(x) + 0.5f) / float(extent.widthPx) * 2.0f - 1.0f;
            const float ndcY = 1.0f - (float(y) + 0.5f) / float(extent.heightPx) * 2.0f;
            glm::vec4 a = worldFromClip * glm::vec4(ndcX, ndcY, -1.0f, 1.0f),
                      b = worldFromClip * glm::vec4(ndcX, ndcY, 1.0f, 1.0f);
            const glm::vec3 origin = glm::vec3(a) / a.w;
            const glm::vec3 direction = glm::normalize(glm::vec3(b) / b.w - origin);
            const Hit hit = trace(origin, direction);
            if (hit.distance > 1e6f) continue;
            const glm::vec3 position = origin + hit.distance * direction;
            *maps.depth.pixel(x, y) = -(camera.viewFromWorld * glm::vec4(position, 1.0f)).z;
            for (int c = 0; c < 3; ++c) {
                maps.normal.pixel(x, y)[c] = hit.normal[c];
                maps.color.pixel(x, y)[c] = hit.albedo[c] * scale;
            }
            maps.normal.pixel(x, y)[3] = maps.color.pixel(x, y)[3] = 1.0f;
        }
    }
    return maps;
}

}  // namespace

FrameImages makeRoomFrame(Extent extent, int rsmSizePx) {
    FrameImages frame;
    const float aspect = float(extent.widthPx) / float(extent.heightPx);
    frame.camera = {glm::lookAt(glm::vec3(0.5f, 1.8f, 6.0f), glm::vec3(0.0f, 1.4f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)),
                    glm::perspective(0.8f, aspect, 0.1f, 50.0f)};
    Maps view = cast(frame.camera, extent, 1.0f);
    frame.albedo = toHalf(view.color.view());
    frame.normalWs = toHalf(view.normal.view());
    frame.depth = std::move(view.depth);

    Light sun;
    sun.name = "sun";
    sun.intensity = glm::vec3(50000.0f);
    sun.camera = {glm::lookAt(glm::vec3(6.0f, 9.0f, 5.0f), glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)),
                  glm::ortho(-6.0f, 6.0f, -5.0f, 5.0f, 0.1f, 30.0f)};
    const Extent rsm{rsmSizePx, rsmSizePx};
    Maps light = cast(sun.camera, rsm, texelPowerOnAxis(sun, rsm) * sun.intensity.x);
    frame.rsmDepth = std::move(light.depth);
    frame.rsmNormalWs = toHalf(light.normal.view());
    frame.rsmFlux = std::move(light.color);
    frame.shadowDepth = cast(sun.camera, {2 * rsmSizePx, 2 * rsmSizePx}, 1.0f).depth;
    frame.lights = {sun};
    return frame;
}

const FrameImages& roomFrame(Extent extent, int rsmSizePx) {
    static std::map<std::array<int, 3>, FrameImages> frames;
    const std::array<int, 3> key{extent.widthPx, extent.heightPx, rsmSizePx};
    auto frame = frames.find(key);
    if (frame == frames.end()) frame = frames.emplace(key, makeRoomFrame(extent, rsmSizePx)).first;
    return frame->second;
}

}  // namespace earthshine::bench
