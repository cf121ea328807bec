#include "truth/truth_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "raster/gl/gl_context.hpp"

namespace earthshine::truth {

namespace {

constexpr double kReachM = 20.0;  // of a beam, and how far before its rectangle it starts, twice that

glm::dmat4 lookAlong(const glm::dvec3& eye, const glm::dvec3& forward) {
    const glm::dvec3 up = std::fabs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    return glm::lookAt(eye, eye + forward, up);
}

// The frame in which the rectangle's sides are x and y.
glm::dmat4 lookSquarelyAt(const Rectangle& r, double distance) {
    return glm::lookAt(r.centre() + distance * r.normal(), r.centre(), glm::normalize(r.sideV));
}

int addMaterial(raster::Scene& scene, double albedo, bool isDoubleSided) {
    raster::Material material;
    material.baseColor = glm::vec4(float(albedo), float(albedo), float(albedo), 1.0f);
    material.metallic = 0.0f;
    material.doubleSided = isDoubleSided;
    scene.materials.push_back(material);
    return int(scene.materials.size()) - 1;
}

void addMesh(raster::Scene& scene, raster::Mesh mesh) {
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({int(scene.meshes.size()) - 1, glm::mat4(1.0f)});
    raster::computeBounds(scene);
}

raster::GlContext& sharedContext() {
    static const std::unique_ptr<raster::GlContext> context = raster::createContext("auto");
    return *context;
}

}  // namespace

void addRectangle(raster::Scene& scene, const Rectangle& r, double albedo, bool isDoubleSided) {
    raster::Mesh mesh;
    mesh.material = addMaterial(scene, albedo, isDoubleSided);
    for (const glm::dvec2& uv : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}) {
        raster::Vertex vertex;
        vertex.position = glm::vec3(r.at(uv.x, uv.y));
        vertex.normal = glm::vec3(r.normal());
        vertex.tangent = glm::vec4(glm::vec3(glm::normalize(r.sideU)), 1.0f);
        mesh.vertices.push_back(vertex);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    addMesh(scene, std::move(mesh));
}

void addSphere(raster::Scene& scene, double radiusM, double albedo) {
    // Half a degree a cell: facets leave the sphere by 1e-5 of the radius, and points so close to one another that a
    // facet's flatness shows send one another some 1e-4 of all light.
    constexpr int kColumns = 720, kRows = 360;
    raster::Mesh mesh;
    mesh.material = addMaterial(scene, albedo, false);
    for (int row = 0; row <= kRows; ++row) {
        for (int column = 0; column <= kColumns; ++column) {
            const double theta = std::numbers::pi * row / kRows, phi = 2.0 * std::numbers::pi * column / kColumns;
            const glm::dvec3 outwards(std::sin(theta) * std::cos(phi), std::cos(theta),
                                      std::sin(theta) * std::sin(phi));
            raster::Vertex vertex;
            vertex.position = glm::vec3(radiusM * outwards);
            vertex.normal = glm::vec3(-outwards);
            mesh.vertices.push_back(vertex);
        }
    }
    constexpr std::uint32_t kStride = kColumns + 1;
    for (std::uint32_t row = 0; row < kRows; ++row)
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            const std::uint32_t corner = row * kStride + column;
            for (const std::uint32_t i : {0u, kStride, kStride + 1, 0u, kStride + 1, 1u})
                mesh.indices.push_back(corner + i);
        }
    addMesh(scene, std::move(mesh));
}

Camera squareView(const Rectangle& r) {
    const double halfU = 0.5 * glm::length(r.sideU), halfV = 0.5 * glm::length(r.sideV);
    return {glm::mat4(lookSquarelyAt(r, 0.01)), glm::mat4(glm::ortho(-halfU, halfU, -halfV, halfV, 0.005, 0.02))};
}

Camera pointView(const glm::dvec3& point, const glm::dvec3& normal) {
    constexpr double kHalfM = 5e-4;
    return {glm::mat4(lookAlong(point + 0.01 * normal, -normal)),
            glm::mat4(glm::ortho(-kHalfM, kHalfM, -kHalfM, kHalfM, 0.005, 0.02))};
}

Light beamOnto(const Rectangle& r, double lux, double mapSideM) {
    Light light;
    light.name = "beam";
    light.type = LightType::Directional;
    light.intensity = glm::vec3(float(lux));
    const double half = 0.5 * mapSideM;
    light.camera = {glm::mat4(lookSquarelyAt(r, kReachM)),
                    glm::mat4(glm::ortho(-half, half, -half, half, 0.0, 2.0 * kReachM))};
    return light;
}

Light spot(const glm::dvec3& position, const glm::dvec3& target, double candela, double innerConeAngle,
           double outerConeAngle, double mapAngle) {
    Light light;
    light.name = "spot";
    light.type = LightType::Spot;
    light.intensity = glm::vec3(float(candela));
    light.innerConeAngle = float(innerConeAngle);
    light.outerConeAngle = float(outerConeAngle);
    light.camera = {glm::mat4(lookAlong(position, glm::normalize(target - position))),
                    glm::mat4(glm::perspective(mapAngle, 1.0, 0.01, kReachM))};
    return light;
}

double coneIntegral(const Light& light) {
    // All of it up to the inner angle; between the two the square of a linear function of the cosine.
    const double cosInner = std::cos(double(light.innerConeAngle)), cosOuter = std::cos(double(light.outerConeAngle));
    return 2.0 * std::numbers::pi * (1.0 - cosInner + (cosInner - cosOuter) / 3.0);
}

DrawnScene::DrawnScene(const raster::Scene& scene) : renderer_(sharedContext(), scene) {}

FrameImages DrawnScene::draw(const Camera& camera, Extent extent, const Light& light, int rsmSizePx) {
    raster::RasterSettings settings;
    settings.extent = extent;
    settings.rsmSizePx = rsmSizePx;
    settings.shadowSizePx = 256;
    const std::array lights = {light};
    const GlFrame frame = renderer_.render(camera, camera, lights, settings);
    return readBack(frame, camera, {light}, sharedContext().getProcAddress());
}

HostImage compute(Pipeline& pipeline, const FrameImages& frame, const Settings& settings, Output output) {
    pipeline.setFrame(frame.inputs());
    pipeline.run(settings);
    return pipeline.read(output);
}

Settings fullSum() {
    Settings settings;
    settings.estimator = Estimator::Sum;
    return settings;
}

Settings wholeDisk(int sampleCount, double radiusUv) {
    Settings settings;
    settings.estimator = Estimator::Disk;
    settings.sampleCount = sampleCount;
    settings.radiusUv = float(radiusUv);
    settings.animatesNoise = false;
    return settings;
}

Statistics statisticsOf(const HostImage& image) {
    const Extent e = image.extent();
    Statistics s{std::numeric_limits<double>::max(), 0.0, 0.0};
    for (int y = 0; y < e.heightPx; ++y) {
        for (int x = 0; x < e.widthPx; ++x) {
            EXPECT_EQ(image.pixel(x, y)[3], 1.0f) << "sky at " << x << ", " << y;
            const auto value = double(image.pixel(x, y)[0]);
            s = {std::min(s.min, value), s.mean + value / (double(e.widthPx) * e.heightPx), std::max(s.max, value)};
        }
    }
    return s;
}

double meanOf(const HostImage& image) {
    return statisticsOf(image).mean;
}

double totalFlux(const FrameImages& frame) {
    double sum = 0.0;
    const Extent e = frame.rsmFlux.extent();
    for (int y = 0; y < e.heightPx; ++y)
        for (int x = 0; x < e.widthPx; ++x) sum += double(frame.rsmFlux.pixel(x, y)[0]);
    return sum;
}

void expectTruth(const std::string& what, double measured, double truth, double bar) {
    const double error = measured / truth - 1.0;
    EXPECT_NEAR(error, 0.0, bar) << what << ": " << measured << ", not " << truth;
    testing::Test::RecordProperty(what, fmt::format("{:+.5f}", error));
}

}  // namespace earthshine::truth
