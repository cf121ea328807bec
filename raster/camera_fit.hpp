#pragma once
// Turns the cameras of a scene into cameras for a picture of a given extent.

#include <string_view>

#include "earthshine/frame.hpp"
#include "raster/scene/scene.hpp"

namespace earthshine::raster {

/// The camera `which` of the scene: its name, or its number from 0; "" is the first one, or defaultView if the scene
/// has none. The vertical field of view is the file's, the aspect ratio is the extent's. Throws UsageError if there is
/// no such camera, with the names of those that there are, and for an extent without pixels.
Camera cameraFor(const Scene& scene, std::string_view which, Extent extent);

/// The scene's camera that cameraFor takes; null for the default view. Throws UsageError if there is no such camera.
const SceneCamera* findCamera(const Scene& scene, std::string_view which);

/// A view that frames the bounds of the scene, from the front (+z), a little to the right and above.
Camera defaultView(const Scene& scene, Extent extent);

}  // namespace earthshine::raster
