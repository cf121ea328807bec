#include "compute/probe.hpp"

#include "support/kernel_folder.hpp"

namespace earthshine::test {

std::string probeFolder() {
    static KernelFolder folder;
    static const bool isFilled = [] {
        for (const auto& entry : std::filesystem::directory_iterator(EARTHSHINE_PROBE_DIR)) folder.add(entry.path());
        return true;
    }();
    return isFilled ? folder.path() : std::string();
}

Device openWithProbes(const reference::Variant& variant) {
    DeviceOptions options = variant.options;
    options.kernelFolder = probeFolder();
    return Device(variant.caps, options);
}

std::vector<reference::Variant> laneVariants() {
    std::vector<reference::Variant> variants;
    for (const reference::Variant& v : storageVariants())
        if (v.options.storage == "planar") variants.push_back(v);
    return variants;
}

std::vector<reference::Variant> storageVariants() {
    std::vector<reference::Variant> variants;
    for (const reference::Variant& v : reference::allVariants())
        if (v.options.rsmRecords != 0) variants.push_back(v);
    return variants;
}

}  // namespace earthshine::test
