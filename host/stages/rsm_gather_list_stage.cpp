#include "stages/rsm_gather_list_stage.hpp"

namespace earthshine {

void RsmGatherListStage::enqueue(const RsmGatherStage::Images& images, const cl::Buffer& pixels,
                                 const cl::Buffer& count, const RsmGatherParams& params) {
    RsmGatherStage::set(kernel_, "rsm_gather_list", device_, images, params);
    kernel_.set("pixels", pixels).set("count", count);
    kernel_.enqueue(images.outIrradiance.extent());
}

}  // namespace earthshine
