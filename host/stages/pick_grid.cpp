#include "stages/pick_grid.hpp"

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine {

namespace {

int log2Of(int stride) {
    if (stride != 1 && stride != 2 && stride != 4)
        throw UsageError(fmt::format("lower resolution: a stride of {} is none of 1, 2, 4", stride));
    return stride / 2;
}

f32x4 sum(const f32x4& a, double x, const f32x4& dx, double y, const f32x4& dy) {
    const auto one = [&](float at, float alongX, float alongY) {
        return float(double(at) + x * double(alongX) + y * double(alongY));
    };
    return {one(a.x, dx.x, dy.x), one(a.y, dx.y, dy.y), one(a.z, dx.z, dy.z), one(a.w, dx.w, dy.w)};
}

}  // namespace

Extent pickedExtent(Extent full, int stride) {
    log2Of(stride);
    return {(full.widthPx + stride - 1) / stride, (full.heightPx + stride - 1) / stride};
}

PickGrid makePickGrid(Extent full, int stride) {
    return {log2Of(stride), (full.widthPx - 1) % stride / 2, (full.heightPx - 1) % stride / 2, 0};
}

ViewRays pickedRays(const ViewRays& rays, const PickGrid& grid) {
    const double stride = 1 << grid.strideLog2;
    const f32x4 zero{};
    ViewRays picked = rays;
    picked.origin = sum(rays.origin, grid.offsetXPx, rays.originDx, grid.offsetYPx, rays.originDy);
    picked.ray = sum(rays.ray, grid.offsetXPx, rays.rayDx, grid.offsetYPx, rays.rayDy);
    picked.originDx = sum(zero, stride, rays.originDx, 0.0, zero);
    picked.originDy = sum(zero, stride, rays.originDy, 0.0, zero);
    picked.rayDx = sum(zero, stride, rays.rayDx, 0.0, zero);
    picked.rayDy = sum(zero, stride, rays.rayDy, 0.0, zero);
    return picked;
}

}  // namespace earthshine
