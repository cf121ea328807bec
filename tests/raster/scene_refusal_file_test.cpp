// Files that are wrong before they are glTF, and paths that lead elsewhere.

#include <filesystem>

#include <gmock/gmock.h>

#include "earthshine/error.hpp"
#include "raster/scene_support.hpp"

namespace earthshine::raster::test {
namespace {

using testing::HasSubstr;

TEST(SceneRefusalOfText, NotJson) {
    for (const std::string text :
         {"", "{", "hello", "[1, 2]", "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [1e999]}", "\xff\xfe"}) {
        EXPECT_NE(refusalOf(ByteVector(text.begin(), text.end())), "") << text;
    }
}

TEST(SceneRefusalOfText, NestedTooDeep) {
    std::string text = R"({"asset": {"version": "2.0"}, "extras": )";
    for (int i = 0; i < 1000000; ++i) text += '[';
    EXPECT_THAT(refusalOf(ByteVector(text.begin(), text.end())), HasSubstr("nested"));
}

TEST(SceneRefusalOfFile, Missing) {
    const TempFolder folder;
    EXPECT_NE(refusalOf(ByteVector{}), "");
    EXPECT_THROW(loadGltf(folder.path() / "nowhere.gltf"), InputError);
    EXPECT_THROW(loadGltf(folder.path()), InputError);
}

TEST(SceneRefusalOfGlb, TruncatedAnywhere) {
    const ByteVector whole = quadBuilder().glb();
    for (std::size_t length = 0; length < whole.size(); length += length < 40 ? 1 : 37) {
        EXPECT_NE(refusalOf(ByteVector(whole.begin(), whole.begin() + std::ptrdiff_t(length))), "") << length;
    }
    EXPECT_EQ(refusalOf(whole), "");
}

TEST(SceneRefusalOfGlb, HeaderAndChunks) {
    const auto changed = [](std::size_t offset, unsigned char value) {
        ByteVector glb = quadBuilder().glb();
        glb.at(offset) = value;
        return refusalOf(glb);
    };
    EXPECT_THAT(changed(4, 1), HasSubstr("version 1"));
    EXPECT_THAT(changed(11, 0x7f), HasSubstr("the file holds"));
    EXPECT_THAT(changed(15, 0x7f), HasSubstr("chunk 0"));
    EXPECT_THAT(changed(16, 'X'), HasSubstr("chunk 0: is not JSON"));
}

/// A scene in a folder of its own whose buffer is at `uri`.
std::string refusalOfUri(const TempFolder& folder, const std::string& uri) {
    GltfBuilder builder = quadBuilder();
    builder.document["buffers"] = Json::array({Json{{"byteLength", builder.buffer.size()}, {"uri", uri}}});
    return refusalOf(folder.write("scene/quad.gltf", builder.gltf()));
}

TEST(SceneRefusalOfPaths, OutsideTheFolder) {
    const TempFolder folder;
    folder.write("x.bin", quadBuilder().buffer);
    folder.write("scene-of-another/x.bin", quadBuilder().buffer);
    folder.write("scene/x.bin", quadBuilder().buffer);
    EXPECT_EQ(refusalOfUri(folder, "x.bin"), "");
    EXPECT_EQ(refusalOfUri(folder, "./x.bin"), "");
    EXPECT_EQ(refusalOfUri(folder, "../scene/x.bin"), "");
    const std::string absolute = (folder.path() / "x.bin").string();
    for (const std::string& uri : {std::string("../x.bin"), std::string("../../x.bin"), std::string("%2e%2e/x.bin"),
                                   std::string("..%2fx.bin"), std::string("../scene-of-another/x.bin"), absolute}) {
        EXPECT_THAT(refusalOfUri(folder, uri), HasSubstr("buffers[0]: ")) << uri;
        EXPECT_THAT(refusalOfUri(folder, uri), HasSubstr("outside the scene's folder")) << uri;
    }
    EXPECT_THAT(refusalOfUri(folder, "file://" + absolute), HasSubstr("not a file beside the scene"));
    EXPECT_THAT(refusalOfUri(folder, "."), HasSubstr("is not a file"));
    EXPECT_NE(refusalOfUri(folder, ""), "");
    EXPECT_NE(refusalOfUri(folder, std::string(10000, 'x')), "");
    EXPECT_THAT(refusalOfUri(folder, std::string("x.bin\0y", 7)), HasSubstr("no file name"));
}

TEST(SceneRefusalOfPaths, LinksThatLeaveTheFolder) {
    const TempFolder folder;
    folder.write("secret.bin", quadBuilder().buffer);
    folder.write("scene/inside.bin", quadBuilder().buffer);
    std::filesystem::create_symlink(folder.path() / "secret.bin", folder.path() / "scene/link.bin");
    std::filesystem::create_directory_symlink(folder.path(), folder.path() / "scene/up");
    std::filesystem::create_symlink("inside.bin", folder.path() / "scene/alias.bin");
    std::filesystem::create_symlink("loop.bin", folder.path() / "scene/loop.bin");
    EXPECT_THAT(refusalOfUri(folder, "link.bin"), HasSubstr("outside the scene's folder"));
    EXPECT_THAT(refusalOfUri(folder, "up/secret.bin"), HasSubstr("outside the scene's folder"));
    EXPECT_EQ(refusalOfUri(folder, "alias.bin"), "");
    EXPECT_NE(refusalOfUri(folder, "loop.bin"), "");
}

TEST(SceneRefusalOfPaths, ImagesThatNothingUses) {
    GltfBuilder builder = quadBuilder();
    builder.add("images", {{"uri", "../../secret.png"}});
    EXPECT_THAT(refusalOf(builder), HasSubstr("images[0]: \"../../secret.png\": is outside the scene's folder"));
}

}  // namespace
}  // namespace earthshine::raster::test
