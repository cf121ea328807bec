#pragma once
// The reflective shadow maps of a frame, as a kernel's RSM_IN takes them.

#include "compute/kernel.hpp"

namespace earthshine {

/// Square maps of all lights below one another: as the lights' cameras drew them, and packed.
struct RsmView {
    Surface depth, normalWs, flux;
    cl::Buffer records;  ///< RsmRecord, rows of sizePx; null if the device gathers from the surfaces
    int sizePx = 0;
    int lightCount = 0;
};

/// Sets the argument RSM_IN(rsm) of `kernel`: the records or the three surfaces.
inline void setRsm(Kernel& kernel, const Device& device, const RsmView& rsm) {
    if (device.tuning().rsmRecords) {
        kernel.set("rsm", rsm.records);
    } else {
        kernel.set("rsmDepth", rsm.depth).set("rsmNormalWs", rsm.normalWs).set("rsmFlux", rsm.flux);
    }
}

}  // namespace earthshine
