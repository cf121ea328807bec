#pragma once
// The sums of a path tracer in a file, so that it can go on later.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "earthshine/frame.hpp"
#include "raster/scene/scene.hpp"
#include "raster/trace/path_tracer.hpp"

namespace earthshine::trace {

/// Samples added up: even ones in the first half, odd ones in the second.
struct TraceSums {
    int sampleCount = 0;
    std::vector<glm::dvec3> halves[2];  ///< one a pixel, lux
};

/// A number that differs, as good as surely, if anything differs that the sums depend on.
std::uint64_t fingerprintOf(const raster::Scene& scene, const Camera& camera, std::span<const Light> lights,
                            const TraceSettings& settings);

/// Throws Error if the file cannot be written.
void writeSums(const std::string& path, std::uint64_t fingerprint, Extent extent, const TraceSums& sums);

/// Throws InputError if the file cannot be read, is damaged, or was made for something else.
TraceSums readSums(const std::string& path, std::uint64_t fingerprint, Extent extent);

}  // namespace earthshine::trace
