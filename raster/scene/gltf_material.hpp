#pragma once
// Materials and the textures they name.

#include <map>
#include <tuple>

#include "raster/scene/gltf_context.hpp"

namespace earthshine::raster {

/// Makes the materials of a scene as primitives ask for them, with the textures they need.
class GltfMaterials {
public:
    explicit GltfMaterials(const GltfContext& context) : context_(context) {}

    /// The index in Scene::materials of materials[material]; -1 (none) is a white diffuse one. Throws InputError if an
    /// image cannot be loaded.
    int materialOf(int material);

private:
    /// An image read in one way is one texture: image, sampler settings, sRGB or not.
    using TextureKey = std::tuple<int, Wrap, Wrap, bool, bool, bool>;

    Material convert(const tinygltf::Material& from, const std::string& place);
    TextureRef textureRef(int texture, int texCoord, const tinygltf::ExtensionMap& extensions, bool isSrgb,
                          const std::string& place);
    TextureRef textureRef(const tinygltf::TextureInfo& info, bool isSrgb, const std::string& place) {
        return textureRef(info.index, info.texCoord, info.extensions, isSrgb, place);
    }
    void applySpecularGlossiness(const tinygltf::Value& extension, Material& material, const std::string& place);
    int textureOf(const TextureKey& key);

    const GltfContext& context_;
    std::map<int, int> materials_;
    std::map<TextureKey, int> textures_;
    std::size_t textureBytes_ = 0;
};

}  // namespace earthshine::raster
