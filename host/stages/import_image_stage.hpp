#pragma once
// One image of another API into a surface: the host half of kernels/import_image.cl.

#include "compute/kernel.hpp"

namespace earthshine {

/// Fills a surface from an image of its extent; what is not finite becomes 0. Thread-compatible; owns its program, no
/// images.
class ImportImageStage {
public:
    explicit ImportImageStage(const Device& device) : kernel_(device, "import_image") {}
    void enqueue(const cl::Image2D& image, const Surface& outSurface);

private:
    Kernel kernel_;
};

}  // namespace earthshine
