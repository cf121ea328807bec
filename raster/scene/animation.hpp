#pragma once
// Animations as glTF 2.0 has them: keys over time for the translation, rotation or scale of nodes.

#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace earthshine::raster {

/// A node of the file's tree: where it stands in its parent.
struct SceneNode {
    int parent = -1;                          ///< into Scene::nodes, before this one; -1 = the world
    std::optional<glm::dmat4> matrix;         ///< parent from node, in place of the three below; never animated
    glm::dvec3 translation{0.0};              ///< m
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< w, x, y, z; need not be unit
    glm::dvec3 scale{1.0};
};

/// Scales, then turns, then moves.
glm::dmat4 parentFromNode(const SceneNode& node);

enum class AnimatedPart { Translation, Rotation, Scale };
enum class Interpolation { Linear, Step, CubicSpline };

/// The keys of one part of one node.
struct AnimationChannel {
    int node = 0;  ///< into Scene::nodes
    AnimatedPart part = AnimatedPart::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> timesS;      ///< at least one, >= 0, each greater than the one before
    std::vector<glm::vec4> values;  ///< one a key (rotation: x, y, z, w); a cubic spline three: in-tangent a second,
                                    ///< value, out-tangent a second
};

struct Animation {
    std::string name;
    std::vector<AnimationChannel> channels;
};

/// The value of a channel at a time (glTF 2.0, appendix C): the first key's before it, the last key's after it.
/// Rotations are unit: linear ones go the shorter way around at constant speed (slerp), splines are interpolated as
/// numbers and then normalised.
glm::dvec4 valueAt(const AnimationChannel& channel, double timeS);

/// The time of the last key, s; 0 of none.
double lastKeyS(const Animation& animation);

}  // namespace earthshine::raster
