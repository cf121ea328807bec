#pragma once
// Irradiance into radiance: the host half of kernels/modulate.cl.

#include "compute/kernel.hpp"
#include "modulate_params.h"

namespace earthshine {

/// Computes albedo / pi x irradiance + addend (cd/m^2). Thread-compatible; owns its program, no images.
class ModulateStage {
public:
    struct Images {
        const Surface& albedo;
        const Surface& irradiance;
        const Surface* addend;  ///< may be null: nothing is added
        const Surface& outRadiance;
    };
    explicit ModulateStage(const Device& device) : kernel_(device, "modulate") {}
    void enqueue(const Images& images);

private:
    Kernel kernel_;
};

}  // namespace earthshine
