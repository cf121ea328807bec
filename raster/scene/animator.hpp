#pragma once
// Plays the animations of a scene: where everything stands at a time.

#include <string_view>
#include <vector>

#include "raster/scene/scene.hpp"

namespace earthshine::raster {

/// A box in the world.
struct WorldBox {
    glm::vec3 min{0.0f};
    glm::vec3 max{0.0f};
};

/// The animations of one scene that are played. Outlives no vector of its scene; the scene may be moved about by it.
class Animator {
public:
    /// `which`: the name of an animation, or its number from 0; "" plays all of them at once, of those that move the
    /// same part of a node the last. Throws UsageError if there is no such animation, with the names of those that
    /// there are, or if there is none at all.
    Animator(const Scene& scene, std::string_view which);

    /// Moves the instances, cameras and lights of the scene to where they stand at a time. What no animation moves
    /// keeps its bits. A camera or light whose scale leaves it no direction keeps the place it has. Throws InputError
    /// if a place is beyond what 32-bit floats hold.
    void pose(Scene& scene, double timeS) const;

    /// The instances that pose() moves, in order.
    const std::vector<int>& movedInstances() const noexcept { return movedInstances_; }

    /// Whether pose() moves what hangs on a node of Scene::nodes; -1 is none.
    bool moves(int node) const { return node >= 0 && movedNodes_[std::size_t(node)]; }

    /// The time of the last key of all, s; from there on nothing moves.
    double lastKeyS() const noexcept { return lastKeyS_; }

    /// The box in which each moved instance stays at the times 0, 1 / framesPerSecond, ... up to the last key; of a
    /// longer animation than 4096 such steps at so many steps of equal length. Parallel to movedInstances. Poses
    /// `scene`, and leaves it at the last of these times. A millionth larger than it need be, so that rounding puts
    /// nothing outside. Throws as pose.
    std::vector<WorldBox> sweptBounds(Scene& scene, double framesPerSecond) const;

private:
    std::vector<const Animation*> played_;
    std::vector<bool> movedNodes_;
    std::vector<int> movedInstances_;
    double lastKeyS_ = 0.0;
};

}  // namespace earthshine::raster
