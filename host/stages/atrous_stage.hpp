#pragma once
// Passes of the edge-avoiding a-trous filter: the host half of kernels/atrous.cl and atrous_pair.cl.

#include "atrous_params.h"
#include "compute/kernel.hpp"

namespace earthshine {

/// Filters irradiance over taps of the same surface. Thread-compatible; owns its program, no images.
class AtrousStage {
public:
    struct Images {
        const Surface& irradiance;
        const Surface& normalWs;
        const Surface& depth;
        const Surface& length;  ///< frames of history
        const Surface& moment;  ///< read only if luminanceTolerance > 0
        const Surface& outIrradiance;
    };
    explicit AtrousStage(const Device& device)
        : device_(device), kernel_(device, "atrous"), pair_(device, "atrous_pair") {}
    /// Throws DeviceError if the taps reach farther than a surface's guard.
    void enqueue(const Images& images, const AtrousParams& params);
    /// Can a row and a column with these parameters be one launch on this device?
    bool canPair(const AtrousParams& params) const;
    /// A row of five taps and a column of five, whatever radius `params` has, in one launch. Throws DeviceError, also
    /// for what cannot be a pair.
    void enqueuePair(const Images& images, const AtrousParams& params);

private:
    int lanes() const { return device_.tuning().lanes; }
    int wantedRows(Extent extent) const;  ///< of a piece that an item filters
    void set(Kernel& kernel, const Images& images, const AtrousParams& params);

    Device device_;
    Kernel kernel_, pair_;
};

}  // namespace earthshine
