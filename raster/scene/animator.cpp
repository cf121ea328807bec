#include "raster/scene/animator.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "earthshine/error.hpp"
#include "raster/scene/node_transform.hpp"

namespace earthshine::raster {

namespace {

std::vector<const Animation*> find(const Scene& scene, std::string_view which) {
    if (scene.animations.empty())
        throw UsageError(fmt::format("{}: the file has no animation that could be played", scene.name));
    std::vector<const Animation*> found;
    for (const Animation& animation : scene.animations) {
        if (animation.name == which && !which.empty()) return {&animation};
        found.push_back(&animation);
    }
    if (which.empty()) return found;
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), index);
    if (error == std::errc() && end == which.data() + which.size() && index < scene.animations.size())
        return {&scene.animations[index]};
    std::string names;
    for (std::size_t i = 0; i < scene.animations.size(); ++i)
        names += fmt::format("{}{} \"{}\"", i ? ", " : "", i, scene.animations[i].name);
    throw UsageError(fmt::format("{}: there is no animation \"{}\"; there is {}", scene.name, which, names));
}

/// Makes a box that holds the corners of the mesh's own box in all of the places that it is given.
void add(WorldBox& box, const Mesh& mesh, const glm::mat4& worldFromObject) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 position((corner & 1) ? mesh.boundsMax.x : mesh.boundsMin.x,
                                 (corner & 2) ? mesh.boundsMax.y : mesh.boundsMin.y,
                                 (corner & 4) ? mesh.boundsMax.z : mesh.boundsMin.z);
        const glm::vec3 positionWs(worldFromObject * glm::vec4(position, 1.0f));
        box.min = glm::min(box.min, positionWs);
        box.max = glm::max(box.max, positionWs);
    }
}

}  // namespace

Animator::Animator(const Scene& scene, std::string_view which)
    : played_(find(scene, which)), movedNodes_(scene.nodes.size(), false) {
    for (const Animation* animation : played_) {
        lastKeyS_ = std::max(lastKeyS_, raster::lastKeyS(*animation));
        for (const AnimationChannel& channel : animation->channels) movedNodes_[std::size_t(channel.node)] = true;
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (const int parent = scene.nodes[i].parent; parent >= 0 && movedNodes_[std::size_t(parent)])
            movedNodes_[i] = true;
    }
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (const int node = scene.instances[i].node; node >= 0 && movedNodes_[std::size_t(node)])
            movedInstances_.push_back(int(i));
    }
}

void Animator::pose(Scene& scene, double timeS) const {
    std::vector<SceneNode> nodes = scene.nodes;
    for (const Animation* animation : played_) {
        for (const AnimationChannel& channel : animation->channels) {
            SceneNode& node = nodes[std::size_t(channel.node)];
            const glm::dvec4 value = valueAt(channel, timeS);
            switch (channel.part) {
                case AnimatedPart::Translation:
                    node.translation = glm::dvec3(value);
                    break;
                case AnimatedPart::Rotation:
                    node.rotation = glm::dquat(value.w, value.x, value.y, value.z);
                    break;
                case AnimatedPart::Scale:
                    node.scale = glm::dvec3(value);
                    break;
            }
        }
    }
    std::vector<glm::dmat4> worldFromNode(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const int parent = nodes[i].parent;
        worldFromNode[i] =
            (parent < 0 ? glm::dmat4(1.0) : worldFromNode[std::size_t(parent)]) * parentFromNode(nodes[i]);
        if (movedNodes_[i] && !isFinite(glm::mat4(worldFromNode[i])))
            throw InputError(fmt::format("{}: at {:.3f} s its animation moves something beyond what 32-bit floats hold",
                                         scene.name, timeS));
    }
    for (const int instance : movedInstances_) {
        Instance& moved = scene.instances[std::size_t(instance)];
        moved.worldFromObject = glm::mat4(worldFromNode[std::size_t(moved.node)]);
    }
    for (SceneCamera& camera : scene.cameras)
        if (moves(camera.node))
            camera.worldFromView = rigid(worldFromNode[std::size_t(camera.node)]).value_or(camera.worldFromView);
    for (SceneLight& light : scene.lights)
        if (moves(light.node))
            light.worldFromLight = rigid(worldFromNode[std::size_t(light.node)]).value_or(light.worldFromLight);
}

std::vector<WorldBox> Animator::sweptBounds(Scene& scene, double framesPerSecond) const {
    constexpr double kMostSteps = 4096.0;
    const double wanted = std::ceil(lastKeyS_ * framesPerSecond);
    const double steps = std::min(wanted, kMostSteps);
    const double stepS = wanted <= kMostSteps ? 1.0 / framesPerSecond : lastKeyS_ / kMostSteps;
    constexpr float kFar = std::numeric_limits<float>::max();
    std::vector<WorldBox> boxes(movedInstances_.size(), WorldBox{glm::vec3(kFar), glm::vec3(-kFar)});
    for (int step = 0; step <= int(steps); ++step) {
        pose(scene, step * stepS);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Instance& instance = scene.instances[std::size_t(movedInstances_[i])];
            add(boxes[i], scene.meshes[std::size_t(instance.mesh)], instance.worldFromObject);
        }
    }
    for (WorldBox& box : boxes) {
        const glm::vec3 slack = 1e-6f * glm::max(glm::abs(box.min), glm::abs(box.max));
        box.min -= slack;
        box.max += slack;
    }
    return boxes;
}

}  // namespace earthshine::raster
