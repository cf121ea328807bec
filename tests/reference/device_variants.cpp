#include "reference/device_variants.hpp"

#include <cctype>
#include <cstdlib>

#include "compute/tuning.hpp"

namespace earthshine::reference {

namespace {

std::string testName(const DeviceCaps& caps) {
    std::string name;
    for (char c : caps.platformName.substr(0, 12) + std::to_string(caps.index))
        name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
}

std::vector<DeviceCaps> testedDevices() {
    // Mesa's CPU device is not there unless it is asked for. Here, since the list of tests is made without the
    // environment that tests then run in.
    ::setenv("RUSTICL_ENABLE", "llvmpipe", 0);
    std::vector<DeviceCaps> devices;
    const char* wanted = std::getenv("EARTHSHINE_TEST_DEVICES");
    for (const DeviceCaps& caps : listDevices()) {
        if (!caps.unusable.empty()) continue;
        if (wanted && (caps.platformName + caps.name).find(wanted) == std::string::npos) continue;
        devices.push_back(caps);
    }
    return devices;
}

bool everyVariantIsWanted() {
    return std::getenv("EARTHSHINE_TEST_EVERY_VARIANT") != nullptr;
}

}  // namespace

double surfaceRounding(const Variant& variant) {
    return tuningFor(variant.caps, variant.options).storage == Storage::Packed ? 0x1p-13 : 0.0;
}

std::vector<Variant> allVariants() {
    std::vector<Variant> variants;
    for (const DeviceCaps& caps : testedDevices()) {
        for (int lanes : {1, 4, 8, 16}) {
            for (const std::string storage : kStorageNames) {
                if (!caps.images && storage == "image") continue;
                const bool isRun = lanes == 1 || (lanes == 4 && storage == "planar");
                if (caps.type == "GPU" && !isRun && !everyVariantIsWanted()) continue;
                Variant v{caps, {}, testName(caps) + "_lanes" + std::to_string(lanes) + "_" + storage};
                v.options.lanes = lanes;
                v.options.storage = storage;
                variants.push_back(v);
            }
        }
        // The naive port: no records, no pairs.
        Variant v{caps, {}, testName(caps) + "_naive"};
        v.options.lanes = 1;
        v.options.storage = caps.images ? "image" : "planar";
        v.options.rsmRecords = 0;
        v.options.filterPairs = 0;
        variants.push_back(v);
    }
    return variants;
}

std::vector<Variant> quickVariants() {
    const bool isEvery = everyVariantIsWanted();
    std::vector<Variant> variants;
    for (const Variant& v : allVariants()) {
        const bool isLlvmpipe = v.caps.name.find("llvmpipe") != std::string::npos;
        const bool isWide = v.options.storage == "planar" && v.options.lanes == (isLlvmpipe ? 16 : 4);
        if (isEvery || !(isLlvmpipe || v.caps.type == "GPU") || v.options.lanes == 1 || isWide) variants.push_back(v);
    }
    return variants;
}

std::vector<Variant> defaultVariants() {
    std::vector<Variant> variants;
    for (const DeviceCaps& caps : testedDevices()) variants.push_back({caps, {}, testName(caps)});
    return variants;
}

}  // namespace earthshine::reference
