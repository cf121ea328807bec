#include "raster/scene/scene.hpp"

#include <limits>

namespace earthshine::raster {

namespace {

/// A box that grows around the points given to it.
struct Box {
    glm::vec3 min{std::numeric_limits<float>::max()};
    glm::vec3 max{std::numeric_limits<float>::lowest()};

    void add(const glm::vec3& point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    void store(glm::vec3& outMin, glm::vec3& outMax) const {
        const bool empty = min.x > max.x;
        outMin = empty ? glm::vec3(0.0f) : min;
        outMax = empty ? glm::vec3(0.0f) : max;
    }
};

}  // namespace

std::size_t Scene::triangleCount() const {
    std::size_t count = 0;
    for (const Instance& instance : instances) count += meshes[std::size_t(instance.mesh)].indices.size() / 3;
    return count;
}

void computeBounds(Scene& scene) {
    for (Mesh& mesh : scene.meshes) {
        Box box;
        for (const Vertex& vertex : mesh.vertices) box.add(vertex.position);
        box.store(mesh.boundsMin, mesh.boundsMax);
    }
    Box world;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 position((corner & 1) ? mesh.boundsMax.x : mesh.boundsMin.x,
                                     (corner & 2) ? mesh.boundsMax.y : mesh.boundsMin.y,
                                     (corner & 4) ? mesh.boundsMax.z : mesh.boundsMin.z);
            world.add(glm::vec3(instance.worldFromObject * glm::vec4(position, 1.0f)));
        }
    }
    world.store(scene.boundsMin, scene.boundsMax);
}

}  // namespace earthshine::raster
