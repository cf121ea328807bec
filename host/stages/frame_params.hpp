#pragma once
// From cameras and lights to what kernels read of them: pure functions.

#include <vector>

#include "earthshine/frame.hpp"
#include "earthshine/settings.hpp"
#include "light_params.h"
#include "view_rays.h"

namespace earthshine {

/// The world rays of a map's texels for linear depth along -z; `extent` is the map's.
ViewRays makeViewRays(const Camera& camera, Extent extent);

/// One light for RSMs and shadow maps of the given extents.
LightParams makeLightParams(const Light& light, Extent rsmExtent, Extent shadowExtent);

/// `count` points (cos a, sin a, pi / count, u): u, which rsm_gather maps to a radius, goes from 0 in steps of 1 /
/// count, and wants a shift. The angles are those of Hammersley's points, or all 0: a line, which wants a turn.
std::vector<f32x4> makeDiskPattern(int count, DiskPattern pattern = DiskPattern::Hammersley);

/// How frame `index` moves the pattern of every pixel: u by `shift` [0; 1 / sampleCount), all of it by `turn` [0; 1)
/// of a circle. Frame 0 stays. `centre` [0; 1) moves on which of several disks' centres each sample lies.
struct FrameMove {
    double shift, turn, centre;
};

/// The R2 sequence (Roberts 2018): in each of the pattern's rings of equal area, one a sample, the points of N frames
/// are low-discrepancy, by radius and angle together.
FrameMove makeFrameMove(int index, int sampleCount);

}  // namespace earthshine
