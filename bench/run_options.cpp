#include "run_options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <sstream>

#include "earthshine/error.hpp"

namespace earthshine::bench {

RunOptions& runOptions() {
    static RunOptions options;
    return options;
}

std::vector<Extent> parseExtents(const std::string& text) {
    constexpr int kMaxSidePx = 16384;
    std::vector<Extent> extents;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) {
        Extent extent;
        int end = 0;
        const bool isWhole = std::sscanf(word.c_str(), "%5dx%5d%n", &extent.widthPx, &extent.heightPx, &end) == 2 &&
                             std::size_t(end) == word.size();
        if (!isWhole || extent.widthPx < 1 || extent.heightPx < 1 || extent.widthPx > kMaxSidePx ||
            extent.heightPx > kMaxSidePx)
            throw UsageError(fmt::format("sizes: '{}' is not WIDTHxHEIGHT of 1 to {} pixels each", word, kMaxSidePx));
        extents.push_back(extent);
    }
    if (extents.empty()) throw UsageError("sizes: names none, such as 1280x720,64x36");
    return extents;
}

}  // namespace earthshine::bench
