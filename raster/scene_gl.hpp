#pragma once
// A scene as GL knows it, and how every pass draws it.

#include <vector>

#include "earthshine/frame.hpp"
#include "raster/gl/shader_program.hpp"
#include "raster/scene/scene.hpp"

namespace earthshine::raster {

/// One pass's programs: scene.vert with a fragment shader of its own that includes material.glsl. Opaque materials have
/// a program without `discard`, so that the hardware may test depth early.
struct ScenePrograms {
    ShaderProgram opaque;
    ShaderProgram masked;

    ScenePrograms(GlContext& context, const std::string& fragmentFile);

    /// Sets a uniform of both.
    template <typename Value>
    void set(const char* name, const Value& value) const {
        for (const ShaderProgram* program : {&opaque, &masked}) {
            program->use();
            program->set(name, value);
        }
    }
};

/// The projection of a pass: y negated, so that row 0 of the texture is the top of the picture.
glm::mat4 upsideDown(const glm::mat4& clipFromView);

/// Buffers, textures and materials of a scene, uploaded at construction; the scene itself is no longer needed then.
/// Textures: sRGB 8 bit as GL_SRGB8_ALPHA8, linear 8 bit as GL_RGBA8, linear 16 bit as GL_RGBA16 (all bits kept), sRGB
/// 16 bit as linear GL_RGBA16F (GL has no such sRGB format). Mipmaps where the texture asks for them.
class SceneGl {
public:
    /// Throws InputError for a texture larger than the context allows, DeviceError if GL refuses something.
    SceneGl(GlContext& context, const Scene& scene);

    /// Moves an instance, from the next frame drawn on. Throws UsageError if there is no such instance.
    void setWorldFromObject(int instance, const glm::mat4& worldFromObject);

    /// Draws everything into the render target and the viewport that are bound, with clipFromView as the programs have
    /// it. Culls back faces of materials that are not double-sided. Where an instance was comes from the last endFrame.
    void draw(const ScenePrograms& programs, const glm::mat4& viewFromWorld,
              const glm::mat4& previousViewFromWorld) const;

    /// The frame is done: where instances are now is where they were.
    void endFrame();

private:
    struct MeshRange {
        GLsizei indexCount;
        std::size_t firstIndexByte;
        GLint firstVertex;
        int material;
    };
    struct Placement {
        int mesh;
        glm::mat4 worldFromObject;
        glm::mat4 previousWorldFromObject;
    };
    struct MaterialDraw {
        GLuint textures[4];  ///< base colour, metallic, normal, emission; 0 = none
        bool isMasked;
        bool doubleSided;
    };

    void uploadGeometry(const Scene& scene);
    void uploadTextures(const Scene& scene);
    void uploadMaterials(const Scene& scene);
    void orderDraws();
    void uploadInstances(const glm::mat4& viewFromWorld, const glm::mat4& previousViewFromWorld) const;
    void bindMaterial(int material) const;

    GlContext* context_;
    const GlFunctions* gl_;
    GLsizeiptr blockAlignment_ = 256;
    std::vector<MeshRange> meshes_;
    std::vector<Placement> instances_;
    std::vector<MaterialDraw> materials_;
    std::vector<int> drawOrder_;  ///< instances, such that state changes seldom
    std::vector<TextureObject> textures_;
    VertexArrayObject vertexArray_;
    BufferObject vertexBuffer_;
    BufferObject indexBuffer_;
    BufferObject materialBuffer_;
    BufferObject instanceBuffer_;
    mutable std::vector<std::byte> instanceBlocks_;  ///< what goes to instanceBuffer_; kept for its memory
};

}  // namespace earthshine::raster
