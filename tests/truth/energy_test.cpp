// Light is neither lost nor made: what a spot sends out is reflected, and what is reflected arrives.

#include <gtest/gtest.h>

#include "raster/light_fit.hpp"
#include "raster/scene/gltf_loader.hpp"
#include "reference/device_variants.hpp"
#include "truth/truth_scene.hpp"

namespace earthshine::truth {
namespace {

// The walls of a room [0; size], facing inwards.
std::vector<Rectangle> roomWalls(const glm::dvec3& size) {
    const glm::dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), o(0.0);
    return {{o, z, x}, {o, y, z}, {o, x, y}, {size, -x, -z}, {size, -z, -y}, {size, -y, -x}};
}

// An empty room is convex, so all that one wall reflects falls on the others: sum over walls of E A = sum of Phi.
TEST(Energy, WhatAClosedRoomReflectsArrives) {
    const double albedo = 0.7, candela = 200.0;
    const glm::dvec3 size(1.0, 0.8, 1.3);
    const std::vector<Rectangle> walls = roomWalls(size);
    raster::Scene scene;
    for (const Rectangle& wall : walls) addRectangle(scene, wall, albedo);
    DrawnScene drawn(scene);
    const reference::Variant variant = reference::defaultVariants().at(0);
    Pipeline pipeline{Device(variant.caps, variant.options)};
    // Off the centre, into a corner: lit texels meet three walls, also along their edges.
    const Light light = spot({0.6, 0.5, 0.9}, {0.1, 0.0, 0.2}, candela, 0.3, 0.9, 1.9);
    const double phi = albedo * candela * coneIntegral(light);
    for (const int rsmSizePx : {128, 512}) {
        SCOPED_TRACE(rsmSizePx);
        double arrived = 0.0, arrivedByDisk = 0.0;
        for (const Rectangle& wall : walls) {
            const FrameImages frame = drawn.draw(squareView(wall), {24, 24}, light, rsmSizePx);
            expectTruth("flux_" + std::to_string(rsmSizePx), totalFlux(frame), phi, 0.005);
            arrived += wall.area() * meanOf(compute(pipeline, frame, fullSum()));
            arrivedByDisk += wall.area() * meanOf(compute(pipeline, frame, wholeDisk(4096)));
        }
        expectTruth("arrived_" + std::to_string(rsmSizePx), arrived, phi, 0.01);
        expectTruth("arrived_by_disk_" + std::to_string(rsmSizePx), arrivedByDisk, phi, 0.01);
    }
}

// data/cornell.glb with its front closed and grey walls: its spot's map holds all of the spot's light.
TEST(Energy, TheCornellSpotsMapHoldsItsLight) {
    raster::Scene scene = raster::loadGltf(EARTHSHINE_DATA_DIR "/cornell.glb");
    const double albedo = 0.5;
    for (raster::Material& material : scene.materials) {
        material.baseColor = glm::vec4(float(albedo));
        material.baseColor.a = 1.0f;
    }
    const std::vector<Light> fitted = raster::fitLights(scene);
    ASSERT_EQ(fitted.size(), 1u);
    const double phi = albedo * double(fitted[0].intensity.x) * coneIntegral(fitted[0]);
    // The front: as wide as all of the scene, across the opening at its least z, facing inwards.
    const glm::dvec3 low(scene.boundsMin), high(scene.boundsMax);
    const glm::dvec3 front(low.x - 1.0, low.y - 1.0, low.z);
    addRectangle(scene, {front, {high.x - low.x + 2.0, 0, 0}, {0, high.y - low.y + 2.0, 0}}, albedo);
    DrawnScene drawn(scene);
    for (const int rsmSizePx : {64, 256, 512}) {
        const Camera any = pointView({0.278, 0.0, 0.1}, {0, 1, 0});
        expectTruth("flux_" + std::to_string(rsmSizePx), totalFlux(drawn.draw(any, {1, 1}, fitted[0], rsmSizePx)), phi,
                    0.005);
    }
}

}  // namespace
}  // namespace earthshine::truth
