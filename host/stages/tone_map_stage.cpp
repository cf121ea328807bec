#include "stages/tone_map_stage.hpp"

namespace earthshine {

void ToneMapStage::enqueue(const Images& images, const ToneMapParams& params) {
    kernel_.set("inRadiance", images.radiance).set("exposure", images.exposure).set("outDisplay", images.outDisplay);
    kernel_.setParams("params", params);
    kernel_.enqueue(images.radiance.extent());
}

}  // namespace earthshine
