#include "variants.hpp"

#include <fmt/format.h>

#include <sstream>

#include "compute/tuning.hpp"
#include "earthshine/error.hpp"

namespace earthshine::bench {

Variant tuned() {
    Variant v{"tuned", {}};
    v.options.profiling = true;
    return v;
}

Variant naive() {
    Variant v = tuned();
    v.name = "naive";
    v.options.lanes = 1;
    v.options.storage = "image";
    v.options.rsmRecords = 0;
    v.options.filterPairs = 0;
    return v;
}

std::vector<Variant> everyVariant(const DeviceCaps& caps) {
    std::vector<Variant> variants;
    for (const int lanes : {1, 4, 8, 16})
        for (const std::string storage : kStorageNames) {
            if (!caps.images && storage == "image") continue;
            Variant v = tuned();
            v.name = fmt::format("lanes{}_{}", lanes, storage);
            v.options.lanes = lanes;
            v.options.storage = storage;
            variants.push_back(v);
        }
    return variants;
}

Variant withRecords(Variant variant) {
    variant.options.rsmRecords = 1;
    return variant;
}

std::vector<Variant> parseVariants(const std::string& text, const DeviceCaps& caps) {
    std::vector<Variant> variants;
    if (text.empty() || text == "all") {
        variants.push_back(tuned());
        if (caps.images) variants.push_back(naive());
        if (text == "all")
            for (Variant& v : everyVariant(caps)) variants.push_back(std::move(v));
        return variants;
    }
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) {
        if (word == "naive" && !caps.images)
            throw UsageError(fmt::format("variants: \"{}\" has no images, which naive kernels read", caps.name));
        if (word != "tuned" && word != "naive")
            throw UsageError(fmt::format("variants: '{}' is none of tuned, naive, all", word));
        variants.push_back(word == "tuned" ? tuned() : naive());
    }
    return variants;
}

}  // namespace earthshine::bench
