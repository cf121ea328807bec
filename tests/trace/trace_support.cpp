#include "trace/trace_support.hpp"

#include <numbers>

#include "raster/scene/gltf_loader.hpp"

namespace earthshine::trace::test {

using raster::Mesh;
using raster::Scene;
using raster::Vertex;

Scene dataScene(const std::string& file) {
    return raster::loadGltf(std::filesystem::path(EARTHSHINE_DATA_DIR) / file);
}

Furnace furnace(float albedo, double radiusM, const glm::dvec3& centre, Extent extent, int segments) {
    Mesh mesh;
    const int rings = segments / 2;
    for (int ring = 0; ring <= rings; ++ring)
        for (int i = 0; i <= segments; ++i) {
            const double polar = std::numbers::pi * ring / rings, around = 2.0 * std::numbers::pi * i / segments;
            const glm::dvec3 direction(std::sin(polar) * std::cos(around), std::cos(polar),
                                       std::sin(polar) * std::sin(around));
            Vertex vertex;
            vertex.position = glm::vec3(radiusM * direction);
            vertex.normal = glm::vec3(-direction);
            mesh.vertices.push_back(vertex);
        }
    for (int ring = 0; ring < rings; ++ring)
        for (int i = 0; i < segments; ++i) {
            const auto a = std::uint32_t(ring * (segments + 1) + i), b = a + std::uint32_t(segments) + 1;
            // Counter-clockwise from inside; the caps' triangles without area are left out.
            if (ring > 0) mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
            if (ring + 1 < rings) mesh.indices.insert(mesh.indices.end(), {a + 1, b, b + 1});
        }
    // Which of the two windings faces inwards is asked of the first triangle, not of the reader.
    const glm::vec3 p = mesh.vertices[mesh.indices[0]].position;
    const glm::vec3 normal =
        glm::cross(mesh.vertices[mesh.indices[1]].position - p, mesh.vertices[mesh.indices[2]].position - p);
    if (glm::dot(normal, p) > 0.0f)
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);

    Furnace result;
    result.scene.name = "furnace";
    result.scene.materials = {diffuse(glm::vec3(albedo))};
    result.scene.meshes = {std::move(mesh)};
    result.scene.instances = {{0, glm::translate(glm::mat4(1), glm::vec3(centre))}};
    raster::computeBounds(result.scene);

    constexpr double kInner = 30.0, kOuter = 50.0, kCandela = 100.0;
    const double inner = glm::radians(kInner), outer = glm::radians(kOuter);
    result.lights = {spotLight(glm::vec3(float(kCandela)), centre, centre - glm::dvec3(0, radiusM, 0), float(inner),
                               float(outer), 2.0 * radiusM)};
    result.camera = lookAtCamera(centre + radiusM * glm::dvec3(-0.3, 0.2, -0.1),
                                 centre + radiusM * glm::dvec3(0.6, -0.5, 0.4), extent);
    result.camera.clipFromView =
        glm::mat4(glm::perspective(1.9, double(extent.widthPx) / extent.heightPx, 1e-3 * radiusM, 10.0 * radiusM));
    // The falloff is a square in the cosine between the two angles: a third of their difference.
    const double solidAngle =
        2.0 * std::numbers::pi * ((1.0 - std::cos(inner)) + (std::cos(inner) - std::cos(outer)) / 3.0);
    result.firstBounceLux = double(albedo) * kCandela * solidAngle / (4.0 * std::numbers::pi * radiusM * radiusM);
    return result;
}

double meanOf(const HostImage& image) {
    double sum = 0.0, count = 0.0;
    const auto [width, height] = image.extent();
    for (int i = 0; i < width * height; ++i) {
        const float* p = image.pixel(0, 0) + 4 * i;
        if (p[3] == 0.0f) continue;
        sum += (double(p[0]) + double(p[1]) + double(p[2])) / 3.0;
        count += 1.0;
    }
    return sum / count;
}

glm::dvec2 rangeOf(const HostImage& image) {
    glm::dvec2 range(1e300, -1e300);
    const auto [width, height] = image.extent();
    for (int i = 0; i < width * height; ++i) {
        const float* p = image.pixel(0, 0) + 4 * i;
        if (p[3] == 0.0f) continue;
        range = {std::min(range.x, double(p[0])), std::max(range.y, double(p[0]))};
    }
    return range;
}

PathTracer traced(const Scene& scene, const Camera& camera, const std::vector<Light>& lights,
                  const TraceSettings& settings, int samples) {
    PathTracer tracer(scene, camera, lights, settings);
    tracer.addSamples(samples);
    return tracer;
}

}  // namespace earthshine::trace::test
