#include "raster/scene/gltf_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "raster/scene/editor_markers.hpp"
#include "raster/scene/node_transform.hpp"

namespace earthshine::raster {

namespace {

SceneNode nodeOf(const tinygltf::Node& from, int parent) {
    SceneNode to;
    to.parent = parent;
    if (!from.matrix.empty()) {
        to.matrix.emplace();
        for (std::size_t i = 0; i < 16; ++i) (*to.matrix)[int(i / 4)][int(i % 4)] = from.matrix[i];
    }
    if (!from.rotation.empty())
        to.rotation = glm::dquat(from.rotation[3], from.rotation[0], from.rotation[1], from.rotation[2]);
    for (int axis = 0; axis < 3; ++axis) {
        if (!from.scale.empty()) to.scale[axis] = from.scale[std::size_t(axis)];
        if (!from.translation.empty()) to.translation[axis] = from.translation[std::size_t(axis)];
    }
    return to;
}

/// Whether the matrix keeps volumes: otherwise normals have no transform. Relative to its columns, so that no scene is
/// too small.
bool isInvertible(const glm::dmat4& matrix) {
    const glm::dmat3 linear(matrix);
    const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    constexpr double kFlat = 1e-9;
    return lengths > 1e-30 && std::abs(glm::determinant(linear)) > kFlat * lengths;
}

SceneCamera cameraOf(const tinygltf::Camera& from) {
    SceneCamera to;
    to.name = from.name;
    to.perspective = from.type == "perspective";
    if (to.perspective) {
        to.verticalFov = float(from.perspective.yfov);
        to.aspect = float(from.perspective.aspectRatio);
        to.nearM = float(from.perspective.znear);
        to.farM = float(from.perspective.zfar);
    } else {
        to.halfHeightM = float(std::abs(from.orthographic.ymag));
        to.aspect = float(std::abs(from.orthographic.xmag / from.orthographic.ymag));
        to.nearM = float(from.orthographic.znear);
        to.farM = float(from.orthographic.zfar);
    }
    return to;
}

SceneLight lightOf(const tinygltf::Light& from) {
    SceneLight to;
    to.name = from.name;
    to.type = from.type == "point"  ? SceneLightType::Point
              : from.type == "spot" ? SceneLightType::Spot
                                    : SceneLightType::Directional;
    for (int i = 0; i < 3; ++i) {
        to.intensity[i] = float((from.color.empty() ? 1.0 : from.color[std::size_t(i)]) * from.intensity);
    }
    to.outerConeAngle = float(from.spot.outerConeAngle);
    to.innerConeAngle = std::min(float(from.spot.innerConeAngle), to.outerConeAngle);
    to.rangeM = float(from.range);
    return to;
}

class Placer {
public:
    Placer(const GltfContext& context, GltfMeshes& meshes)
        : context_(context), meshes_(meshes), sceneNodes_(context.model.nodes.size(), -1) {}

    void placeTree(int root) {
        struct Pending {
            int node;
            int parent;  // into Scene::nodes
            glm::dmat4 worldFromParent;
        };
        std::vector<Pending> pending = {{root, -1, glm::dmat4(1.0)}};  // a list, not recursion: any depth is fine
        while (!pending.empty()) {
            const Pending next = pending.back();
            pending.pop_back();
            const tinygltf::Node& node = context_.model.nodes[std::size_t(next.node)];
            const SceneNode placed = nodeOf(node, next.parent);
            const glm::dmat4 worldFromNode = next.worldFromParent * parentFromNode(placed);
            const int index = int(context_.scene.nodes.size());
            sceneNodes_[std::size_t(next.node)] = index;
            context_.scene.nodes.push_back(placed);
            placeNode(node, worldFromNode, index, fmt::format("nodes[{}]", next.node));
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                pending.push_back({*child, index, worldFromNode});
            }
        }
    }

    const std::vector<int>& sceneNodes() const { return sceneNodes_; }

private:
    void placeNode(const tinygltf::Node& node, const glm::dmat4& worldFromNode, int index, const std::string& place) {
        const glm::mat4 world(worldFromNode);
        if (!isFinite(world)) context_.file.fail(place, "its world transform is beyond what 32-bit floats hold");
        if (node.mesh >= 0) placeMesh(node, worldFromNode, index, place);
        const auto light = node.extensions.find("KHR_lights_punctual");
        const bool hasLight = light != node.extensions.end() && light->second.Has("light");
        if (node.camera < 0 && !hasLight) return;
        const std::optional<glm::mat4> worldFromThis = rigid(worldFromNode);
        if (!worldFromThis) {
            context_.note(place + ": its scale leaves its camera or light no direction, and it is left out");
            return;
        }
        if (node.camera >= 0) {
            SceneCamera camera = cameraOf(context_.model.cameras[std::size_t(node.camera)]);
            if (camera.name.empty()) camera.name = node.name;
            camera.worldFromView = *worldFromThis;
            camera.node = index;
            context_.scene.cameras.push_back(std::move(camera));
        }
        if (hasLight) {
            const int source = light->second.Get("light").GetNumberAsInt();
            SceneLight placed = lightOf(context_.model.lights[std::size_t(source)]);
            for (int i = 0; i < 3; ++i) {
                if (!std::isfinite(placed.intensity[i])) {
                    context_.file.fail(fmt::format("extensions.KHR_lights_punctual.lights[{}]", source),
                                       "its intensity is beyond what a 32-bit float holds");
                }
            }
            if (placed.name.empty()) placed.name = node.name;
            placed.worldFromLight = *worldFromThis;
            placed.node = index;
            context_.scene.lights.push_back(std::move(placed));
        }
    }

    void placeMesh(const tinygltf::Node& node, const glm::dmat4& worldFromNode, int index, const std::string& place) {
        if (!isInvertible(worldFromNode)) {
            context_.note(place + ": its scale leaves no volume, and its mesh is not drawn");
            return;
        }
        if (const char* engine = markerEngine(node.name); engine && !context_.drawsMarkers) {
            context_.note(fmt::format("nodes named like markers of {} are not drawn", engine));
            return;
        }
        if (node.skin >= 0) context_.note(place + ": its skin is drawn in the bind pose");
        const std::vector<int>& parts = meshes_.meshesOf(node.mesh, node.weights);
        if (context_.scene.instances.size() + parts.size() > gltf_limits::kInstances) {
            context_.file.fail(place, fmt::format("the scene has more than {} instances", gltf_limits::kInstances));
        }
        for (const int mesh : parts) {
            context_.scene.instances.push_back({mesh, glm::mat4(worldFromNode), index});
        }
    }

    const GltfContext& context_;
    GltfMeshes& meshes_;
    std::vector<int> sceneNodes_;
};

}  // namespace

std::vector<int> placeNodes(const GltfContext& context, GltfMeshes& meshes) {
    const tinygltf::Model& model = context.model;
    std::vector<int> roots;
    if (!model.scenes.empty()) {
        const int scene = std::max(model.defaultScene, 0);
        roots = model.scenes[std::size_t(scene)].nodes;
        context.scene.name = model.scenes[std::size_t(scene)].name;
        if (model.scenes.size() > 1)
            context.note(fmt::format("scenes[{}] is drawn, of {} scenes", scene, model.scenes.size()));
    } else {
        std::vector<bool> isChild(model.nodes.size(), false);
        for (const tinygltf::Node& node : model.nodes) {
            for (const int child : node.children) isChild[std::size_t(child)] = true;
        }
        for (std::size_t i = 0; i < isChild.size(); ++i) {
            if (!isChild[i]) roots.push_back(int(i));
        }
    }
    Placer placer(context, meshes);
    for (const int root : roots) placer.placeTree(root);
    return placer.sceneNodes();
}

}  // namespace earthshine::raster
