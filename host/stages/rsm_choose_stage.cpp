#include "stages/rsm_choose_stage.hpp"

namespace earthshine {

void RsmChooseStage::enqueue(const Images& images, const RsmChooseParams& params) {
    kernel_.define("MAPPING", params.gather.mapping).set("inDepth", images.depth).set("lights", images.lights);
    kernel_.set("pattern", images.pattern).set("noise", images.noise).set("outChoices", images.outChoices);
    kernel_.setParams("params", params);
    kernel_.enqueue({int(choicesInRow(images.depth.extent().widthPx, 1)), params.rowCount});
}

}  // namespace earthshine
