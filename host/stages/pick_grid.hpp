#pragma once
// Pictures of lower resolution whose texels are picked pixels (kernels/shared/pick_grid.h): pure functions.

#include "earthshine/image.hpp"
#include "pick_grid.h"
#include "view_rays.h"

namespace earthshine {

/// The extent of every `stride`-th pixel of `full`: at least one a direction. Throws UsageError unless `stride` is 1, 2
/// or 4.
Extent pickedExtent(Extent full, int stride);

/// The grid of pickedExtent(full, stride), in the middle of the picture: what the last texel leaves over is shared
/// between both ends. Every pick lies inside. Throws as pickedExtent.
PickGrid makePickGrid(Extent full, int stride);

/// The rays of the picked texels, from those of all pixels.
ViewRays pickedRays(const ViewRays& rays, const PickGrid& grid);

}  // namespace earthshine
