#pragma once
// A scene that rays can meet: every triangle in the world, its materials, and Embree.
//
// Which side of a triangle is there:
//   Double-sided materials are there from both sides.
//   Single-sided ones are there for whoever looks at their front: for the camera and for rays that gather light, when
//   the ray comes from the front; for light, when the light comes from the front. So a wall that turns its back to the
//   camera does not hide the room and still keeps the sun out, as with a rasterizer that culls back faces in every
//   pass. Alpha masks cut holes, at the finest level of their texture.

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "raster/scene/scene.hpp"

namespace earthshine::trace {

/// Trace space is world space moved to the middle of the scene, so that floats are fine there wherever the scene is.
struct Ray {
    glm::vec3 origin{0.0f};
    glm::vec3 direction{0.0f, 0.0f, 1.0f};  ///< of any length; distances are in units of it
    float tNear = 0.0f;
    float tFar = std::numeric_limits<float>::infinity();
};

struct Hit {
    float t = 0.0f;
    std::uint32_t triangle = 0;
    float u = 0.0f, v = 0.0f;  ///< weights of the triangle's second and third corner
    glm::vec3 normal{0.0f};    ///< the triangle's own, towards its front, of any length
    bool isDoubleSided = false;

    bool isFound() const { return t < std::numeric_limits<float>::infinity(); }
};

/// A point of a surface in trace space, and what it is made of once that was asked for (TraceScene::shade).
struct Surface {
    glm::vec3 position{0.0f};
    glm::vec3 geometricNormal{0.0f};  ///< unit: the triangle's own, towards its front until it is turned
    float offset = 0.0f;              ///< m: a ray that starts this far above the triangle does not meet it again
    bool isDoubleSided = false;
    bool isTurned = false;
    glm::vec3 normal{0.0f};    ///< unit, interpolated and normal-mapped, on the same side; 0 if it has none
    glm::vec3 albedo{0.0f};    ///< [0; 1]
    glm::vec3 emission{0.0f};  ///< cd/m^2

    /// Turns a double-sided surface so that it faces `direction`. False if its back, which is not there, faces it.
    bool turnTowards(const glm::vec3& direction);

    /// Where a ray along `direction` starts: off the triangle, on the side that it leaves to.
    glm::vec3 leave(const glm::vec3& direction) const;
};

class TraceScene {
public:
    /// Places every instance and builds the acceleration structure. The scene must outlive this (its textures are
    /// borrowed). Throws Error if Embree fails, InputError for more triangles than it can number.
    explicit TraceScene(const raster::Scene& scene);
    ~TraceScene();
    TraceScene(const TraceScene&) = delete;
    TraceScene& operator=(const TraceScene&) = delete;

    /// The nearest surface that is there for whoever looks along the ray.
    bool closest(const Ray& ray, Hit& hit) const;

    /// Whether something keeps the light at the far end of the ray from its origin.
    bool blocksLight(const Ray& ray) const;

    /// The same for many rays at once, faster if neighbours in the list fly together. `hits` and `blocked` get a place
    /// for each ray; a ray that finds nothing has a hit at infinity.
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
    void blocksLight(std::span<const Ray> rays, std::span<bool> blocked) const;

    /// Everything along the ray, whichever side it shows, in no order. Masked-out points are not there.
    void allHits(const Ray& ray, std::vector<Hit>& hits) const;

    /// Where a hit is: the surface without what it is made of; not turned.
    Surface surface(const Ray& ray, const Hit& hit) const;

    /// Fills in normal, albedo and emission of the surface at a hit, with textures at their finest level. Textures are
    /// slow: ask when it matters.
    void shade(const Hit& hit, Surface& surface) const;

    /// The same with mipmaps, for a pixel whose right and lower neighbours look along the rays `right` and `below`.
    void shade(const Hit& hit, const Ray& right, const Ray& below, Surface& surface) const;

    /// World space = trace space + this.
    const glm::dvec3& originWs() const;

    struct Impl;

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace earthshine::trace
