#pragma once
// Of a few numbers.

#include <algorithm>
#include <cmath>
#include <vector>

namespace earthshine::bench {

/// The number below which the fraction q of `values` lies, between neighbours by a line; 0.5 is the median. Not of
/// none.
inline double quantile(std::vector<double> values, double q) {
    std::sort(values.begin(), values.end());
    const double place = q * double(values.size() - 1), below = std::floor(place);
    const std::size_t at = std::size_t(below), next = std::min(at + 1, values.size() - 1);
    return values[at] + (place - below) * (values[next] - values[at]);
}

}  // namespace earthshine::bench
