// Files that are wrong or hostile: each is refused in one line that names the place.

#include <functional>
#include <limits>

#include <gmock/gmock.h>

#include "raster/scene_support.hpp"

namespace earthshine::raster::test {
namespace {

using testing::HasSubstr;

/// One way to spoil the quad, and words of the line that must come of it.
struct Spoiled {
    const char* name;
    std::function<void(GltfBuilder&)> spoil;
    const char* place;
    const char* what;
};

void PrintTo(const Spoiled& spoiled, std::ostream* out) {
    *out << spoiled.name;
}

Json& accessor(GltfBuilder& b, std::size_t i) {
    return b.document["accessors"][i];
}
Json& view(GltfBuilder& b, std::size_t i) {
    return b.document["bufferViews"][i];
}
Json& primitive(GltfBuilder& b) {
    return b.document["meshes"][0]["primitives"][0];
}
Json& node(GltfBuilder& b) {
    return b.document["nodes"][0];
}

Json sparse(GltfBuilder& b, const std::vector<std::uint8_t>& elements) {
    return {{"count", elements.size()},
            {"indices", {{"bufferView", b.view(elements)}, {"componentType", 5121}}},
            {"values", {{"bufferView", b.view(std::vector<float>(3 * elements.size()))}}}};
}

void withTexture(GltfBuilder& b, const ByteVector& picture) {
    const int texture = b.addTexture(picture);
    primitive(b)["material"] = b.add("materials", {{"emissiveTexture", {{"index", texture}}}});
}

/// The 8-bit PNG with another size in its header.
ByteVector pngOfSize(std::uint32_t widthPx, std::uint32_t heightPx) {
    ByteVector png = pngRgba8();
    for (std::size_t i = 0; i < 4; ++i) {
        png[16 + i] = static_cast<unsigned char>(widthPx >> (24 - 8 * i));
        png[20 + i] = static_cast<unsigned char>(heightPx >> (24 - 8 * i));
    }
    return png;
}

void withPosition(GltfBuilder& b, float x) {
    std::vector<float> positions = Quad::positions();
    positions[6] = x;
    primitive(b)["attributes"]["POSITION"] = b.accessor(positions, "VEC3");
}

const Spoiled kSpoiled[] = {
    // Accessors, buffer views, buffers
    {"AccessorPastItsView", [](GltfBuilder& b) { accessor(b, 1)["count"] = 1000000; }, "accessors[1]",
     "needs 12000000 B, bufferViews[1] holds 48 B"},
    {"AccessorByOneByte", [](GltfBuilder& b) { accessor(b, 1)["byteOffset"] = 1; }, "accessors[1]", "needs 49 B"},
    {"AccessorOffsetNegative", [](GltfBuilder& b) { accessor(b, 0)["byteOffset"] = -4; }, "accessors[0].byteOffset",
     "-4"},
    {"AccessorOffsetHuge", [](GltfBuilder& b) { accessor(b, 0)["byteOffset"] = 18446744073709551600ull; },
     "accessors[0].byteOffset", "not in"},
    {"AccessorCountHuge", [](GltfBuilder& b) { accessor(b, 0)["count"] = 1537228672809129302ull; },
     "accessors[0].count", "not in"},
    {"AccessorCountLarge", [](GltfBuilder& b) { accessor(b, 0)["count"] = 1099511627776ull; }, "accessors[0]",
     "needs 13194139533312 B"},
    {"AccessorCountZero", [](GltfBuilder& b) { accessor(b, 0)["count"] = 0; }, "accessors[0].count", "not in"},
    {"AccessorCountMissing", [](GltfBuilder& b) { accessor(b, 0).erase("count"); }, "accessors[0].count", "missing"},
    {"AccessorCountFraction", [](GltfBuilder& b) { accessor(b, 0)["count"] = 4.5; }, "accessors[0].count", "integer"},
    {"AccessorComponentType", [](GltfBuilder& b) { accessor(b, 0)["componentType"] = 5130; },
     "accessors[0].componentType", "5130"},
    {"AccessorType", [](GltfBuilder& b) { accessor(b, 0)["type"] = "VEC5"; }, "accessors[0].type", "VEC5"},
    {"AccessorWithoutThatView", [](GltfBuilder& b) { accessor(b, 0)["bufferView"] = 99; }, "accessors[0].bufferView",
     "99"},
    {"AccessorViewAsString", [](GltfBuilder& b) { accessor(b, 0)["bufferView"] = "0"; }, "accessors[0].bufferView",
     "string"},
    {"ZerosWithoutEnd",
     [](GltfBuilder& b) {
         for (int i = 0; i < 3; ++i) {
             accessor(b, std::size_t(i)).erase("bufferView");
             accessor(b, std::size_t(i))["count"] = 1000000000;
         }
     },
     "POSITION", "is the most"},
    {"ViewPastItsBuffer", [](GltfBuilder& b) { view(b, 1)["byteLength"] = 4096; }, "bufferViews[1]",
     "buffers[0] holds"},
    {"ViewOffsetNegative", [](GltfBuilder& b) { view(b, 1)["byteOffset"] = -1; }, "bufferViews[1].byteOffset", "-1"},
    {"ViewLengthNegative", [](GltfBuilder& b) { view(b, 1)["byteLength"] = -12; }, "bufferViews[1].byteLength", "-12"},
    {"ViewLengthOverflows", [](GltfBuilder& b) { view(b, 1)["byteLength"] = 18446744073709551615ull; },
     "bufferViews[1].byteLength", "not in"},
    {"ViewOfNoBuffer", [](GltfBuilder& b) { view(b, 1)["buffer"] = 1; }, "bufferViews[1].buffer",
     "buffers has 1 elements"},
    {"ViewStrideOdd", [](GltfBuilder& b) { view(b, 0)["byteStride"] = 13; }, "bufferViews[0]", "byteStride"},
    {"ViewStrideShort", [](GltfBuilder& b) { view(b, 0)["byteStride"] = 8; }, "accessors[0]", "byteStride"},
    {"ViewStrideLong", [](GltfBuilder& b) { view(b, 0)["byteStride"] = 252; }, "accessors[0]", "needs 768 B"},
    {"BufferShorterThanSaid",
     [](GltfBuilder& b) {
         b.document["buffers"] = Json::array({Json{{"byteLength", 100}, {"uri", "data:;base64,AAAA"}}});
     },
     "buffers[0]", "needs 100 B, its data holds 3 B"},
    {"BufferWithoutData",
     [](GltfBuilder& b) {
         b.document["buffers"] = Json::array({Json{{"byteLength", 100}}});
     },
     "buffers[0]", "no uri"},
    {"BufferNotBase64",
     [](GltfBuilder& b) {
         b.document["buffers"] = Json::array({Json{{"byteLength", 100}, {"uri", "data:text/plain,hello"}}});
     },
     "buffers[0]", "base64"},
    {"BufferFileMissing",
     [](GltfBuilder& b) {
         b.document["buffers"] = Json::array({Json{{"byteLength", 100}, {"uri", "nowhere.bin"}}});
     },
     "buffers[0]: \"nowhere.bin\"", "no such file"},
    {"BufferElsewhere",
     [](GltfBuilder& b) {
         b.document["buffers"] = Json::array({Json{{"byteLength", 100}, {"uri", "https://example.org/x.bin"}}});
     },
     "buffers[0]", "not a file beside the scene"},
    // Sparse
    {"SparseOutOfRange",
     [](GltfBuilder& b) {
         accessor(b, 0)["sparse"] = sparse(b, {0, 4});
     },
     "accessors[0].sparse.indices[1]", "is 4"},
    {"SparseNotIncreasing",
     [](GltfBuilder& b) {
         accessor(b, 0)["sparse"] = sparse(b, {2, 1});
     },
     "accessors[0].sparse.indices[1]", "is 1"},
    {"SparseTwice",
     [](GltfBuilder& b) {
         accessor(b, 0)["sparse"] = sparse(b, {2, 2});
     },
     "accessors[0].sparse.indices[1]", "is 2"},
    {"SparseMoreThanAll",
     [](GltfBuilder& b) {
         accessor(b, 0)["sparse"] = sparse(b, {0, 1, 2, 3, 4});
     },
     "accessors[0].sparse", "5 of 4"},
    {"SparseIndicesPastTheirView",
     [](GltfBuilder& b) {
         accessor(b, 0)["sparse"] = sparse(b, {0, 1});
         accessor(b, 0)["sparse"]["indices"]["byteOffset"] = 1;
     },
     "accessors[0].sparse.indices", "needs 3 B"},
    {"SparseValuesPastTheirView",
     [](GltfBuilder& b) {
         accessor(b, 0)["sparse"] = sparse(b, {0, 1});
         accessor(b, 0)["sparse"]["values"]["byteOffset"] = 4;
     },
     "accessors[0].sparse.values", "needs 28 B"},
    {"SparseIndexType",
     [](GltfBuilder& b) {
         accessor(b, 0)["sparse"] = sparse(b, {0, 1});
         accessor(b, 0)["sparse"]["indices"]["componentType"] = 5126;
     },
     "accessors[0].sparse.indices.componentType", "5126"},
    // Meshes
    {"IndexOutOfRange",
     [](GltfBuilder& b) {
         primitive(b)["indices"] = b.accessor(std::vector<std::uint16_t>{0, 1, 4}, "SCALAR");
     },
     "meshes[0].primitives[0].indices[2]", "is 4, but there are 4 vertices"},
    {"IndexIsRestart",
     [](GltfBuilder& b) {
         primitive(b)["indices"] = b.accessor(std::vector<std::uint32_t>{0, 1, 0xffffffffu}, "SCALAR");
     },
     "indices[2]", "4294967295"},
    {"IndicesAreFloats",
     [](GltfBuilder& b) {
         primitive(b)["indices"] = b.accessor(std::vector<float>{0, 1, 2}, "SCALAR");
     },
     "meshes[0].primitives[0].indices", "5126"},
    {"IndicesAreVectors",
     [](GltfBuilder& b) {
         primitive(b)["indices"] = b.accessor(std::vector<std::uint16_t>{0, 1, 2, 3}, "VEC2");
     },
     "meshes[0].primitives[0].indices", "VEC2"},
    {"IndicesOfNoAccessor", [](GltfBuilder& b) { primitive(b)["indices"] = 77; }, "meshes[0].primitives[0].indices",
     "77"},
    {"AttributeOfNoAccessor", [](GltfBuilder& b) { primitive(b)["attributes"]["POSITION"] = -1; },
     "attributes.POSITION", "-1"},
    {"AttributeWrongType", [](GltfBuilder& b) { primitive(b)["attributes"]["NORMAL"] = 2; }, "primitives[0].NORMAL",
     "VEC2"},
    {"AttributeWrongComponent",
     [](GltfBuilder& b) { primitive(b)["attributes"]["COLOR_0"] = b.accessor(std::vector<std::uint8_t>(16), "VEC4"); },
     "primitives[0].COLOR_0", "5121"},
    {"AttributeCountDiffers",
     [](GltfBuilder& b) { primitive(b)["attributes"]["TEXCOORD_1"] = b.accessor(std::vector<float>(6), "VEC2"); },
     "primitives[0].TEXCOORD_1", "3 elements, POSITION has 4"},
    {"MorphCountDiffers",
     [](GltfBuilder& b) {
         primitive(b)["targets"] = Json::array({Json{{"POSITION", b.accessor(std::vector<float>(6), "VEC3")}}});
     },
     "targets[0].POSITION", "2 elements"},
    {"PositionNotANumber", [](GltfBuilder& b) { withPosition(b, std::numeric_limits<float>::quiet_NaN()); },
     "primitives[0].POSITION[2]", "not finite"},
    {"PositionInfinite", [](GltfBuilder& b) { withPosition(b, std::numeric_limits<float>::infinity()); },
     "primitives[0].POSITION[2]", "not finite"},
    {"ExtentInfinite",
     [](GltfBuilder& b) {
         withPosition(b, 3e38f);
         node(b)["scale"] = {10, 1, 1};
     },
     "scene.gltf", "extent"},
    {"ModeUnknown", [](GltfBuilder& b) { primitive(b)["mode"] = 7; }, "primitives[0].mode", "7"},
    {"MaterialUnknown", [](GltfBuilder& b) { primitive(b)["material"] = 0; }, "primitives[0].material",
     "materials has 0"},
    {"PrimitivesMissing", [](GltfBuilder& b) { b.document["meshes"][0].erase("primitives"); }, "meshes[0].primitives",
     "missing"},
    // Nodes
    {"NodeIsItsOwnChild", [](GltfBuilder& b) { node(b)["children"] = {0}; }, "nodes[0]", "its own ancestor"},
    {"NodeCycle",
     [](GltfBuilder& b) {
         node(b)["children"] = {1};
         b.add("nodes", {{"children", {2}}});
         b.add("nodes", {{"children", {0}}});
     },
     "nodes[", "its own ancestor"},
    {"NodeOfTwoParents",
     [](GltfBuilder& b) {
         b.add("nodes", {{"children", {0}}});
         b.add("nodes", {{"children", {0}}});
     },
     "nodes[0]", "nodes[1] and of nodes[2]"},
    {"NodeTwiceAChild",
     [](GltfBuilder& b) {
         b.add("nodes", {{"children", {0, 0}}});
     },
     "nodes[0]", "one parent"},
    {"NodeChildUnknown", [](GltfBuilder& b) { node(b)["children"] = {8}; }, "nodes[0].children[0]", "8"},
    {"NodeMeshUnknown", [](GltfBuilder& b) { node(b)["mesh"] = 8; }, "nodes[0].mesh", "8"},
    {"NodeCameraUnknown", [](GltfBuilder& b) { node(b)["camera"] = 0; }, "nodes[0].camera", "cameras has 0"},
    {"NodeLightUnknown", [](GltfBuilder& b) { node(b)["extensions"]["KHR_lights_punctual"]["light"] = 3; },
     "nodes[0].extensions.KHR_lights_punctual.light", "3"},
    {"NodeMatrixShort",
     [](GltfBuilder& b) {
         node(b)["matrix"] = {1, 2, 3};
     },
     "nodes[0].matrix", "3 elements"},
    {"NodeMatrixProjective",
     [](GltfBuilder& b) { node(b)["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, 1}; }, "nodes[0].matrix",
     "last row"},
    {"NodeMatrixAndScale",
     [](GltfBuilder& b) {
         node(b)["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
         node(b)["scale"] = {1, 1, 1};
     },
     "nodes[0]", "a matrix and"},
    {"NodeRotationZero",
     [](GltfBuilder& b) {
         node(b)["rotation"] = {0, 0, 0, 0};
     },
     "nodes[0].rotation", "no rotation"},
    {"NodeScaleBeyondFloat",
     [](GltfBuilder& b) {
         node(b)["scale"] = {1e39, 1, 1};
     },
     "nodes[0].scale[0]", "not in"},
    {"NodeTransformOverflows",
     [](GltfBuilder& b) {
         node(b)["scale"] = {1e38, 1, 1};
         b.add("nodes", {{"children", {0}}, {"scale", {100, 1, 1}}});
     },
     "nodes[0]", "beyond"},
    {"SceneUnknown", [](GltfBuilder& b) { b.document["scene"] = 0; }, "scene", "scenes has 0"},
    {"SceneRootIsAChild",
     [](GltfBuilder& b) {
         b.add("nodes", {{"children", {0}}});
         b.add("scenes", {{"nodes", {0}}});
     },
     "scenes[0].nodes[0]", "a child of nodes[1]"},
    {"SceneRootTwice",
     [](GltfBuilder& b) {
         b.add("scenes", {{"nodes", {0, 0}}});
     },
     "scenes[0].nodes[1]", "twice"},
    // Cameras, lights
    {"CameraLensMissing",
     [](GltfBuilder& b) {
         b.add("cameras", {{"type", "perspective"}});
     },
     "cameras[0].perspective", "missing"},
    {"CameraFovZero",
     [](GltfBuilder& b) {
         b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 1}}}});
     },
     "cameras[0].perspective.yfov", "not in"},
    {"CameraFarBeforeNear",
     [](GltfBuilder& b) {
         b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 2}, {"zfar", 1}}}});
     },
     "cameras[0]", "zfar"},
    {"CameraFlat",
     [](GltfBuilder& b) {
         b.add("cameras",
               {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 0}, {"zfar", 1}}}});
     },
     "cameras[0].orthographic.ymag", "is 0"},
    {"LightTypeUnknown",
     [](GltfBuilder& b) {
         b.addLight({{"type", "area"}});
     },
     "lights[0].type", "area"},
    {"LightSpotMissing",
     [](GltfBuilder& b) {
         b.addLight({{"type", "spot"}});
     },
     "lights[0].spot", "missing"},
    {"LightNegative",
     [](GltfBuilder& b) {
         b.addLight({{"type", "point"}, {"intensity", -5}});
     },
     "lights[0].intensity", "-5"},
    {"LightColorShort",
     [](GltfBuilder& b) {
         b.addLight({{"type", "point"}, {"color", {1, 1}}});
     },
     "lights[0].color", "2 elements"},
    // Materials, textures, images
    {"BaseColorAboveOne",
     [](GltfBuilder& b) {
         b.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {2, 1, 1, 1}}}}});
     },
     "materials[0].pbrMetallicRoughness.baseColorFactor[0]", "is 2"},
    {"AlphaModeUnknown",
     [](GltfBuilder& b) {
         b.add("materials", {{"alphaMode", "GLASS"}});
     },
     "materials[0].alphaMode", "GLASS"},
    {"TextureUnknown",
     [](GltfBuilder& b) {
         b.add("materials", {{"normalTexture", {{"index", 0}}}});
     },
     "materials[0].normalTexture.index", "textures has 0"},
    {"TextureImageUnknown",
     [](GltfBuilder& b) {
         b.add("textures", {{"source", 5}});
     },
     "textures[0].source", "5"},
    {"TextureSamplerUnknown",
     [](GltfBuilder& b) {
         b.add("textures", {{"sampler", 5}});
     },
     "textures[0].sampler", "5"},
    {"SamplerWrapUnknown",
     [](GltfBuilder& b) {
         b.add("samplers", {{"wrapS", 1}});
     },
     "samplers[0].wrapS", "is 1"},
    {"ImageOfTwoSources",
     [](GltfBuilder& b) {
         b.add("images", {{"uri", "a.png"}, {"bufferView", 0}});
     },
     "images[0]", "either"},
    {"ImageWidthZero", [](GltfBuilder& b) { withTexture(b, pngOfSize(0, 2)); }, "images[0]", "0 x 2"},
    {"ImageHuge", [](GltfBuilder& b) { withTexture(b, pngOfSize(0xffffffffu, 0xffffffffu)); }, "images[0]",
     "4294967295 x 4294967295"},
    {"ImageLarge", [](GltfBuilder& b) { withTexture(b, pngOfSize(16384, 16385)); }, "images[0]", "16384 x 16385"},
    {"ImageBroken",
     [](GltfBuilder& b) {
         ByteVector png = pngRgba8();
         png[45] ^= 0xffu;
         withTexture(b, png);
     },
     "images[0]", "cannot be decoded"},
    {"ImageTruncated",
     [](GltfBuilder& b) {
         ByteVector png = pngRgba8();
         png.resize(50);
         withTexture(b, png);
     },
     "images[0]", "cannot be decoded"},
    {"ImageIsWebP",
     [](GltfBuilder& b) {
         withTexture(b, {'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P'});
     },
     "images[0]", "WebP"},
    {"ImageIsNothing", [](GltfBuilder& b) { withTexture(b, {1}); }, "images[0]", "unknown format"},
    {"ImageIsJpegWithoutFrame",
     [](GltfBuilder& b) {
         withTexture(b, {0xff, 0xd8, 0xff, 0xe0, 0xff, 0xff, 0, 0, 0, 0, 0, 0});
     },
     "images[0]", "broken"},
    {"ImageFileMissing",
     [](GltfBuilder& b) {
         withTexture(b, pngRgba8());
         b.document["images"][0] = {{"uri", "textures/stone.png"}};
     },
     "images[0]: \"textures/stone.png\"", "no such file"},
    // Extensions, versions, shapes
    {"RequiredDraco", [](GltfBuilder& b) { b.document["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     "extensionsRequired", "KHR_draco_mesh_compression"},
    {"RequiredMeshopt", [](GltfBuilder& b) { b.document["extensionsRequired"] = {"EXT_meshopt_compression"}; },
     "extensionsRequired", "EXT_meshopt_compression"},
    {"RequiredBasisu", [](GltfBuilder& b) { b.document["extensionsRequired"] = {"KHR_texture_basisu"}; },
     "extensionsRequired", "KHR_texture_basisu"},
    {"RequiredWebp", [](GltfBuilder& b) { b.document["extensionsRequired"] = {"EXT_texture_webp"}; },
     "extensionsRequired", "EXT_texture_webp"},
    {"RequiredUnknown", [](GltfBuilder& b) { b.document["extensionsRequired"] = {"ACME_new\nthing"}; },
     "extensionsRequired", "ACME_new?thing"},
    {"RequiredWrongType", [](GltfBuilder& b) { b.document["extensionsRequired"] = "KHR_draco_mesh_compression"; },
     "extensionsRequired", "string"},
    {"VersionOne", [](GltfBuilder& b) { b.document["asset"]["version"] = "1.0"; }, "asset.version", "1.0"},
    {"VersionMissing", [](GltfBuilder& b) { b.document.erase("asset"); }, "asset.version", "missing"},
    {"ArrayWrongType", [](GltfBuilder& b) { b.document["textures"] = Json::object(); }, "textures",
     "is an object, not an array"},
    {"NodeWrongType", [](GltfBuilder& b) { b.document["nodes"][0] = 5; }, "nodes[0]", "number"},
};

class SceneRefusal : public testing::TestWithParam<Spoiled> {};

TEST_P(SceneRefusal, InOneLineWithThePlace) {
    GltfBuilder builder = quadBuilder();
    GetParam().spoil(builder);
    const std::string message = refusalOf(builder);
    EXPECT_THAT(message, HasSubstr(GetParam().place));
    EXPECT_THAT(message, HasSubstr(GetParam().what));
}

INSTANTIATE_TEST_SUITE_P(Of, SceneRefusal, testing::ValuesIn(kSpoiled),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(SceneRefusalOfBombs, InstancesWithoutEnd) {
    // One mesh of 1000 parts, shown by 10000 nodes, is 10^7 instances.
    GltfBuilder many = quadBuilder();
    const Json part = primitive(many);
    for (int i = 1; i < 1000; ++i) many.document["meshes"][0]["primitives"].push_back(part);
    for (int i = 1; i < 10000; ++i) many.add("nodes", {{"mesh", 0}});
    EXPECT_THAT(refusalOf(many), HasSubstr("instances"));
}

}  // namespace
}  // namespace earthshine::raster::test
