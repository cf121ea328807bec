// The camera's G-buffer against geometry and colours that are known exactly.

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "earthshine/error.hpp"
#include "raster/raster_support.hpp"

namespace earthshine::raster::test {
namespace {

// Mesa truncates when it writes halves (others round): the last of 11 bits may be low by one.
constexpr float kHalfUlp = 0x1p-10f;

void expectHalfNear(float value, double expected) {
    EXPECT_NEAR(double(value), expected, double(kHalfUlp) * std::abs(expected) + 1e-7);
}

// A quad over the whole picture, seen straight on; pixel (x, y) shows uv ((x + 0.5) / w, (y + 0.5) / h).
const Camera kFacing = orthographicCamera({0, 0, 2}, {0, 0, 0}, 1.0, 10.0);

void expectPlaneDepth(const Camera& camera, Extent extent) {
    const glm::mat4 worldFromObject =
        glm::scale(glm::rotate(glm::mat4(1), 0.4f, glm::vec3(1, 0.5f, 0.2f)), glm::vec3(40));
    const HostFrame frame = drawScene(quadScene(diffuse(glm::vec3(0.5f)), worldFromObject), camera, {extent});
    const glm::dmat4 viewFromObject = glm::dmat4(camera.viewFromWorld) * glm::dmat4(worldFromObject);
    const glm::dvec3 point(viewFromObject[3]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(viewFromObject[0]), glm::dvec3(viewFromObject[1]));
    const bool perspective = camera.clipFromView[3][3] == 0.0f;
    const auto depthAt = [&](double x, double y) {
        const glm::dvec3 ray = pixelRayVs(camera, extent, x, y);
        const glm::dvec3 across(ray.x, ray.y, 0.0);
        return perspective ? glm::dot(point, normal) / glm::dot(ray, normal)
                           : -glm::dot(point - across, normal) / normal.z;
    };
    const double shiftPx = subpixelShiftPx(sharedContext());
    double worst = 0.0;
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            const Range expected = rangeAround(x, y, shiftPx, depthAt);
            worst = std::max(worst, expected.misses(double(*frame.depth.pixel(x, y))) / expected.min);
        }
    }
    // 1e-5: a millimetre at 100 m, far below what a shadow ray's bias has to be; floats interpolated across one large
    // triangle keep it. Beside that a GPU may round vertices to its grid, which shows where a pixel is large: 0.001 of
    // the depth in a picture of one.
    EXPECT_LT(worst, 1e-5) << extent.widthPx << "x" << extent.heightPx;
}

TEST(RasterGBuffer, LinearDepthIsThatOfThePlane) {
    for (const Extent extent : {Extent{1, 1}, Extent{7, 3}, Extent{191, 347}}) {
        expectPlaneDepth(lookAtCamera({1, 3, 9}, {0.3, -0.2, 0.1}, extent), extent);
        expectPlaneDepth(orthographicCamera({1, 3, 20}, {0.3, -0.2, 0.1}, 8.0, 50.0), extent);
    }
}

TEST(RasterGBuffer, SkyIsEmptyButForTheBackground) {
    const Extent extent{7, 3};
    RasterSettings settings{extent};
    settings.background = {0.25f, 0.5f, 2.0f};
    const Camera away = lookAtCamera({0, 0, 3}, {0, 0, 9}, extent);
    const HostFrame frame = drawScene(quadScene(diffuse(glm::vec3(0.5f))), away, settings);
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            EXPECT_EQ(rgba(frame.albedo, x, y), glm::vec4(0));
            EXPECT_EQ(rgba(frame.normalWs, x, y), glm::vec4(0));
            EXPECT_EQ(*frame.depth.pixel(x, y), 0.0f);
            EXPECT_EQ(rgba(frame.motion, x, y), glm::vec4(0));
            EXPECT_EQ(glm::vec3(rgba(frame.emission, x, y)), settings.background);
        }
    }
}

TEST(RasterGBuffer, AlbedoIsTheDiffusePart) {
    Material material = diffuse({0.9f, 0.6f, 0.3f});
    material.metallic = 0.5f;
    material.metallicTexture.texture = 0;
    material.baseColorTexture.texture = 1;
    Scene scene = quadScene(material);
    for (Vertex& vertex : scene.meshes[0].vertices) vertex.color = {0.5f, 0.75f, 1.0f, 1.0f};
    // Metalness stands in blue; red and green must not matter.
    scene.textures = {nearestTexture(2, 1, {255, 17, 0, 255, 3, 200, 51, 255}),
                      nearestTexture(1, 2, {255, 255, 255, 255, 51, 102, 204, 255})};
    const HostFrame frame = drawScene(scene, kFacing, {{2, 2}});
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
            const double metalness = 0.5 * (x == 0 ? 0.0 : 0.2);
            const glm::dvec3 texel = y == 0 ? glm::dvec3(1) : glm::dvec3(0.2, 0.4, 0.8);
            const glm::dvec3 expected =
                glm::dvec3(0.9, 0.6, 0.3) * glm::dvec3(0.5, 0.75, 1.0) * texel * (1.0 - metalness);
            const glm::vec4 albedo = rgba(frame.albedo, x, y);
            for (int c = 0; c < 3; ++c) expectHalfNear(albedo[c], expected[c]);
        }
    }
}

TEST(RasterGBuffer, AlbedoStaysBelowOne) {
    Scene scene = quadScene(diffuse(glm::vec3(1.0f)));
    for (Vertex& vertex : scene.meshes[0].vertices) vertex.color = {3.0f, 1.0f, 0.5f, 1.0f};
    EXPECT_EQ(glm::vec3(rgba(drawScene(scene, kFacing, {{1, 1}}).albedo, 0, 0)), glm::vec3(1.0f, 1.0f, 0.5f));
}

TEST(RasterGBuffer, SrgbTexturesAreDecoded) {
    std::vector<std::uint8_t> rgba8;
    std::vector<std::uint16_t> rgba16;
    for (int i = 0; i < 256; ++i) {
        for (int c = 0; c < 4; ++c) {
            rgba8.push_back(c == 3 ? 255 : std::uint8_t(i));
            rgba16.push_back(c == 3 ? 65535 : std::uint16_t(257 * i));
        }
    }
    Material material = diffuse(glm::vec3(1.0f));
    material.baseColorTexture.texture = 0;
    Scene scene = quadScene(material);
    scene.textures = {nearestTexture(256, 1, rgba8)};
    scene.textures[0].isSrgb = true;
    const HostFrame from8 = drawScene(scene, kFacing, {{256, 1}});
    scene.textures[0].rgba16 = rgba16;
    const HostFrame from16 = drawScene(scene, kFacing, {{256, 1}});
    for (int i = 0; i < 256; ++i) {
        const double encoded = i / 255.0;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        SCOPED_TRACE(i);
        // GL asks of a driver that a decoded value, encoded again, is within 0.5 of its 8-bit step.
        const double step =
            0.5 / 255.0 * (encoded <= 0.04045 ? 1.0 / 12.92 : 2.4 / 1.055 * std::pow((encoded + 0.055) / 1.055, 1.4));
        EXPECT_NEAR(double(rgba(from8.albedo, i, 0).x), linear, step);
        // Decoded by us, then rounded to half twice.
        EXPECT_NEAR(double(rgba(from16.albedo, i, 0).y), linear, 2.0 * double(kHalfUlp) * linear + 1e-7);
    }
}

TEST(RasterGBuffer, LinearTexturesOf16BitsKeepThemAll) {
    Material material = diffuse(glm::vec3(1.0f));
    material.emission = glm::vec3(1.0f);
    material.emissionTexture.texture = 0;
    Scene scene = quadScene(material);
    scene.textures = {nearestTexture(2, 1, {})};
    scene.textures[0].rgba16 = {100, 101, 40000, 65535, 65535, 0, 1, 65535};
    const HostFrame frame = drawScene(scene, kFacing, {{2, 1}});
    const std::uint16_t* texel = scene.textures[0].rgba16.data();
    for (int i = 0; i < 8; ++i)
        if (i % 4 != 3) expectHalfNear(rgba(frame.emission, i / 4, 0)[i % 4], texel[i] / 65535.0);
}

TEST(RasterGBuffer, TexturesFollowTheirCoordinatesAndTransforms) {
    Material material = diffuse(glm::vec3(1.0f));
    material.baseColorTexture = {0, 1, glm::mat3(1.0f)};
    // u' = v, v' = 1 - u: a quarter turn, then an offset that wraps round.
    material.baseColorTexture.uvFromUv = glm::mat3(0, -1, 0, 1, 0, 0, 1.0f, 3.0f, 1);
    Scene scene = quadScene(material);
    for (Vertex& vertex : scene.meshes[0].vertices) vertex.uv0 = glm::vec2(0.1f);
    scene.textures = {nearestTexture(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255})};
    const glm::vec3 texels[2][2] = {{{1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 1, 1}}};  // [row][column]
    for (const Wrap wrap : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge}) {
        scene.textures[0].wrapU = wrap;
        scene.textures[0].wrapV = wrap;
        const HostFrame frame = drawScene(scene, kFacing, {{2, 2}});
        for (int y = 0; y < 2; ++y) {
            for (int x = 0; x < 2; ++x) {
                const double u = (y + 0.5) / 2 + 1.0;
                const double v = 3.0 - (x + 0.5) / 2;
                const auto texelAt = [wrap](double t) {
                    if (wrap == Wrap::ClampToEdge) return t < 0.5 ? 0 : 1;
                    const double period = t - 2.0 * std::floor(t / 2.0);  // [0; 2)
                    const double within =
                        wrap == Wrap::Repeat ? period - std::floor(period) : (period < 1.0 ? period : 2.0 - period);
                    return within < 0.5 ? 0 : 1;
                };
                EXPECT_EQ(glm::vec3(rgba(frame.albedo, x, y)), texels[texelAt(v)][texelAt(u)])
                    << x << ", " << y << " wrap " << int(wrap);
            }
        }
    }
}

TEST(RasterGBuffer, MipmapsAverageLinearLight) {
    Material material = diffuse(glm::vec3(1.0f));
    material.baseColorTexture.texture = 0;
    Scene scene = quadScene(material);
    std::vector<std::uint8_t> checker;
    for (int i = 0; i < 64 * 64; ++i)
        for (int c = 0; c < 4; ++c) checker.push_back((i + i / 64) % 2 == 0 || c == 3 ? 255 : 0);
    scene.textures = {nearestTexture(64, 64, checker)};
    scene.textures[0].isSrgb = true;
    scene.textures[0].linearFilter = true;
    scene.textures[0].mipmaps = true;
    // Black and white in equal parts is 0.5 in light; averaged as encoded it would be 0.21. 8-bit levels: 0.01.
    EXPECT_NEAR(double(rgba(drawScene(scene, kFacing, {{4, 4}}).albedo, 2, 2).x), 0.5, 0.01);
}

// Top-left texel red, the others of the top row green, all below blue.
TEST(RasterGBuffer, RowZeroIsTheTop) {
    Material material = diffuse(glm::vec3(1.0f));
    material.baseColorTexture.texture = 0;
    Scene scene = quadScene(material);
    scene.textures = {nearestTexture(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 0, 0, 255, 255})};
    const Light light = directionalLight(glm::vec3(1.0f), kFacing);
    const HostFrame frame = drawScene(scene, kFacing, {{2, 2}, 2, 2}, {light});
    for (const HostImage* image : {&frame.albedo, &frame.rsmFlux}) {
        EXPECT_GT(rgba(*image, 0, 0).x, 0.0f);
        EXPECT_GT(rgba(*image, 1, 0).y, 0.0f);
        EXPECT_GT(rgba(*image, 0, 1).z, 0.0f);
        EXPECT_EQ(rgba(*image, 0, 0).y, 0.0f);
        EXPECT_EQ(rgba(*image, 0, 1).x, 0.0f);
    }
}

TEST(RasterGBuffer, BackFacesAreCulledUnlessDoubleSided) {
    const Extent extent{3, 3};
    const Camera front = lookAtCamera({0, 0, 2}, {0, 0, 0}, extent, 0.5);
    const Camera behind = lookAtCamera({0, 0, -2}, {0, 0, 0}, extent, 0.5);
    const glm::mat4 mirror = glm::scale(glm::mat4(1), glm::vec3(-1, 1, 1));
    for (const glm::mat4& worldFromObject : {glm::mat4(1), mirror}) {
        Material material = diffuse(glm::vec3(0.5f));
        Scene scene = quadScene(material, worldFromObject);
        // A mirrored placement turns the winding, but glTF's front stays the front: its normal is +z still.
        EXPECT_EQ(rgba(drawScene(scene, front, {extent}).normalWs, 1, 1), glm::vec4(0, 0, 1, 1));
        EXPECT_EQ(*drawScene(scene, behind, {extent}).depth.pixel(1, 1), 0.0f);
        scene.materials[0].doubleSided = true;
        EXPECT_EQ(rgba(drawScene(scene, front, {extent}).normalWs, 1, 1), glm::vec4(0, 0, 1, 1));
        EXPECT_EQ(rgba(drawScene(scene, behind, {extent}).normalWs, 1, 1), glm::vec4(0, 0, -1, 1));
    }
}

// The tangent frame in doubles: normals by the inverse transpose, tangents as directions, the bitangent by glTF's rule
// in object space (so it is mirrored with the object).
glm::dvec3 mappedNormal(const glm::dmat3& worldFromObject, const glm::dvec3& mapped, double bitangentSign) {
    const glm::dvec3 normal = glm::normalize(glm::inverse(glm::transpose(worldFromObject)) * glm::dvec3(0, 0, 1));
    const glm::dvec3 along = worldFromObject * glm::dvec3(1, 0, 0);
    const glm::dvec3 tangent = glm::normalize(along - normal * glm::dot(normal, along));
    const glm::dvec3 bitangentWs = worldFromObject * (bitangentSign * glm::dvec3(0, 1, 0));
    const glm::dvec3 bitangent = glm::normalize(bitangentWs - normal * glm::dot(normal, bitangentWs));
    return glm::normalize(mapped.x * tangent + mapped.y * bitangent + mapped.z * normal);
}

TEST(RasterGBuffer, NormalMapsFollowRotationMirrorAndUnevenScale) {
    const std::uint8_t texel[3] = {200, 90, 220};
    const double scale = 0.8;
    const glm::dvec3 mapped(scale * (2 * texel[0] / 255.0 - 1), scale * (2 * texel[1] / 255.0 - 1),
                            2 * texel[2] / 255.0 - 1);
    Material material = diffuse(glm::vec3(0.5f));
    material.normalTexture.texture = 0;
    material.normalScale = float(scale);
    material.doubleSided = true;
    const Extent extent{5, 5};
    for (const glm::vec3& size : {glm::vec3(1), glm::vec3(1, 3, 0.5f), glm::vec3(-1, 2, 1), glm::vec3(1, -1, 3),
                                  glm::vec3(1, 2, -0.2f), glm::vec3(-2, -1, -3)}) {
        for (const float bitangentSign : {1.0f, -1.0f}) {
            const glm::mat4 worldFromObject =
                glm::scale(glm::rotate(glm::mat4(1), 2.1f, glm::vec3(0.3f, -1, 0.4f)), size);
            Scene scene = quadScene(material, worldFromObject);
            for (Vertex& vertex : scene.meshes[0].vertices) vertex.tangent.w = bitangentSign;
            scene.textures = {nearestTexture(1, 1, {texel[0], texel[1], texel[2], 255})};
            const glm::dvec3 expected = mappedNormal(glm::dmat3(worldFromObject), mapped, double(bitangentSign));
            const auto facing =
                glm::normalize(glm::dmat3(glm::inverse(glm::transpose(worldFromObject))) * glm::dvec3(0, 0, 1));
            for (const double side : {1.0, -1.0}) {
                const Camera camera = lookAtCamera(side * 3.0 * facing, {0, 0, 0}, extent, 0.1);
                const glm::vec4 normal = rgba(drawScene(scene, camera, {extent}).normalWs, 2, 2);
                EXPECT_EQ(normal.w, 1.0f);
                for (int c = 0; c < 3; ++c)
                    // Of unit vectors in halves: one unit in the last place, and float arithmetic below it.
                    EXPECT_NEAR(double(normal[c]), side * expected[c], double(kHalfUlp)) << c << " side " << side;
            }
        }
    }
}

TEST(RasterGBuffer, DegenerateNormalsAreNotNan) {
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.textures = {nearestTexture(1, 1, {128, 128, 255, 255})};
    scene.materials[0].normalTexture.texture = 0;
    for (Vertex& vertex : scene.meshes[0].vertices) {
        vertex.normal = glm::vec3(0);
        vertex.tangent = glm::vec4(0, 0, 0, 1);
    }
    const glm::vec4 normal = rgba(drawScene(scene, kFacing, {{1, 1}}).normalWs, 0, 0);
    for (int c = 0; c < 4; ++c) EXPECT_TRUE(std::isfinite(normal[c]));
}

TEST(RasterGBuffer, EmissionIsFactorTimesTextureAndFinite) {
    Material material = diffuse(glm::vec3(0.5f));
    material.emission = {200.0f, 1e6f, 0.0f};
    material.emissionTexture.texture = 0;
    Scene scene = quadScene(material);
    scene.textures = {nearestTexture(1, 1, {51, 255, 255, 255})};
    const glm::vec4 emission = rgba(drawScene(scene, kFacing, {{1, 1}}).emission, 0, 0);
    expectHalfNear(emission.x, 40.0);
    EXPECT_EQ(emission.y, 65504.0f);
    EXPECT_EQ(emission.z, 0.0f);
}

TEST(RasterGBuffer, AlphaMaskHolesAreHolesInEveryPass) {
    Material material = diffuse(glm::vec3(0.5f));
    material.baseColor.a = 0.9f;
    material.baseColorTexture.texture = 0;
    material.alphaMode = AlphaMode::Mask;
    material.alphaCutoff = 0.5f;
    Scene scene = quadScene(material);
    for (Vertex& vertex : scene.meshes[0].vertices) vertex.color.a = 0.8f;
    // 0.72 x alpha against 0.5: the cutoff falls at 177.08 of 255.
    scene.textures = {
        nearestTexture(4, 1, {255, 255, 255, 0, 255, 255, 255, 177, 255, 255, 255, 178, 255, 255, 255, 255})};
    const bool solid[] = {false, false, true, true};
    const HostFrame masked = drawScene(scene, kFacing, {{4, 1}, 4, 4}, {directionalLight(glm::vec3(1), kFacing)});
    for (int x = 0; x < 4; ++x) {
        SCOPED_TRACE(x);
        const auto is = solid[x] ? 1.0f : 0.0f;
        EXPECT_EQ(rgba(masked.normalWs, x, 0).w, is);
        EXPECT_EQ(*masked.depth.pixel(x, 0) > 0.0f, solid[x]);
        EXPECT_EQ(rgba(masked.rsmNormalWs, x, 2).w, is);
        EXPECT_EQ(*masked.rsmDepth.pixel(x, 2) > 0.0f, solid[x]);
        EXPECT_EQ(rgba(masked.rsmFlux, x, 2).x > 0.0f, solid[x]);
        EXPECT_EQ(*masked.shadowDepth.pixel(x, 2) > 0.0f, solid[x]);
    }
    scene.materials[0].alphaMode = AlphaMode::Opaque;
    EXPECT_EQ(rgba(drawScene(scene, kFacing, {{4, 1}}).normalWs, 0, 0).w, 1.0f);
}

TEST(RasterGBuffer, ResizingKeepsThePictureAndFormats) {
    const Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    SceneRenderer renderer(sharedContext(), scene);
    for (const Extent extent : {Extent{191, 347}, Extent{1, 1}, Extent{7, 3}, Extent{191, 347}}) {
        const GlFrame gl = renderer.render(kFacing, kFacing, {}, {extent});
        EXPECT_EQ(gl.lightCount, 0);
        EXPECT_EQ(gl.rsmFlux.name, 0u);
        for (const GlTexture* texture : {&gl.albedo, &gl.normalWs, &gl.depth, &gl.motion, &gl.emission})
            EXPECT_EQ(texture->extent, extent);
        EXPECT_EQ(gl.depth.format, PixelFormat::R32F);
        EXPECT_EQ(gl.albedo.format, PixelFormat::RGBA16F);
        const HostFrame frame = readFrame(sharedContext(), gl);
        EXPECT_EQ(*frame.depth.pixel(0, 0), 2.0f);
        EXPECT_EQ(*frame.depth.pixel(extent.widthPx - 1, extent.heightPx - 1), 2.0f);
        const GlFrame again = renderer.render(kFacing, kFacing, {}, {extent});
        EXPECT_EQ(again.depth.name, gl.depth.name);
    }
}

TEST(RasterGBuffer, NearerSurfacesHideFartherOnes) {
    Scene scene = quadScene(diffuse({1, 0, 0}));
    scene.materials.push_back(diffuse({0, 1, 0}));
    scene.meshes.push_back(unitQuad(1));
    for (int nearer = 0; nearer < 2; ++nearer) {  // whatever order they are drawn in
        scene.instances = {{nearer, glm::translate(glm::mat4(1), glm::vec3(1, 0, 1e-3f))},  // the right half
                           {1 - nearer, glm::mat4(1)}};
        const HostFrame frame = drawScene(scene, kFacing, {{2, 1}, 2, 2}, {directionalLight(glm::vec3(1), kFacing)});
        for (int x = 0; x < 2; ++x) {
            const glm::vec3 seen = scene.materials[std::size_t(x == 1 ? nearer : 1 - nearer)].baseColor;
            EXPECT_EQ(glm::vec3(rgba(frame.albedo, x, 0)), seen);
            EXPECT_EQ(glm::vec3(rgba(frame.rsmFlux, x, 1)), seen);  // 1 lx on texels of 1 m^2
        }
        EXPECT_NEAR(double(*frame.shadowDepth.pixel(0, 0) - *frame.shadowDepth.pixel(1, 0)), 1e-3, 1e-6);
    }
}

TEST(RasterGBuffer, ImpossibleSizesAreRefusedInOneLine) {
    SceneRenderer renderer(sharedContext(), quadScene(diffuse(glm::vec3(0.5f))));
    const int most = sharedContext().description().maxTextureSizePx;
    const std::vector<Light> lights(3, directionalLight(glm::vec3(1), kFacing));
    EXPECT_THROW(renderer.render(kFacing, kFacing, {}, {{0, 4}}), UsageError);
    EXPECT_THROW(renderer.render(kFacing, kFacing, {}, {{4, -1}}), UsageError);
    EXPECT_THROW(renderer.render(kFacing, kFacing, lights, {{4, 4}, 0}), UsageError);
    EXPECT_THROW(renderer.render(kFacing, kFacing, {}, {{most + 1, 1}}), DeviceError);
    try {
        renderer.render(kFacing, kFacing, lights, {{4, 4}, most / 2});
        FAIL() << "an atlas of one and a half times the largest height";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("rsm: 3 lights of"));
        EXPECT_THAT(error.what(), testing::HasSubstr("use a size of " + std::to_string(most / 3)));
    }
    // And it goes on working.
    EXPECT_EQ(renderer.render(kFacing, kFacing, lights, {{4, 4}, 8, 8}).rsmFlux.extent, (Extent{8, 24}));
}

TEST(RasterGBuffer, TooLargeTexturesNameTheSceneAndTheTexture) {
    const int widthPx = sharedContext().description().maxTextureSizePx + 1;
    Scene scene = quadScene(diffuse(glm::vec3(0.5f)));
    scene.textures = {nearestTexture(widthPx, 1, std::vector<std::uint8_t>(std::size_t(widthPx) * 4))};
    try {
        SceneRenderer renderer(sharedContext(), scene);
        FAIL() << "one texel too wide";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::StartsWith("quad.gltf: texture \"texture\": " + std::to_string(widthPx)));
    }
}

}  // namespace
}  // namespace earthshine::raster::test
