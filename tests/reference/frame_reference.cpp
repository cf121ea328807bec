#include "reference/frame_reference.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

namespace earthshine::reference {

namespace {

glm::dvec3 texel3(const HostImage& image, int x, int y) {
    const float* p = image.pixel(x, y);
    return {p[0], p[1], p[2]};
}

glm::dvec3 eyeOf(const Camera& camera) {
    return glm::dvec3(glm::inverse(glm::dmat4(camera.viewFromWorld))[3]);
}
glm::dvec3 backwardsOf(const Camera& camera) {
    return glm::dvec3(glm::inverse(glm::dmat4(camera.viewFromWorld))[2]);
}

std::uint32_t mix(std::uint32_t v) {
    v = (v ^ (v >> 16)) * 0x7feb352du;
    v = (v ^ (v >> 15)) * 0x846ca68bu;
    return v ^ (v >> 16);
}

// uv of a point in a camera's map; false if it is behind a perspective camera.
bool project(const Camera& camera, const glm::dvec3& position, glm::dvec2& uv) {
    const glm::dvec4 clip =
        glm::dmat4(camera.clipFromView) * (glm::dmat4(camera.viewFromWorld) * glm::dvec4(position, 1.0));
    if (clip.w <= 1e-6) return false;
    uv = {0.5 * (clip.x / clip.w + 1.0), 0.5 * (1.0 - clip.y / clip.w)};
    return true;
}

// Area of one texel across the ray at a distance along the axis: the area, or the solid angle times distance squared.
double texelAreaAcross(const Light& light, const glm::dvec3& position, double linearDepth, Extent extent) {
    const double w = 2.0 / double(light.camera.clipFromView[0][0]) / extent.widthPx;
    const double h = 2.0 / double(light.camera.clipFromView[1][1]) / extent.heightPx;
    if (light.type == LightType::Directional) return w * h;
    const double distance = glm::length(position - eyeOf(light.camera));
    const double cosine = linearDepth / distance;
    const double solidAngle = w * h * cosine * cosine * cosine;
    return solidAngle * distance * distance;
}

}  // namespace

glm::dvec3 unproject(const Camera& camera, glm::dvec2 uv, double linearDepth) {
    const glm::dmat4 viewFromClip = glm::inverse(glm::dmat4(camera.clipFromView));
    const glm::dmat4 worldFromView = glm::inverse(glm::dmat4(camera.viewFromWorld));
    // Two points of the texel's line, then the one at the depth asked for.
    const glm::dvec2 ndc(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y);
    glm::dvec4 a = viewFromClip * glm::dvec4(ndc, -0.9, 1.0), b = viewFromClip * glm::dvec4(ndc, 0.9, 1.0);
    a /= a.w;
    b /= b.w;
    const double t = (-linearDepth - a.z) / (b.z - a.z);
    return glm::dvec3(worldFromView * (a + t * (b - a)));
}

std::vector<SurfacePoint> surfacePoints(const Camera& camera, const ImageView& normalWs, const ImageView& depth) {
    const HostImage normals = toFloat(normalWs), depths = toFloat(depth);
    const Extent e = depth.extent;
    std::vector<SurfacePoint> points;
    for (int y = 0; y < e.heightPx; ++y) {
        for (int x = 0; x < e.widthPx; ++x) {
            SurfacePoint point;
            const double z = *depths.pixel(x, y);
            point.isValid = z > 0.0;
            if (point.isValid) {
                point.position = unproject(camera, {(x + 0.5) / e.widthPx, (y + 0.5) / e.heightPx}, z);
                point.normal = texel3(normals, x, y);
            }
            points.push_back(point);
        }
    }
    return points;
}

std::vector<Vpl> vpls(const Light& light, const LightMaps& maps) {
    const std::vector<SurfacePoint> points = surfacePoints(light.camera, maps.rsmNormalWs, maps.rsmDepth);
    const HostImage flux = toFloat(maps.rsmFlux), depth = toFloat(maps.rsmDepth);
    const Extent e = maps.rsmDepth.extent;
    std::vector<Vpl> result(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!points[i].isValid) continue;
        const int x = int(i) % e.widthPx, y = int(i) / e.widthPx;
        result[i].position = points[i].position;
        result[i].normal = points[i].normal;
        result[i].flux = glm::max(texel3(flux, x, y), glm::dvec3(0.0));
        const glm::dvec3 towards = light.type == LightType::Directional
                                       ? backwardsOf(light.camera)
                                       : glm::normalize(eyeOf(light.camera) - points[i].position);
        const double across = texelAreaAcross(light, points[i].position, *depth.pixel(x, y), e);
        result[i].radius = std::sqrt(across / std::numbers::pi / std::max(glm::dot(points[i].normal, towards), 0.05));
    }
    return result;
}

std::vector<Vpl> minified(const std::vector<Vpl>& texels, int size, int factor, int lightIndex, std::uint32_t seed) {
    const int blocks = (size + factor - 1) / factor;
    std::vector<Vpl> result(std::size_t(blocks) * std::size_t(blocks));
    for (int block = 0; block < blocks * blocks; ++block) {
        std::vector<const Vpl*> lit;
        std::vector<double> weights;
        double total = 0.0, area = 0.0;
        Vpl& out = result[std::size_t(block)];
        for (int y = block / blocks * factor; y < std::min(size, (block / blocks + 1) * factor); ++y) {
            for (int x = block % blocks * factor; x < std::min(size, (block % blocks + 1) * factor); ++x) {
                const Vpl& p = texels[std::size_t(y) * std::size_t(size) + std::size_t(x)];
                const double weight = p.flux.x + p.flux.y + p.flux.z;
                if (weight == 0.0) continue;
                lit.push_back(&p);
                weights.push_back(weight);
                total += weight;
                area += p.radius * p.radius;
                out.flux += p.flux;
            }
        }
        if (lit.empty()) continue;
        double left = (mix(std::uint32_t(lightIndex * blocks * blocks + block) + mix(seed)) >> 8) / 16777216.0 * total;
        std::size_t picked = 0;
        while (picked + 1 < lit.size() && left >= weights[picked]) left -= weights[picked++];
        out.position = lit[picked]->position;
        out.normal = lit[picked]->normal;
        out.radius = std::sqrt(area);
    }
    return result;
}

double texelGeometry(const SurfacePoint& x, const Vpl& p) {
    const glm::dvec3 d = p.position - x.position;
    const double d2 = glm::dot(d, d);
    const double cosines = std::max(glm::dot(x.normal, d), 0.0) * std::max(-glm::dot(p.normal, d), 0.0);
    return cosines == 0.0 ? 0.0 : cosines / (d2 * (d2 + p.radius * p.radius));
}

glm::dvec3 rsmSum(const SurfacePoint& x, const std::vector<Vpl>& texels) {
    glm::dvec3 sum(0.0);
    if (!x.isValid) return sum;
    for (const Vpl& p : texels) sum += p.flux * texelGeometry(x, p);
    return sum / std::numbers::pi;
}

PatternMove patternMove(int x, int y) {
    constexpr std::size_t kSize = 64;
    static const std::string file = [] {
        std::ifstream in(EARTHSHINE_DATA_DIR "/noise/blue_noise.pgm", std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    }();
    const auto rank = [&](std::size_t tile) {  // 16 bits, the high byte first, at the end of the file
        const std::size_t texel = (tile * kSize + std::size_t(y) % kSize) * kSize + std::size_t(x) % kSize;
        const auto* bytes =
            reinterpret_cast<const unsigned char*>(file.data()) + file.size() - 4 * kSize * kSize + 2 * texel;
        return 256.0 * bytes[0] + bytes[1];
    };
    const double turn = (rank(1) + 0.5) / (kSize * kSize);
    return {(rank(0) + turn) / (kSize * kSize), turn};
}

PatternMove tileMove(int x, int y, int sampleCount) {
    constexpr int kOrder[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    return {0.5 / sampleCount, (kOrder[y % 4][x % 4] + 0.5) / 16.0};
}

TileAverage tileAverage(const Camera& camera, Extent extent, const std::vector<SurfacePoint>& points,
                        const std::vector<glm::dvec3>& irradiance) {
    TileAverage result;
    result.irradiance.resize(points.size(), glm::dvec3(0.0));
    const glm::dmat4 viewFromWorld(camera.viewFromWorld);
    for (int y = 0; y < extent.heightPx; ++y) {
        for (int x = 0; x < extent.widthPx; ++x) {
            const auto at = std::size_t(y * extent.widthPx + x);
            const SurfacePoint& p = points[at];
            if (!p.isValid) continue;
            const double depth = -(viewFromWorld * glm::dvec4(p.position, 1.0)).z;
            const auto onPlaneOfView = [&](double px) { return unproject(camera, {px / extent.widthPx, 0.5}, depth); };
            const double pixelM = glm::length(onPlaneOfView(1.0) - onPlaneOfView(0.0));
            double count = 1.0;
            glm::dvec3 sum = irradiance[at];
            for (int ty = std::max(y - 1, 0); ty <= std::min(y + 2, extent.heightPx - 1); ++ty) {
                for (int tx = std::max(x - 1, 0); tx <= std::min(x + 2, extent.widthPx - 1); ++tx) {
                    const auto tap = std::size_t(ty * extent.widthPx + tx);
                    const SurfacePoint& q = points[tap];
                    if (tap == at || !q.isValid) continue;
                    const double reach = 0.5 * pixelM * std::hypot(tx - x, ty - y);
                    const double plane = std::fabs(glm::dot(p.normal, q.position - p.position)) / reach;
                    const double margin = std::min(glm::dot(p.normal, q.normal) - 0.9, 1.0 - plane);
                    result.clearance = std::min(result.clearance, std::fabs(margin));
                    ++result.taps;
                    if (margin < 0.0) continue;
                    ++result.accepted;
                    count += 1.0;
                    sum += irradiance[tap];
                }
            }
            result.irradiance[at] = sum / count;
        }
    }
    return result;
}

PatternMove frameMove(int index, int sampleCount) {
    // R2: with g the root of g^3 = g + 1, (index / g, index / g^2) modulo 1.
    double g = 1.0;
    for (int i = 0; i < 60; ++i) g = std::cbrt(1.0 + g);
    return {std::fmod(index / g, 1.0) / sampleCount, std::fmod(index / (g * g), 1.0)};
}

std::vector<glm::dvec3> rsmCoherent(const std::vector<SurfacePoint>& points, Extent extent,
                                    const std::vector<Vpl>& texels, const Light& light, int size, int count,
                                    double radiusUv, int frameIndex, double mapScale, DiskShape shape) {
    std::vector<glm::dvec3> result(points.size(), glm::dvec3(0.0));
    const PatternMove step = frameMove(frameIndex, count);
    const int setsInRow = (extent.widthPx + 63) / 64 * 4;
    for (int set = 0; set < setsInRow * extent.heightPx; ++set) {
        const int column = set % setsInRow, y = set / setsInRow;
        // The set's pixels, and their disks' centres; sky has that of the pixel before it, at the start of the one
        // after.
        std::vector<std::size_t> pixels;
        std::vector<glm::dvec2> centres;
        std::size_t missing = 0;
        for (int i = 0; i < 16; ++i) {
            const int x = column / 4 * 64 + column % 4 + 4 * i;
            const auto at = std::size_t(y * extent.widthPx + x);
            if (x < extent.widthPx && points[at].isValid) {
                glm::dvec2 centre(0.5);
                if (project(light.camera, points[at].position, centre)) centre *= mapScale;
                centres.push_back(glm::clamp(centre, glm::dvec2(0.0), glm::dvec2(1.0)));
                pixels.push_back(at);
            } else if (pixels.empty()) {
                ++missing;
            } else {
                centres.push_back(centres.back());
            }
        }
        if (pixels.empty()) continue;
        centres.insert(centres.begin(), missing, centres.front());

        const PatternMove own = patternMove(column, y);
        const double start = (mix(std::uint32_t(y)) >> 8) / 16777216.0 + std::fmod(frameIndex * std::sqrt(2.0), 1.0);
        for (int s = 0; s < count; ++s) {
            double mirrored = 0.0, digit = 0.5;
            for (int bits = s; bits != 0; bits /= 2, digit /= 2) mirrored += digit * (bits % 2);
            const double u = std::fmod(double(s) / count + own.shift + step.shift, 1.0);
            const double r = radiusUv * std::pow(u, shape.power);
            const double angle = 2.0 * std::numbers::pi * ((shape.isLine ? 0.0 : mirrored) + own.turn + step.turn);
            const glm::dvec2 place = centres[std::size_t(16.0 * std::fmod(s * 0.618034 + start, 1.0))] +
                                     r * glm::dvec2(std::cos(angle), std::sin(angle));
            const int px = int(std::floor(place.x * size)), py = int(std::floor(place.y * size));
            if (px < 0 || py < 0 || px >= size || py >= size) continue;
            // Over the unit square of the map: the mean of all disks' densities, each 1 / (2 pi d) du/dd.
            double density = 0.0;
            for (const glm::dvec2& centre : centres) {
                const double d = glm::length(place - centre) / radiusUv;
                if (d < 1.0) density += std::pow(d, 1.0 / shape.power - 2.0) / 16.0;
            }
            density /= shape.power * 2.0 * std::numbers::pi * radiusUv * radiusUv;
            const Vpl& p = texels[std::size_t(py) * std::size_t(size) + std::size_t(px)];
            for (const std::size_t at : pixels)
                result[at] += p.flux * texelGeometry(points[at], p) * double(size) * double(size) /
                              (density * count * std::numbers::pi);
        }
    }
    return result;
}

glm::dvec3 rsmDisk(const SurfacePoint& x, const std::vector<Vpl>& texels, const Light& light, int size, int count,
                   double radiusUv, PatternMove move, double mapScale, DiskShape shape) {
    glm::dvec3 sum(0.0);
    if (!x.isValid) return sum;
    glm::dvec2 centre(0.5);
    if (project(light.camera, x.position, centre)) centre *= mapScale;
    centre = glm::clamp(centre, glm::dvec2(0.0), glm::dvec2(1.0));
    for (int i = 0; i < count; ++i) {
        double mirrored = 0.0, place = 0.5;
        for (int bits = i; bits != 0; bits /= 2, place /= 2) mirrored += place * (bits % 2);
        const double u = std::fmod(double(i) / count + move.shift, 1.0);
        const double r = radiusUv * std::pow(u, shape.power);
        const double angle = 2.0 * std::numbers::pi * ((shape.isLine ? 0.0 : mirrored) + move.turn);
        // Over the unit square of the map: 1 / (2 pi r) dr/du of the angle's and the radius's densities.
        const double inversePdf = 2.0 * std::numbers::pi * r * radiusUv * shape.power * std::pow(u, shape.power - 1.0);
        const int px = int(std::floor((centre.x + r * std::cos(angle)) * size));
        const int py = int(std::floor((centre.y + r * std::sin(angle)) * size));
        if (px < 0 || py < 0 || px >= size || py >= size) continue;  // black beyond the border
        const Vpl& p = texels[std::size_t(py) * std::size_t(size) + std::size_t(px)];
        // The sum over texels is size^2 times the mean over the unit square.
        sum += p.flux * texelGeometry(x, p) * double(size) * double(size) * inversePdf / double(count);
    }
    return sum / std::numbers::pi;
}

glm::dvec3 directLight(const SurfacePoint& x, const Light& light, const ImageView& shadowDepth, double biasTexels,
                       double slopeBiasTexels) {
    if (!x.isValid) return glm::dvec3(0.0);
    const HostImage shadow = toFloat(shadowDepth);
    const Extent e = shadowDepth.extent;
    const double depth = -(glm::dmat4(light.camera.viewFromWorld) * glm::dvec4(x.position, 1.0)).z;
    glm::dvec3 towards = backwardsOf(light.camera);
    double incident = 1.0;
    double texel = std::max(2.0 / double(light.camera.clipFromView[0][0]) / e.widthPx,
                            2.0 / double(light.camera.clipFromView[1][1]) / e.heightPx);
    if (light.type == LightType::Spot) {
        const glm::dvec3 d = eyeOf(light.camera) - x.position;
        const double distance = glm::length(d);
        const double cosAxis = glm::dot(d, towards) / distance;
        towards = d / distance;
        const double inner = std::cos(double(light.innerConeAngle)), outer = std::cos(double(light.outerConeAngle));
        const double cone = std::clamp((cosAxis - outer) / std::max(inner - outer, 1e-3), 0.0, 1.0);
        const double range =
            light.rangeM > 0.0f ? std::clamp(1.0 - std::pow(distance / double(light.rangeM), 4.0), 0.0, 1.0) : 1.0;
        incident = cone * cone * range / (distance * distance);
        texel *= depth;
    }
    const double cosine = glm::dot(x.normal, towards);
    glm::dvec2 uv;
    if (project(light.camera, x.position, uv)) {
        const int px = int(std::floor(uv.x * e.widthPx)), py = int(std::floor(uv.y * e.heightPx));
        if (px >= 0 && py >= 0 && px < e.widthPx && py < e.heightPx) {
            const double slope =
                std::min(std::sqrt(std::max(1.0 - cosine * cosine, 0.0)) / std::max(cosine, 0.02), 20.0);
            const double occluder = *shadow.pixel(px, py);
            if (occluder > 0.0 && depth > occluder + texel * (biasTexels + slopeBiasTexels * slope))
                return glm::dvec3(0.0);
        }
    }
    return glm::dvec3(light.intensity) * incident * std::max(cosine, 0.0);
}

double automaticExposure(const std::vector<glm::dvec3>& radiance, double stops) {
    double sum = 0.0, count = 0.0;
    for (const glm::dvec3& c : radiance) {
        const double l = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
        if (l <= 1e-12) continue;
        sum += std::log(l);
        count += 1.0;
    }
    return std::exp2(stops) * (count > 0.0 ? 0.18 / std::exp(sum / count) : 1.0);
}

int displayByte(double x, bool filmic) {
    x = std::max(x, 0.0);
    if (filmic) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    x = std::min(x, 1.0);
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
    return int(encoded * 255.0 + 0.5);
}

}  // namespace earthshine::reference
