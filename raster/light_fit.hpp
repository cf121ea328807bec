#pragma once
// Turns the lights of a scene into lights with maps: chooses what each light's map covers.

#include <optional>
#include <span>
#include <vector>

#include "earthshine/frame.hpp"
#include "raster/scene/animator.hpp"
#include "raster/scene/scene.hpp"

namespace earthshine::raster {

/// Sunlight. World space has +y up and -z north.
struct Sun {
    float azimuthDeg = 135.0f;   ///< (degrees) - compass bearing towards the sun: 0 = north (-z), 90 = east (+x)
    float elevationDeg = 50.0f;  ///< [-90; 90] (degrees) - above the horizon
    float lux = 50000.0f;        ///< (lux >= 0) - across the beam; the default is a sun in thin haze
    glm::vec3 color{1.0f};       ///< [0; 1] - times lux; white unless it stands for a light of a scene
};

/// A directional light as a sun: its bearing, its elevation, its brightest channel as lux.
Sun sunOf(const SceneLight& light);

/// The direction to the sun, unit, world space. Throws UsageError if a number is out of its range.
glm::vec3 directionToSun(const Sun& sun);

/// The sun as a directional light fitted to the scene and to `reach` (LightOptions), named "sun". Throws UsageError as
/// directionToSun.
Light sunLight(const Sun& sun, const Scene& scene, std::span<const WorldBox> reach = {});

struct LightOptions {
    std::optional<Sun> sun;                ///< stands in for the scene's directional lights
    std::span<const WorldBox> reach = {};  ///< what maps cover besides the instances: where these will be later. Maps
                                           ///< that are fitted to a moving object anew crawl over what stands still
    bool logs = true;                      ///< off: what was said of an earlier frame is not said again
};

/// The lights that can be drawn, in the scene's order, a sun of `options` first.
///   Directional: an orthographic map fitted to all vertices of all instances, and to `reach`, as the light sees them,
///   along its own x and y, with a margin of 1e-4 of each side and what rounding needs. It depends on nothing else, so
///   that a light that stands still keeps its map to the bit while objects move within `reach`; one that turns has
///   another projection in every frame, whatever the fit.
///   Spot: a perspective map that holds the cone, up to 85 degrees from the axis; it reaches to the farthest vertex or
///   to the end of the light's range, and begins at a thousandth of that.
/// Logs one line if the scene has point lights, which have no map, and one if no light is left, when the default sun
/// shines. The camera of each light has the light's place and direction.
std::vector<Light> fitLights(const Scene& scene, const LightOptions& options = {});

}  // namespace earthshine::raster
