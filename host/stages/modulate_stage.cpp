#include "stages/modulate_stage.hpp"

namespace earthshine {

void ModulateStage::enqueue(const Images& images) {
    const Extent extent = images.outRadiance.extent();
    requireExtent("modulate", "inAlbedo", images.albedo, extent);
    requireExtent("modulate", "inIrradiance", images.irradiance, extent);
    if (images.addend) requireExtent("modulate", "inAddend", *images.addend, extent);
    const ModulateParams params{images.addend ? 1 : 0, 0, 0, 0};
    kernel_.set("inAlbedo", images.albedo).set("inIrradiance", images.irradiance);
    kernel_.set("inAddend", images.addend ? *images.addend : images.irradiance);  // bound, but not read, if null
    kernel_.set("outRadiance", images.outRadiance).setParams("params", params);
    kernel_.enqueue(images.outRadiance.extent());
}

}  // namespace earthshine
