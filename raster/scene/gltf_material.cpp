#include "raster/scene/gltf_material.hpp"

#include <cmath>

#include <fmt/format.h>

#include "raster/scene/gltf_image.hpp"

namespace earthshine::raster {

namespace {

/// The member of an extension's object; a null value if there is no such object or member.
const tinygltf::Value& member(const tinygltf::Value& object, const char* name) {
    static const tinygltf::Value kNull;
    return object.IsObject() && object.Has(name) ? object.Get(name) : kNull;
}

const tinygltf::Value& extensionOf(const tinygltf::ExtensionMap& extensions, const char* name) {
    static const tinygltf::Value kNull;
    const auto found = extensions.find(name);
    return found == extensions.end() ? kNull : found->second;
}

float numberOr(const tinygltf::Value& value, float otherwise) {
    return value.IsNumber() ? float(value.GetNumberAsDouble()) : otherwise;
}

/// Element `i` of an array of numbers.
float elementOr(const tinygltf::Value& array, int i, float otherwise) {
    return array.IsArray() && std::size_t(i) < array.ArrayLen() ? numberOr(array.Get(i), otherwise) : otherwise;
}

/// KHR_texture_transform: T * R * S, where R turns counter-clockwise as the picture is seen. v points down, so the
/// signs of its sines are those of the Khronos sample viewer and of the test model TextureTransformTest, and not those
/// of the GLSL lines in the extension's text, which contradict the example beside them.
glm::mat3 textureTransform(const tinygltf::Value& extension) {
    const tinygltf::Value& offset = member(extension, "offset");
    const tinygltf::Value& scale = member(extension, "scale");
    const float angle = numberOr(member(extension, "rotation"), 0.0f);
    const float c = std::cos(angle), s = std::sin(angle);
    const float su = elementOr(scale, 0, 1.0f), sv = elementOr(scale, 1, 1.0f);
    return glm::mat3(glm::vec3(c * su, -s * su, 0.0f), glm::vec3(s * sv, c * sv, 0.0f),
                     glm::vec3(elementOr(offset, 0, 0.0f), elementOr(offset, 1, 0.0f), 1.0f));
}

Wrap wrapOf(int wrap) {
    return wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::ClampToEdge
           : wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::MirroredRepeat
                                                           : Wrap::Repeat;
}

}  // namespace

int GltfMaterials::materialOf(int material) {
    const auto [entry, isNew] = materials_.try_emplace(material, int(context_.scene.materials.size()));
    if (isNew && material >= 0) {
        const std::string place = fmt::format("materials[{}]", material);
        context_.scene.materials.push_back(convert(context_.model.materials[std::size_t(material)], place));
    } else if (isNew) {
        // glTF's default is a perfect metal, which has no diffuse colour to show.
        Material& standIn = context_.scene.materials.emplace_back();
        standIn.name = "default";
        standIn.metallic = 0.0f;
    }
    return entry->second;
}

Material GltfMaterials::convert(const tinygltf::Material& from, const std::string& place) {
    Material to;
    to.name = from.name;
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    for (int i = 0; i < 4; ++i) to.baseColor[i] = float(pbr.baseColorFactor[std::size_t(i)]);
    to.baseColorTexture = textureRef(pbr.baseColorTexture, true, place + ".baseColorTexture");
    to.metallic = float(pbr.metallicFactor);
    to.metallicTexture = textureRef(pbr.metallicRoughnessTexture, false, place + ".metallicRoughnessTexture");
    to.normalTexture = textureRef(from.normalTexture.index, from.normalTexture.texCoord, from.normalTexture.extensions,
                                  false, place + ".normalTexture");
    to.normalScale = float(from.normalTexture.scale);

    const tinygltf::Value& strength = extensionOf(from.extensions, "KHR_materials_emissive_strength");
    for (int i = 0; i < 3; ++i) {
        to.emission[i] =
            float(from.emissiveFactor[std::size_t(i)]) * numberOr(member(strength, "emissiveStrength"), 1.0f);
        if (!std::isfinite(to.emission[i]))
            context_.file.fail(place, "its emission is beyond what a 32-bit float holds");
    }
    to.emissionTexture = textureRef(from.emissiveTexture, true, place + ".emissiveTexture");

    to.alphaMode = from.alphaMode == "OPAQUE" ? AlphaMode::Opaque : AlphaMode::Mask;
    to.alphaCutoff = from.alphaMode == "MASK" ? float(from.alphaCutoff) : 0.5f;
    if (from.alphaMode == "BLEND") context_.note(place + ": BLEND is drawn as MASK with a cutoff of 0.5");
    to.doubleSided = from.doubleSided;

    const tinygltf::Value& glossiness = extensionOf(from.extensions, "KHR_materials_pbrSpecularGlossiness");
    if (glossiness.IsObject()) applySpecularGlossiness(glossiness, to, place);
    if (extensionOf(from.extensions, "KHR_materials_unlit").IsObject()) {
        context_.note(place + ": KHR_materials_unlit is drawn as a lit diffuse surface");
        to.metallic = 0.0f;
        to.metallicTexture = TextureRef();
    }
    if (to.metallic == 1.0f && to.metallicTexture.texture < 0) {
        context_.note(place + ": is all metal, which has no diffuse colour, and is drawn black");
    }
    return to;
}

void GltfMaterials::applySpecularGlossiness(const tinygltf::Value& extension, Material& material,
                                            const std::string& place) {
    context_.note(place + ": KHR_materials_pbrSpecularGlossiness is drawn with its diffuse colour alone");
    for (int i = 0; i < 4; ++i) material.baseColor[i] = elementOr(member(extension, "diffuseFactor"), i, 1.0f);
    const tinygltf::Value& texture = member(extension, "diffuseTexture");
    tinygltf::TextureInfo info;
    if (texture.IsObject()) info.index = member(texture, "index").GetNumberAsInt();
    info.texCoord = member(texture, "texCoord").GetNumberAsInt();
    const tinygltf::Value& transform = member(member(texture, "extensions"), "KHR_texture_transform");
    if (transform.IsObject()) info.extensions["KHR_texture_transform"] = transform;
    material.baseColorTexture = textureRef(info, true, place + ".diffuseTexture");
    material.metallic = 0.0f;
    material.metallicTexture = TextureRef();
}

TextureRef GltfMaterials::textureRef(int texture, int texCoord, const tinygltf::ExtensionMap& extensions, bool isSrgb,
                                     const std::string& place) {
    TextureRef ref;
    if (texture < 0) return ref;
    const tinygltf::Texture& of = context_.model.textures[std::size_t(texture)];
    if (of.source < 0) {
        context_.note(fmt::format("{}: textures[{}] has no source that is read, and is left out", place, texture));
        return ref;
    }
    const tinygltf::Value& transform = extensionOf(extensions, "KHR_texture_transform");
    if (transform.IsObject()) {
        ref.uvFromUv = textureTransform(transform);
        const tinygltf::Value& set = member(transform, "texCoord");
        if (set.IsInt()) texCoord = set.GetNumberAsInt();
    }
    if (texCoord > 1) {
        context_.note(fmt::format("{}: TEXCOORD_{} is not read; TEXCOORD_0 stands in", place, texCoord));
        texCoord = 0;
    }
    ref.texCoord = texCoord;

    const tinygltf::Sampler sampler =
        of.sampler < 0 ? tinygltf::Sampler() : context_.model.samplers[std::size_t(of.sampler)];
    const bool mipmaps =
        sampler.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST && sampler.minFilter != TINYGLTF_TEXTURE_FILTER_LINEAR;
    const bool linear = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
    ref.texture = textureOf({of.source, wrapOf(sampler.wrapS), wrapOf(sampler.wrapT), linear, mipmaps, isSrgb});
    return ref;
}

int GltfMaterials::textureOf(const TextureKey& key) {
    const auto found = textures_.find(key);
    if (found != textures_.end()) return found->second;
    const int image = std::get<0>(key);
    Texture texture = decodeImage(context_, image);
    std::tie(std::ignore, texture.wrapU, texture.wrapV, texture.linearFilter, texture.mipmaps, texture.isSrgb) = key;
    textureBytes_ += texture.rgba8.size() + 2 * texture.rgba16.size();
    if (textureBytes_ > gltf_limits::kTextureBytes) {
        context_.file.fail(
            fmt::format("images[{}]", image),
            fmt::format("the scene's textures together need more than {} B", gltf_limits::kTextureBytes));
    }
    context_.scene.textures.push_back(std::move(texture));
    return textures_[key] = int(context_.scene.textures.size()) - 1;
}

}  // namespace earthshine::raster
