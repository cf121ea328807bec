#include "raster/scene/gltf_animation.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raster/scene/gltf_accessor.hpp"

namespace earthshine::raster {

namespace {

using nlohmann::json;

class AnimationReader {
public:
    AnimationReader(const GltfContext& context, const std::vector<int>& sceneNodes)
        : context_(context), sceneNodes_(sceneNodes) {}

    Animation read(const json& from, const std::string& place) {
        Animation to;
        to.name = from.value("name", "");
        for (const json& channel : from["channels"]) {
            const json& target = channel["target"];
            const auto path = target["path"].get<std::string>();
            if (path == "weights") context_.note(place + ": its morph weights are not animated");
            const bool isPart = path == "translation" || path == "rotation" || path == "scale";
            if (!target.contains("node") || (!isPart && path != "weights"))
                context_.note(
                    fmt::format("{}: what it does to \"{}\" is not supported, and left out", place, printable(path)));
            if (!isPart || !target.contains("node")) continue;
            const int node = sceneNodes_[target["node"].get<std::size_t>()];
            if (node < 0) continue;  // of another scene
            const auto sampler = channel["sampler"].get<std::size_t>();
            AnimationChannel read = readSampler(from["samplers"][sampler], path == "rotation",
                                                fmt::format("{}.samplers[{}]", place, sampler));
            read.node = node;
            read.part = path == "translation" ? AnimatedPart::Translation
                        : path == "rotation"  ? AnimatedPart::Rotation
                                              : AnimatedPart::Scale;
            to.channels.push_back(std::move(read));
        }
        return to;
    }

private:
    AnimationChannel readSampler(const json& from, bool isRotation, const std::string& place) {
        AnimationChannel to;
        const auto interpolation = from.value("interpolation", "LINEAR");
        to.interpolation = interpolation == "STEP"          ? Interpolation::Step
                           : interpolation == "CUBICSPLINE" ? Interpolation::CubicSpline
                                                            : Interpolation::Linear;
        const int input = from["input"].get<int>();
        keyCount_ += context_.model.accessors[std::size_t(input)].count;
        if (keyCount_ > gltf_limits::kAnimationKeys)
            context_.file.fail(place,
                               fmt::format("the animations have more than {} keys", gltf_limits::kAnimationKeys));
        to.timesS = readFloats(context_, input, 1, 0.0f, place + ".input");
        for (std::size_t i = 0; i < to.timesS.size(); ++i) {
            const float before = i ? to.timesS[i - 1] : 0.0f;
            if (!(i ? to.timesS[i] > before : to.timesS[i] >= before)) {
                context_.file.fail(
                    fmt::format("{}.input[{}]", place, i),
                    fmt::format("is {}; times begin at 0 or later, and each is after the one before", to.timesS[i]));
            }
        }
        const std::vector<float> values = readFloats(context_, from["output"].get<int>(), 4, 0.0f, place + ".output");
        to.values.resize(values.size() / 4);
        for (std::size_t i = 0; i < to.values.size(); ++i) {
            glm::vec4& value = to.values[i];
            for (int c = 0; c < 4; ++c) value[c] = values[4 * i + std::size_t(c)];
            const bool isTangent = to.interpolation == Interpolation::CubicSpline && i % 3 != 1;
            const glm::dvec4 exact(value);
            const double squared = glm::dot(exact, exact);
            if (isRotation && !isTangent && !(squared > 1e-12 && squared < 1e12)) {
                context_.file.fail(fmt::format("{}.output[{}]", place, i), "is no rotation: its length is not 1");
            }
        }
        return to;
    }

    const GltfContext& context_;
    const std::vector<int>& sceneNodes_;
    std::size_t keyCount_ = 0;
};

}  // namespace

void readAnimations(const GltfContext& context, const json& animations, const std::vector<int>& sceneNodes) {
    AnimationReader reader(context, sceneNodes);
    for (std::size_t i = 0; i < animations.size(); ++i) {
        Animation animation = reader.read(animations[i], fmt::format("animations[{}]", i));
        if (!animation.channels.empty()) context.scene.animations.push_back(std::move(animation));
    }
}

}  // namespace earthshine::raster
