#include "interop/shared_textures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "earthshine/error.hpp"

namespace earthshine {

double timedMs(const std::function<void()>& body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

SharedTextures::SharedTextures(const char* name, const Device& device, const GlContextHandle& gl)
    : device_(device), api_(name, gl.getProcAddress) {}

SharedImage SharedTextures::image(const GlTexture& texture) {
    const auto found = shared_.find(texture.name);
    if (found != shared_.end()) {
        const GlTexture& known = found->second.texture;
        if (known.format == texture.format && known.extent == texture.extent)
            return {texture.name, found->second.image};
        shared_.erase(found);  // its owner gave it other storage and did not say so
    }
    const cl::Image2D image = share(texture);
    shared_[texture.name] = {texture, image};
    return {texture.name, image};
}

std::vector<cl::Memory> SharedTextures::memories(const std::vector<SharedImage>& images) {
    std::vector<cl::Memory> memories;
    for (const SharedImage& shared : images) memories.push_back(shared.image);
    return memories;
}

void SharedTextures::forget(unsigned name) noexcept {
    shared_.erase(name);
}

void SharedTextures::enqueue(const GlFrame& frame, const std::vector<Light>& lights, FrameSurfaces& out,
                             TransportCost& cost) {
    const auto mapExtent = [&](const GlTexture& atlas) {
        return Extent{atlas.extent.widthPx, atlas.extent.heightPx / std::max(frame.lightCount, 1)};
    };
    prepareSurfaces(device_,
                    {frame.depth.extent, mapExtent(frame.rsmDepth), mapExtent(frame.shadowDepth),
                     frame.motion.name != 0, frame.emission.name != 0},
                    lights, out);
    std::vector<std::pair<GlTexture, const Surface*>> pairs{
        {frame.albedo, &out.albedo}, {frame.normalWs, &out.normalWs}, {frame.depth, &out.depth}};
    if (frame.motion.name != 0) pairs.emplace_back(frame.motion, &out.motion);
    if (frame.emission.name != 0) pairs.emplace_back(frame.emission, &out.emission);
    if (frame.lightCount > 0) {
        pairs.emplace_back(frame.rsmDepth, &out.rsm.depth);
        pairs.emplace_back(frame.rsmNormalWs, &out.rsm.normalWs);
        pairs.emplace_back(frame.rsmFlux, &out.rsm.flux);
        pairs.emplace_back(frame.shadowDepth, &out.shadowDepth);
    }
    if (!import_) import_.emplace(device_);
    std::vector<SharedImage> images;
    for (const auto& [texture, surface] : pairs) images.push_back(image(texture));

    acquire(images, cost);
    try {
        for (std::size_t i = 0; i < pairs.size(); ++i) import_->enqueue(images[i].image, *pairs[i].second);
    } catch (...) {
        try {
            release(images, cost);      // GL gets its textures back whatever happens
        } catch (const DeviceError&) {  // the first error is the one that matters
        }
        throw;
    }
    release(images, cost);
}

}  // namespace earthshine
