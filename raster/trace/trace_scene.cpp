#include "raster/trace/trace_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <glm/glm.hpp>

#include "earthshine/error.hpp"
#include "raster/trace/sampled_texture.hpp"

namespace earthshine::trace {

namespace {

using raster::AlphaMode;
using raster::Material;
using raster::TextureRef;

// Where a ray meets a triangle is off by a few units in the last place of the largest coordinate that goes into it, and
// so may be where the next ray meets it again. 32 of them are 40 micrometres in a scene that reaches 10 m.
constexpr float kOffsetUlps = 32.0f;

/// What interpolates over a triangle, beside the position.
struct Attributes {
    glm::vec3 normal;
    glm::vec4 tangent;
    glm::vec2 uv[2];
    glm::vec4 color;
};

struct Triangle {
    std::uint32_t corners[3];
    std::uint32_t material;
};

/// All that decides about a hole, in one place: asked far more often than anything else of a triangle.
struct Mask {
    glm::vec2 uv[3];  ///< of the texture
    float alpha[3];   ///< beside the texture's
    std::int32_t texture;
    float cutoff;
};

/// Triangles that Embree treats alike.
enum Kind { kPlain, kSingleSided, kMasked, kMaskedSingleSided, kKinds };

constexpr bool isMasked(int kind) {
    return kind == kMasked || kind == kMaskedSingleSided;
}

constexpr bool isSingleSided(int kind) {
    return kind == kSingleSided || kind == kMaskedSingleSided;
}

/// Whom a surface must be there for.
enum class Rule { Look, Light, Everything };

/// What the filters know of the query, beside the ray.
struct Context {
    RTCIntersectContext embree;
    Rule rule = Rule::Look;
    std::vector<Hit>* hits = nullptr;
};

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

glm::vec3 unitOr0(const glm::vec3& v) {
    const float length2 = glm::dot(v, v);
    return length2 > 1e-36f ? v / std::sqrt(length2) : glm::vec3(0.0f);
}

/// How a texture coordinate changes to the neighbouring pixels; absent away from the camera.
struct Footprint {
    float rightU, rightV, belowU, belowV;  ///< barycentric coordinates there
};

}  // namespace

struct TraceScene::Impl {
    std::vector<glm::vec3> positions;
    std::vector<Attributes> attributes;
    std::vector<Triangle> triangles;
    std::size_t firstOfKind[kKinds] = {};
    std::vector<Mask> masks;  ///< of the triangles from firstOfKind[kMasked] on
    std::vector<Material> materials;
    std::vector<SampledTexture> textures;
    glm::dvec3 originWs{0.0};
    float offset = 0.0f;
    bool hasStreams = false;  ///< Embree takes many rays at once; it can be built without
    std::unique_ptr<RTCDeviceTy, Release> device;
    std::unique_ptr<RTCSceneTy, Release> scene;

    void place(const raster::Scene& from);
    void makeMasks();
    bool isHole(std::uint32_t primitive, int kind, float u, float v) const;
    void build();
    void addGeometry(Kind kind, std::size_t count);

    template <class T>
    static T mixed(const T& a, const T& b, const T& c, float u, float v) {
        return (1.0f - u - v) * a + u * b + v * c;
    }
    glm::vec4 read(const TextureRef& ref, const Triangle& triangle, float u, float v, const Footprint* footprint) const;
    glm::vec4 color(const Triangle& triangle, float u, float v, const Footprint* footprint) const;
    glm::vec3 mappedNormal(const Triangle& triangle, float u, float v, const Footprint* footprint) const;
    void shade(const Hit& hit, const Footprint* footprint, Surface& surface) const;
    void neighbour(const Triangle& triangle, const Ray& ray, float& u, float& v) const;

    Hit hitOf(const RTCRay& ray, const RTCHit& found, int kind) const {
        return {ray.tfar,
                std::uint32_t(firstOfKind[kind]) + found.primID,
                found.u,
                found.v,
                {found.Ng_x, found.Ng_y, found.Ng_z},
                !isSingleSided(kind)};
    }
    template <Kind kKind>
    static void filter(const RTCFilterFunctionNArguments* arguments);
};

void TraceScene::Impl::place(const raster::Scene& from) {
    originWs = 0.5 * (glm::dvec3(from.boundsMin) + glm::dvec3(from.boundsMax));
    materials = from.materials;
    textures.reserve(from.textures.size());
    for (const raster::Texture& texture : from.textures) textures.emplace_back(texture);
    if (from.triangleCount() > std::numeric_limits<std::uint32_t>::max() / 4)
        throw InputError(
            fmt::format("{}: {} triangles are more than the ray tracer can number", from.name, from.triangleCount()));

    std::vector<Triangle> byKind[kKinds];
    for (const raster::Instance& instance : from.instances) {
        const raster::Mesh& mesh = from.meshes[std::size_t(instance.mesh)];
        const Material& material = materials[std::size_t(mesh.material)];
        const glm::dmat3 linear(instance.worldFromObject);
        const glm::dvec3 shift = glm::dvec3(instance.worldFromObject[3]) - originWs;
        const bool mirrors = glm::determinant(linear) < 0.0;
        const double sign = mirrors ? -1.0 : 1.0;
        // Normals transform by the cofactors, which exist for flattened instances, too (as in raster/scene_gl.cpp).
        const glm::mat3 normalMatrix(sign * glm::dmat3(glm::cross(linear[1], linear[2]),
                                                       glm::cross(linear[2], linear[0]),
                                                       glm::cross(linear[0], linear[1])));
        const auto first = std::uint32_t(positions.size());
        for (const raster::Vertex& vertex : mesh.vertices) {
            positions.emplace_back(linear * glm::dvec3(vertex.position) + shift);
            attributes.push_back(
                {unitOr0(normalMatrix * vertex.normal),
                 glm::vec4(unitOr0(glm::mat3(linear) * glm::vec3(vertex.tangent)), vertex.tangent.w * float(sign)),
                 {vertex.uv0, vertex.uv1},
                 vertex.color});
        }
        const bool masked = material.alphaMode == AlphaMode::Mask;
        const Kind kind =
            material.doubleSided ? (masked ? kMasked : kPlain) : (masked ? kMaskedSingleSided : kSingleSided);
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            Triangle triangle{{first + mesh.indices[i], first + mesh.indices[i + 1], first + mesh.indices[i + 2]},
                              std::uint32_t(mesh.material)};
            if (mirrors) std::swap(triangle.corners[1], triangle.corners[2]);  // counter-clockwise stays the front
            byKind[kind].push_back(triangle);
        }
    }
    for (int kind = 0; kind < kKinds; ++kind) {
        firstOfKind[kind] = triangles.size();
        triangles.insert(triangles.end(), byKind[kind].begin(), byKind[kind].end());
    }
    glm::vec3 largest(0.0f);
    for (const glm::vec3& position : positions) largest = glm::max(largest, glm::abs(position));
    offset = kOffsetUlps * std::numeric_limits<float>::epsilon() * std::max({largest.x, largest.y, largest.z});
    makeMasks();
    positions.emplace_back(0.0f);  // Embree reads 16 bytes at the last corner
}

void TraceScene::Impl::makeMasks() {
    for (std::size_t i = firstOfKind[kMasked]; i < triangles.size(); ++i) {
        const Triangle& triangle = triangles[i];
        const Material& material = materials[triangle.material];
        const TextureRef& ref = material.baseColorTexture;
        Mask mask{{}, {}, ref.texture, material.alphaCutoff};
        for (int c = 0; c < 3; ++c) {
            const Attributes& corner = attributes[triangle.corners[c]];
            mask.alpha[c] = material.baseColor.a * corner.color.a;
            if (ref.texture >= 0) mask.uv[c] = glm::vec2(ref.uvFromUv * glm::vec3(corner.uv[ref.texCoord], 1.0f));
        }
        masks.push_back(mask);
        if (ref.texture >= 0) textures[std::size_t(ref.texture)].prepareAlpha();
    }
}

bool TraceScene::Impl::isHole(std::uint32_t primitive, int kind, float u, float v) const {
    const Mask& mask = masks[firstOfKind[kind] - firstOfKind[kMasked] + primitive];
    float alpha = mixed(mask.alpha[0], mask.alpha[1], mask.alpha[2], u, v);
    if (mask.texture >= 0)
        alpha *= textures[std::size_t(mask.texture)].alpha(mixed(mask.uv[0], mask.uv[1], mask.uv[2], u, v));
    return alpha < mask.cutoff;
}

void TraceScene::Impl::addGeometry(Kind kind, std::size_t count) {
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                               sizeof(glm::vec3), positions.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(),
                               firstOfKind[kind] * sizeof(Triangle), sizeof(Triangle), count);
    rtcSetGeometryUserData(geometry, this);
    const RTCFilterFunctionN filters[] = {nullptr, filter<kSingleSided>, filter<kMasked>, filter<kMaskedSingleSided>};
    if (kind != kPlain) {  // which are there for everyone; allHits() brings a filter of its own
        rtcSetGeometryIntersectFilterFunction(geometry, filters[kind]);
        rtcSetGeometryOccludedFilterFunction(geometry, filters[kind]);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene.get(), geometry, unsigned(kind));
    rtcReleaseGeometry(geometry);
}

void TraceScene::Impl::build() {
    device.reset(rtcNewDevice(nullptr));
    if (!device) throw Error(fmt::format("Embree: no device (error {})", int(rtcGetDeviceError(nullptr))));
    hasStreams = rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED) != 0;
    scene.reset(rtcNewScene(device.get()));
    // Robust: no ray slips through a shared edge.
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    for (int kind = 0; kind < kKinds; ++kind) {
        const std::size_t end = kind + 1 < kKinds ? firstOfKind[kind + 1] : triangles.size();
        if (end > firstOfKind[kind]) addGeometry(Kind(kind), end - firstOfKind[kind]);
    }
    rtcCommitScene(scene.get());
    if (const RTCError error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
        throw Error(fmt::format("Embree: cannot build over {} triangles (error {})", triangles.size(), int(error)));
}

/// Embree asks of every hit that it is about to take, so this looks up no more than it must.
template <Kind kKind>
void TraceScene::Impl::filter(const RTCFilterFunctionNArguments* arguments) {
    const auto& context = *reinterpret_cast<const Context*>(arguments->context);
    const auto& impl = *static_cast<const Impl*>(arguments->geometryUserPtr);
    const unsigned count = arguments->N;
    for (unsigned i = 0; i < count; ++i) {
        if (arguments->valid[i] == 0) continue;
        bool isThere = true;
        if (isSingleSided(kKind) && context.rule != Rule::Everything) {
            // Below 0 the ray comes from the front. A ray of Rule::Light runs against the light.
            const float facing = RTCRayN_dir_x(arguments->ray, count, i) * RTCHitN_Ng_x(arguments->hit, count, i) +
                                 RTCRayN_dir_y(arguments->ray, count, i) * RTCHitN_Ng_y(arguments->hit, count, i) +
                                 RTCRayN_dir_z(arguments->ray, count, i) * RTCHitN_Ng_z(arguments->hit, count, i);
            isThere = context.rule == Rule::Look ? facing < 0.0f : facing > 0.0f;
        }
        if (isMasked(kKind) && isThere)
            isThere = !impl.isHole(RTCHitN_primID(arguments->hit, count, i), kKind, RTCHitN_u(arguments->hit, count, i),
                                   RTCHitN_v(arguments->hit, count, i));
        if (context.hits && isThere)  // only single rays ask for all hits
            context.hits->push_back(impl.hitOf(*reinterpret_cast<const RTCRay*>(arguments->ray),
                                               *reinterpret_cast<const RTCHit*>(arguments->hit), kKind));
        if (context.hits || !isThere) arguments->valid[i] = 0;  // look on
    }
}

glm::vec4 TraceScene::Impl::read(const TextureRef& ref, const Triangle& triangle, float u, float v,
                                 const Footprint* footprint) const {
    const auto uvAt = [&](float atU, float atV) {
        const auto corner = [&](int i) { return attributes[triangle.corners[i]].uv[ref.texCoord]; };
        return glm::vec2(ref.uvFromUv * glm::vec3(mixed(corner(0), corner(1), corner(2), atU, atV), 1.0f));
    };
    const SampledTexture& texture = textures[std::size_t(ref.texture)];
    const glm::vec2 uv = uvAt(u, v);
    if (!footprint) return texture.sample(uv);
    return texture.sample(uv, uvAt(footprint->rightU, footprint->rightV) - uv,
                          uvAt(footprint->belowU, footprint->belowV) - uv);
}

glm::vec4 TraceScene::Impl::color(const Triangle& triangle, float u, float v, const Footprint* footprint) const {
    const Material& material = materials[triangle.material];
    const auto corner = [&](int i) { return attributes[triangle.corners[i]].color; };
    glm::vec4 result = material.baseColor * mixed(corner(0), corner(1), corner(2), u, v);
    if (material.baseColorTexture.texture >= 0) result *= read(material.baseColorTexture, triangle, u, v, footprint);
    return result;
}

/// As surfaceNormalWs of raster/shaders/material.glsl, on the front side.
glm::vec3 TraceScene::Impl::mappedNormal(const Triangle& triangle, float u, float v, const Footprint* footprint) const {
    const Material& material = materials[triangle.material];
    const Attributes& a = attributes[triangle.corners[0]];
    const Attributes& b = attributes[triangle.corners[1]];
    const Attributes& c = attributes[triangle.corners[2]];
    const glm::vec3 normal = unitOr0(mixed(a.normal, b.normal, c.normal, u, v));
    if (material.normalTexture.texture < 0) return normal;
    const glm::vec4 tangentAndSign = mixed(a.tangent, b.tangent, c.tangent, u, v);
    const glm::vec3 along(tangentAndSign);
    const glm::vec3 tangent = unitOr0(along - normal * glm::dot(normal, along));
    const glm::vec3 bitangent = glm::cross(normal, tangent) * (tangentAndSign.w < 0.0f ? -1.0f : 1.0f);
    glm::vec3 mapped = 2.0f * glm::vec3(read(material.normalTexture, triangle, u, v, footprint)) - 1.0f;
    mapped.x *= material.normalScale;
    mapped.y *= material.normalScale;
    return unitOr0(mapped.x * tangent + mapped.y * bitangent + mapped.z * normal);
}

void TraceScene::Impl::shade(const Hit& hit, const Footprint* footprint, Surface& s) const {
    const Triangle& triangle = triangles[hit.triangle];
    const Material& material = materials[triangle.material];
    const glm::vec3 normal = mappedNormal(triangle, hit.u, hit.v, footprint);
    s.normal = s.isTurned ? -normal : normal;
    float metallic = material.metallic;
    if (material.metallicTexture.texture >= 0)
        metallic *= read(material.metallicTexture, triangle, hit.u, hit.v, footprint).b;
    s.albedo = glm::clamp(glm::vec3(color(triangle, hit.u, hit.v, footprint)) * (1.0f - metallic), 0.0f, 1.0f);
    s.emission = material.emission;
    if (material.emissionTexture.texture >= 0)
        s.emission *= glm::vec3(read(material.emissionTexture, triangle, hit.u, hit.v, footprint));
}

/// Barycentric coordinates of where a ray meets the triangle's plane; u and v stay as they are if it does not.
void TraceScene::Impl::neighbour(const Triangle& triangle, const Ray& ray, float& u, float& v) const {
    const glm::vec3& a = positions[triangle.corners[0]];
    const glm::vec3 ab = positions[triangle.corners[1]] - a, ac = positions[triangle.corners[2]] - a;
    const glm::vec3 p = glm::cross(ray.direction, ac);
    const float determinant = glm::dot(ab, p);
    if (determinant == 0.0f) return;
    const glm::vec3 s = ray.origin - a;
    u = glm::dot(s, p) / determinant;
    v = glm::dot(ray.direction, glm::cross(s, ab)) / determinant;
}

bool Surface::turnTowards(const glm::vec3& direction) {
    if (glm::dot(geometricNormal, direction) >= 0.0f) return true;
    geometricNormal = -geometricNormal;
    normal = -normal;
    isTurned = !isTurned;
    return isDoubleSided;
}

glm::vec3 Surface::leave(const glm::vec3& direction) const {
    return position + (glm::dot(geometricNormal, direction) < 0.0f ? -offset : offset) * geometricNormal;
}

namespace {

RTCRay embreeRay(const Ray& ray) {
    RTCRay result{};
    result.org_x = ray.origin.x, result.org_y = ray.origin.y, result.org_z = ray.origin.z;
    result.dir_x = ray.direction.x, result.dir_y = ray.direction.y, result.dir_z = ray.direction.z;
    result.tnear = ray.tNear;
    result.tfar = ray.tFar;
    result.mask = ~0u;
    return result;
}

Context contextFor(Rule rule) {
    Context context{};
    rtcInitIntersectContext(&context.embree);
    context.rule = rule;
    return context;
}

// Rays that are handed to Embree at once.
constexpr std::size_t kBatch = 64;

RTCRayHit nearest(RTCScene scene, Context& context, const Ray& ray) {
    RTCRayHit query{embreeRay(ray), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context.embree, &query);
    return query;
}

}  // namespace

TraceScene::TraceScene(const raster::Scene& scene) : impl_(std::make_unique<Impl>()) {
    impl_->place(scene);
    impl_->build();
}

TraceScene::~TraceScene() = default;

bool TraceScene::closest(const Ray& ray, Hit& hit) const {
    Context context = contextFor(Rule::Look);
    const RTCRayHit found = nearest(impl_->scene.get(), context, ray);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit = impl_->hitOf(found.ray, found.hit, int(found.hit.geomID));
    return true;
}

bool TraceScene::blocksLight(const Ray& ray) const {
    Context context = contextFor(Rule::Light);
    RTCRay query = embreeRay(ray);
    rtcOccluded1(impl_->scene.get(), &context.embree, &query);
    return query.tfar < 0.0f;
}

void TraceScene::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    Context context = contextFor(Rule::Look);
    RTCRayHit queries[kBatch];
    for (std::size_t first = 0; first < rays.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, rays.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            queries[i].ray = embreeRay(rays[first + i]);
            queries[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
            queries[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        }
        if (impl_->hasStreams)
            rtcIntersect1M(impl_->scene.get(), &context.embree, queries, unsigned(count), sizeof(RTCRayHit));
        else
            for (std::size_t i = 0; i < count; ++i) rtcIntersect1(impl_->scene.get(), &context.embree, &queries[i]);
        for (std::size_t i = 0; i < count; ++i) {
            const RTCHit& found = queries[i].hit;
            if (found.geomID == RTC_INVALID_GEOMETRY_ID)
                hits[first + i].t = std::numeric_limits<float>::infinity();
            else
                hits[first + i] = impl_->hitOf(queries[i].ray, found, int(found.geomID));
        }
    }
}

void TraceScene::blocksLight(std::span<const Ray> rays, std::span<bool> blocked) const {
    Context context = contextFor(Rule::Light);
    RTCRay queries[kBatch];
    for (std::size_t first = 0; first < rays.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, rays.size() - first);
        for (std::size_t i = 0; i < count; ++i) queries[i] = embreeRay(rays[first + i]);
        if (impl_->hasStreams)
            rtcOccluded1M(impl_->scene.get(), &context.embree, queries, unsigned(count), sizeof(RTCRay));
        else
            for (std::size_t i = 0; i < count; ++i) rtcOccluded1(impl_->scene.get(), &context.embree, &queries[i]);
        for (std::size_t i = 0; i < count; ++i) blocked[first + i] = queries[i].tfar < 0.0f;
    }
}

void TraceScene::allHits(const Ray& ray, std::vector<Hit>& hits) const {
    hits.clear();
    Context context = contextFor(Rule::Everything);
    context.hits = &hits;
    // Comes after the filter of a triangle's own kind, which lets nothing through here: it sees the plain ones alone.
    context.embree.filter = Impl::filter<kPlain>;
    nearest(impl_->scene.get(), context, ray);
}

Surface TraceScene::surface(const Ray& ray, const Hit& hit) const {
    Surface s;
    s.position = ray.origin + hit.t * ray.direction;
    s.geometricNormal = unitOr0(hit.normal);
    s.offset = impl_->offset;
    s.isDoubleSided = hit.isDoubleSided;
    return s;
}

void TraceScene::shade(const Hit& hit, Surface& surface) const {
    impl_->shade(hit, nullptr, surface);
}

void TraceScene::shade(const Hit& hit, const Ray& right, const Ray& below, Surface& surface) const {
    const Triangle& triangle = impl_->triangles[hit.triangle];
    Footprint footprint{hit.u, hit.v, hit.u, hit.v};
    impl_->neighbour(triangle, right, footprint.rightU, footprint.rightV);
    impl_->neighbour(triangle, below, footprint.belowU, footprint.belowV);
    impl_->shade(hit, &footprint, surface);
}

const glm::dvec3& TraceScene::originWs() const {
    return impl_->originWs;
}

}  // namespace earthshine::trace
