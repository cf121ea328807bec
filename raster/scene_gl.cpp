#include "raster/scene_gl.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <tuple>

#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>

#include "earthshine/error.hpp"
#include "parallel.hpp"
#include "raster/scene/mipmaps.hpp"

namespace earthshine::raster {

namespace {

constexpr const char* kBlocks[] = {"InstanceBlock", "MaterialBlock"};
constexpr GLuint kInstanceBinding = 0;
constexpr GLuint kMaterialBinding = 1;
constexpr const char* kSamplers[] = {"baseColorTexture", "metallicTexture", "normalTexture", "emissionTexture"};

// As in scene.vert and material.glsl, std140.
struct InstanceBlock {
    glm::mat4 viewFromObject;
    glm::mat4 previousViewFromObject;
    glm::mat4 normalWsFromObject;
    glm::mat4 worldFromObject;
};
static_assert(sizeof(InstanceBlock) == 256);

struct MaterialBlock {
    glm::vec4 baseColor;
    glm::vec4 emission;
    float metallic;
    float normalScale;
    float alphaCutoff;
    float padding;
    glm::ivec4 texCoords;
    glm::vec4 uvFromUv[4][3];
};
static_assert(sizeof(MaterialBlock) == 256);

GLsizeiptr alignedSize(std::size_t size, GLsizeiptr alignment) {
    return (GLsizeiptr(size) + alignment - 1) / alignment * alignment;
}

float linearFromSrgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

std::vector<std::uint16_t> linearHalfFromSrgb16(const std::vector<std::uint16_t>& texels) {
    std::vector<std::uint16_t> result(texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const float value = float(texels[i]) / 65535.0f;
        result[i] = halfFromFloat(i % 4 == 3 ? value : linearFromSrgb(value));
    }
    return result;
}

/// GL takes offsets into bound buffers as pointers.
const void* bufferOffset(std::size_t bytes) {
    return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

GLint wrapMode(Wrap wrap) {
    switch (wrap) {
        case Wrap::Repeat:
            return GL_REPEAT;
        case Wrap::MirroredRepeat:
            return GL_MIRRORED_REPEAT;
        case Wrap::ClampToEdge:
            return GL_CLAMP_TO_EDGE;
    }
    return GL_REPEAT;
}

bool mirrors(const glm::mat4& worldFromObject) {
    return glm::determinant(glm::dmat3(worldFromObject)) < 0.0;
}

}  // namespace

ScenePrograms::ScenePrograms(GlContext& context, const std::string& fragmentFile)
    : opaque(context, {"scene.vert", fragmentFile, {}, kBlocks, kSamplers}),
      masked(context, {"scene.vert", fragmentFile, {"ALPHA_MASK"}, kBlocks, kSamplers}) {}

glm::mat4 upsideDown(const glm::mat4& clipFromView) {
    glm::mat4 result = clipFromView;
    for (int column = 0; column < 4; ++column) result[column][1] = -result[column][1];
    return result;
}

SceneGl::SceneGl(GlContext& context, const Scene& scene) : context_(&context), gl_(&context.gl()) {
    context.makeCurrent();
    GLint alignment = 0;
    gl_->GetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    blockAlignment_ = std::max(alignment, 1);
    for (const Instance& instance : scene.instances)
        instances_.push_back({instance.mesh, instance.worldFromObject, instance.worldFromObject});
    uploadGeometry(scene);
    uploadTextures(scene);
    uploadMaterials(scene);
    orderDraws();
    instanceBuffer_ = makeBuffer(*gl_);
    context.check("scene: upload");
}

void SceneGl::uploadGeometry(const Scene& scene) {
    const GlFunctions& gl = *gl_;
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    for (const Mesh& mesh : scene.meshes) {
        meshes_.push_back({GLsizei(mesh.indices.size()), indices.size() * sizeof(std::uint32_t), GLint(vertices.size()),
                           mesh.material});
        vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
        indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    }
    vertexArray_ = makeVertexArray(gl);
    vertexBuffer_ = makeBuffer(gl);
    indexBuffer_ = makeBuffer(gl);
    gl.BindVertexArray(vertexArray_.name());
    gl.BindBuffer(GL_ARRAY_BUFFER, vertexBuffer_.name());
    gl.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size() * sizeof(Vertex)), vertices.data(), GL_STATIC_DRAW);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer_.name());
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices.size() * sizeof(std::uint32_t)), indices.data(),
                  GL_STATIC_DRAW);
    GLuint attribute = 0;
    const auto addAttribute = [&](GLint channels, std::size_t offset) {
        gl.EnableVertexAttribArray(attribute);
        gl.VertexAttribPointer(attribute, channels, GL_FLOAT, GL_FALSE, sizeof(Vertex), bufferOffset(offset));
        ++attribute;
    };
    addAttribute(3, offsetof(Vertex, position));
    addAttribute(3, offsetof(Vertex, normal));
    addAttribute(4, offsetof(Vertex, tangent));
    addAttribute(2, offsetof(Vertex, uv0));
    addAttribute(2, offsetof(Vertex, uv1));
    addAttribute(4, offsetof(Vertex, color));
}

void SceneGl::uploadTextures(const Scene& scene) {
    const GlFunctions& gl = *gl_;
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    std::vector<std::vector<MipLevel>> mipLevels(scene.textures.size());
    parallelFor(int(mipLevels.size()), 0, [&](int i) {
        const Texture& texture = scene.textures[std::size_t(i)];
        if (texture.mipmaps) mipLevels[std::size_t(i)] = smallerLevels(texture);
    });
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const Texture& texture = scene.textures[i];
        const int most = context_->description().maxTextureSizePx;
        if (texture.widthPx > most || texture.heightPx > most)
            throw InputError(fmt::format(
                "{}: texture \"{}\": {}x{} is larger than the {} texels a side that \"{}\" "
                "allows: make it smaller",
                scene.name, texture.name, texture.widthPx, texture.heightPx, most, context_->description().renderer));
        textures_.push_back(makeTexture(gl));
        gl.BindTexture(GL_TEXTURE_2D, textures_.back().name());
        const auto upload = [&](GLint level, const auto& from) {
            const auto put = [&](GLint internalFormat, GLenum type, const void* texels) {
                gl.TexImage2D(GL_TEXTURE_2D, level, internalFormat, from.widthPx, from.heightPx, 0, GL_RGBA, type,
                              texels);
            };
            if (from.rgba16.empty())
                put(texture.isSrgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, GL_UNSIGNED_BYTE, from.rgba8.data());
            else if (texture.isSrgb)
                put(GL_RGBA16F, GL_HALF_FLOAT, linearHalfFromSrgb16(from.rgba16).data());
            else
                put(GL_RGBA16, GL_UNSIGNED_SHORT, from.rgba16.data());
        };
        upload(0, texture);
        GLint level = 0;
        for (const MipLevel& smaller : mipLevels[i]) upload(++level, smaller);
        mipLevels[i].clear();

        const GLint nearest = texture.mipmaps ? GL_NEAREST_MIPMAP_LINEAR : GL_NEAREST;
        const GLint linear = texture.mipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR;
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, texture.linearFilter ? linear : nearest);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, texture.linearFilter ? GL_LINEAR : GL_NEAREST);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrapMode(texture.wrapU));
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrapMode(texture.wrapV));
        context_->check(fmt::format("{}: texture \"{}\"", scene.name, texture.name));
    }
}

void SceneGl::uploadMaterials(const Scene& scene) {
    const GLsizeiptr stride = alignedSize(sizeof(MaterialBlock), blockAlignment_);
    std::vector<std::byte> blocks(std::size_t(stride) * scene.materials.size());
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        MaterialBlock block{material.baseColor,   glm::vec4(material.emission, 0.0f),
                            material.metallic,    material.normalScale,
                            material.alphaCutoff, 0.0f,
                            glm::ivec4(-1),       {}};
        MaterialDraw draw{{}, material.alphaMode == AlphaMode::Mask, material.doubleSided};
        const TextureRef* refs[] = {&material.baseColorTexture, &material.metallicTexture, &material.normalTexture,
                                    &material.emissionTexture};
        for (int slot = 0; slot < 4; ++slot) {
            const TextureRef& ref = *refs[slot];
            if (ref.texture < 0) continue;
            draw.textures[slot] = textures_[std::size_t(ref.texture)].name();
            block.texCoords[slot] = ref.texCoord;
            for (int column = 0; column < 3; ++column)
                block.uvFromUv[slot][column] = glm::vec4(ref.uvFromUv[column], 0.0f);
        }
        std::memcpy(blocks.data() + std::size_t(stride) * i, &block, sizeof(block));
        materials_.push_back(draw);
    }
    materialBuffer_ = makeBuffer(*gl_);
    gl_->BindBuffer(GL_UNIFORM_BUFFER, materialBuffer_.name());
    gl_->BufferData(GL_UNIFORM_BUFFER, GLsizeiptr(blocks.size()), blocks.data(), GL_STATIC_DRAW);
}

void SceneGl::orderDraws() {
    drawOrder_.resize(instances_.size());
    std::iota(drawOrder_.begin(), drawOrder_.end(), 0);
    const auto key = [this](int instance) {
        const int mesh = instances_[std::size_t(instance)].mesh;
        const int material = meshes_[std::size_t(mesh)].material;
        return std::tuple(materials_[std::size_t(material)].isMasked, material, mesh);
    };
    std::stable_sort(drawOrder_.begin(), drawOrder_.end(), [&](int a, int b) { return key(a) < key(b); });
}

void SceneGl::setWorldFromObject(int instance, const glm::mat4& worldFromObject) {
    if (instance < 0 || std::size_t(instance) >= instances_.size())
        throw UsageError(fmt::format("instance {} does not exist: the scene has {}", instance, instances_.size()));
    instances_[std::size_t(instance)].worldFromObject = worldFromObject;
}

void SceneGl::endFrame() {
    for (Placement& instance : instances_) instance.previousWorldFromObject = instance.worldFromObject;
}

void SceneGl::uploadInstances(const glm::mat4& viewFromWorld, const glm::mat4& previousViewFromWorld) const {
    const auto stride = std::size_t(alignedSize(sizeof(InstanceBlock), blockAlignment_));
    instanceBlocks_.resize(stride * instances_.size());
    const glm::dmat4 view(viewFromWorld);
    const glm::dmat4 previousView(previousViewFromWorld);
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        const Placement& instance = instances_[i];
        const glm::dmat3 worldFromObject(instance.worldFromObject);
        const double mirror = mirrors(instance.worldFromObject) ? -1.0 : 1.0;
        // The cofactors are the inverse transpose times the determinant: they exist for flattened instances, too.
        const glm::dmat3 cofactors(glm::cross(worldFromObject[1], worldFromObject[2]),
                                   glm::cross(worldFromObject[2], worldFromObject[0]),
                                   glm::cross(worldFromObject[0], worldFromObject[1]));
        InstanceBlock block{glm::mat4(view * glm::dmat4(instance.worldFromObject)),
                            glm::mat4(previousView * glm::dmat4(instance.previousWorldFromObject)),
                            glm::mat4(glm::mat3(mirror * cofactors)), glm::mat4(glm::mat3(worldFromObject))};
        block.normalWsFromObject[3][3] = float(mirror);
        std::memcpy(instanceBlocks_.data() + stride * i, &block, sizeof(block));
    }
    gl_->BindBuffer(GL_UNIFORM_BUFFER, instanceBuffer_.name());
    gl_->BufferData(GL_UNIFORM_BUFFER, GLsizeiptr(instanceBlocks_.size()), instanceBlocks_.data(), GL_STREAM_DRAW);
}

void SceneGl::bindMaterial(int material) const {
    const GlFunctions& gl = *gl_;
    const MaterialDraw& draw = materials_[std::size_t(material)];
    gl.BindBufferRange(GL_UNIFORM_BUFFER, kMaterialBinding, materialBuffer_.name(),
                       alignedSize(sizeof(MaterialBlock), blockAlignment_) * material, sizeof(MaterialBlock));
    for (GLuint slot = 0; slot < 4; ++slot) {
        gl.ActiveTexture(GL_TEXTURE0 + slot);
        gl.BindTexture(GL_TEXTURE_2D, draw.textures[slot]);
    }
    gl.ActiveTexture(GL_TEXTURE0);
    if (draw.doubleSided)
        gl.Disable(GL_CULL_FACE);
    else
        gl.Enable(GL_CULL_FACE);
}

void SceneGl::draw(const ScenePrograms& programs, const glm::mat4& viewFromWorld,
                   const glm::mat4& previousViewFromWorld) const {
    if (instances_.empty()) return;
    const GlFunctions& gl = *gl_;
    uploadInstances(viewFromWorld, previousViewFromWorld);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthMask(GL_TRUE);
    gl.DepthFunc(GL_LESS);
    gl.CullFace(GL_BACK);
    gl.BindVertexArray(vertexArray_.name());
    const GLsizeiptr stride = alignedSize(sizeof(InstanceBlock), blockAlignment_);
    int boundMaterial = -1;
    const ShaderProgram* boundProgram = nullptr;
    for (const int index : drawOrder_) {
        const Placement& instance = instances_[std::size_t(index)];
        const MeshRange& mesh = meshes_[std::size_t(instance.mesh)];
        const ShaderProgram& program =
            materials_[std::size_t(mesh.material)].isMasked ? programs.masked : programs.opaque;
        if (boundProgram != &program) program.use();
        boundProgram = &program;
        if (boundMaterial != mesh.material) bindMaterial(mesh.material);
        boundMaterial = mesh.material;
        // Counter-clockwise is the front; a mirroring placement turns that round, and so does drawing upside down.
        gl.FrontFace(mirrors(instance.worldFromObject) ? GL_CCW : GL_CW);
        gl.BindBufferRange(GL_UNIFORM_BUFFER, kInstanceBinding, instanceBuffer_.name(), stride * index,
                           sizeof(InstanceBlock));
        gl.DrawElementsBaseVertex(GL_TRIANGLES, mesh.indexCount, GL_UNSIGNED_INT, bufferOffset(mesh.firstIndexByte),
                                  mesh.firstVertex);
    }
}

}  // namespace earthshine::raster
