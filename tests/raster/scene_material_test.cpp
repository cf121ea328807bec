// Materials and textures, as the renderer gets them.

#include <gmock/gmock.h>

#include "raster/scene_support.hpp"

namespace earthshine::raster::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The quad with a material of its own.
GltfBuilder withMaterial(const Json& material) {
    GltfBuilder builder = quadBuilder();
    builder.document["meshes"][0]["primitives"][0]["material"] = builder.add("materials", material);
    return builder;
}

TEST(SceneMaterial, Factors) {
    const Scene scene =
        withMaterial({{"name", "paint"},
                      {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.25}}},
                      {"emissiveFactor", {1.0, 0.5, 0.0}},
                      {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8.0}}}}},
                      {"alphaMode", "MASK"},
                      {"alphaCutoff", 0.75},
                      {"doubleSided", true}})
            .load();
    ASSERT_EQ(scene.materials.size(), 1u);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.name, "paint");
    EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.25f);
    EXPECT_EQ(material.emission, glm::vec3(8.0f, 4.0f, 0.0f));
    EXPECT_EQ(material.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(material.alphaCutoff, 0.75f);
    EXPECT_TRUE(material.doubleSided);
    EXPECT_THAT(scene.notes, IsEmpty());
}

TEST(SceneMaterial, Defaults) {
    const Scene scene = withMaterial(Json::object()).load();
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.baseColor, glm::vec4(1.0f));
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.emission, glm::vec3(0.0f));
    EXPECT_EQ(material.alphaMode, AlphaMode::Opaque);
    EXPECT_EQ(material.normalScale, 1.0f);
    EXPECT_FALSE(material.doubleSided);
    EXPECT_EQ(material.baseColorTexture.texture, -1);
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("all metal")));  // black in a renderer of diffuse light
}

TEST(SceneMaterial, WithoutOneIsWhiteAndDiffuse) {
    const Scene scene = quadBuilder().load();
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].baseColor, glm::vec4(1.0f));
    EXPECT_EQ(scene.materials[0].metallic, 0.0f);
}

TEST(SceneMaterial, BlendBecomesMaskWithANote) {
    const Scene scene =
        withMaterial({{"name", "water"}, {"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}})
            .load();
    EXPECT_EQ(scene.materials.at(0).alphaMode, AlphaMode::Mask);
    EXPECT_EQ(scene.materials.at(0).alphaCutoff, 0.5f);
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("BLEND")));
}

TEST(SceneMaterial, SpecularGlossinessKeepsItsDiffuseColor) {
    GltfBuilder builder = quadBuilder();
    const int texture = builder.addTexture(pngRgba8());
    const Json extension = {
        {"diffuseFactor", {0.5, 0.25, 0.125, 1.0}},
        {"diffuseTexture", {{"index", texture}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 3}}}}}}}}};
    builder.document["meshes"][0]["primitives"][0]["material"] =
        builder.add("materials", {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", extension}}}});
    const Scene scene = builder.load();
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.baseColor, glm::vec4(0.5f, 0.25f, 0.125f, 1.0f));
    EXPECT_EQ(material.metallic, 0.0f);
    ASSERT_EQ(material.baseColorTexture.texture, 0);
    EXPECT_EQ(material.baseColorTexture.uvFromUv * glm::vec3(1, 1, 1), glm::vec3(2, 3, 1));
    EXPECT_TRUE(scene.textures.at(0).isSrgb);
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("pbrSpecularGlossiness")));
}

TEST(SceneMaterial, UnlitIsDiffuseWithANote) {
    const Scene scene = withMaterial({{"extensions", {{"KHR_materials_unlit", Json::object()}}}}).load();
    EXPECT_EQ(scene.materials.at(0).metallic, 0.0f);
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("unlit")));
}

TEST(SceneMaterial, ExtensionsThatAreOnlyUsedAreNoted) {
    GltfBuilder builder = quadBuilder();
    builder.document["extensionsUsed"] = {"KHR_lights_punctual", "EXT_something_new"};
    EXPECT_THAT(builder.load().notes, ElementsAre(HasSubstr("EXT_something_new")));
}

TEST(SceneTexture, TexelsKeepTheirPlaceAndTheirBits) {
    GltfBuilder builder = quadBuilder();
    const int bytes = builder.addTexture(pngRgba8());
    const int words = builder.addTexture(pngRgb16());
    builder.document["meshes"][0]["primitives"][0]["material"] = builder.add(
        "materials", {{"emissiveTexture", {{"index", bytes}}}, {"normalTexture", {{"index", words}, {"scale", 0.5}}}});
    const Scene scene = builder.load();
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.normalScale, 0.5f);
    const Texture& eight = scene.textures.at(std::size_t(material.emissionTexture.texture));
    EXPECT_EQ(eight.widthPx, 2);
    EXPECT_EQ(eight.heightPx, 2);
    EXPECT_TRUE(eight.isSrgb);
    EXPECT_THAT(eight.rgba16, IsEmpty());
    EXPECT_THAT(eight.rgba8, ElementsAre(255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 255, 10, 20, 30, 40));
    const Texture& sixteen = scene.textures.at(std::size_t(material.normalTexture.texture));
    EXPECT_FALSE(sixteen.isSrgb);
    EXPECT_THAT(sixteen.rgba8, IsEmpty());
    EXPECT_THAT(sixteen.rgba16, ElementsAre(65535, 256, 1, 65535, 0, 12345, 54321, 65535));
}

TEST(SceneTexture, OneImageInTwoRolesIsTwoTextures) {
    GltfBuilder builder = quadBuilder();
    const int texture = builder.addTexture(pngRgba8());
    builder.document["meshes"][0]["primitives"][0]["material"] =
        builder.add("materials",
                    {{"pbrMetallicRoughness",
                      {{"baseColorTexture", {{"index", texture}}}, {"metallicRoughnessTexture", {{"index", texture}}}}},
                     {"emissiveTexture", {{"index", texture}}}});
    const Scene scene = builder.load();
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(scene.textures.size(), 2u);
    EXPECT_EQ(material.baseColorTexture.texture, material.emissionTexture.texture);
    EXPECT_TRUE(scene.textures.at(std::size_t(material.baseColorTexture.texture)).isSrgb);
    EXPECT_FALSE(scene.textures.at(std::size_t(material.metallicTexture.texture)).isSrgb);
}

TEST(SceneTexture, Samplers) {
    GltfBuilder builder = quadBuilder();
    const int set =
        builder.addTexture(pngRgba8(), {{"magFilter", 9728}, {"minFilter", 9729}, {"wrapS", 33071}, {"wrapT", 33648}});
    const int unset = builder.addTexture(pngRgba8());
    builder.document["meshes"][0]["primitives"][0]["material"] = builder.add(
        "materials",
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", set}}}}}, {"emissiveTexture", {{"index", unset}}}});
    const Scene scene = builder.load();
    const Texture& first = scene.textures.at(std::size_t(scene.materials.at(0).baseColorTexture.texture));
    EXPECT_EQ(first.wrapU, Wrap::ClampToEdge);
    EXPECT_EQ(first.wrapV, Wrap::MirroredRepeat);
    EXPECT_FALSE(first.linearFilter);
    EXPECT_FALSE(first.mipmaps);
    const Texture& second = scene.textures.at(std::size_t(scene.materials.at(0).emissionTexture.texture));
    EXPECT_EQ(second.wrapU, Wrap::Repeat);
    EXPECT_EQ(second.wrapV, Wrap::Repeat);
    EXPECT_TRUE(second.linearFilter);
    EXPECT_TRUE(second.mipmaps);
}

TEST(SceneTexture, TransformIsAsInTheKhronosTestModel) {
    // The sample model TextureTransformTest marks where the tip of an arrow must show: on a line from the quad's corner
    // through (0.42, 1.02) when turned by pi / 8, where the picture has it on its diagonal.
    GltfBuilder builder = quadBuilder();
    const Json info = {{"index", builder.addTexture(pngRgba8())},
                       {"extensions", {{"KHR_texture_transform", {{"rotation", 0.39269908169872414}}}}}};
    builder.document["meshes"][0]["primitives"][0]["material"] =
        builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", info}}}});
    const Scene scene = builder.load();
    const glm::vec3 uv =
        scene.materials.at(0).baseColorTexture.uvFromUv * glm::vec3(0.5f - 0.07904822f, 0.5f + 0.51626748f, 1.0f);
    EXPECT_NEAR(uv.x, uv.y, 1e-5f);  // the diagonal, to the digits that the model has

    // Scale first, then rotation, then offset; a quarter turn takes u to -v and v to u.
    Json& transform = builder.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
                                      ["KHR_texture_transform"];
    transform = {{"offset", {10, 20}}, {"rotation", 1.5707963267948966}, {"scale", {2, 3}}};
    const Scene turned = builder.load();
    const glm::vec3 moved = turned.materials.at(0).baseColorTexture.uvFromUv * glm::vec3(1, 1, 1);
    EXPECT_NEAR(moved.x, 13.0f, 1e-5f);  // rounding of the cosine of a right angle
    EXPECT_NEAR(moved.y, 18.0f, 1e-5f);
}

TEST(SceneTexture, WithoutAReadableSourceIsLeftOutWithANote) {
    GltfBuilder builder = withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    builder.add("images", {{"uri", "picture.ktx2"}});
    builder.add("textures", {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
    builder.document["extensionsUsed"] = {"KHR_texture_basisu"};
    const Scene scene = builder.load();
    EXPECT_EQ(scene.materials.at(0).baseColorTexture.texture, -1);
    EXPECT_THAT(scene.notes, Contains(HasSubstr("textures[0]")));
}

TEST(SceneTexture, ImagesThatNothingUsesAreNotRead) {
    GltfBuilder builder = quadBuilder();
    builder.add("images", {{"uri", "not there.png"}});
    builder.add("textures", {{"source", 0}});
    EXPECT_THAT(builder.load().textures, IsEmpty());
}

TEST(SceneTexture, MissingCoordinatesAreNoted) {
    GltfBuilder builder = quadBuilder();
    const int texture = builder.addTexture(pngRgba8());
    Json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["material"] = builder.add("materials", {{"emissiveTexture", {{"index", texture}, {"texCoord", 1}}}});
    EXPECT_THAT(builder.load().notes, Contains(HasSubstr("TEXCOORD_1")));
    builder.document["materials"][0]["emissiveTexture"]["texCoord"] = 2;
    EXPECT_THAT(builder.load().notes, Contains(HasSubstr("TEXCOORD_2")));
}

}  // namespace
}  // namespace earthshine::raster::test
