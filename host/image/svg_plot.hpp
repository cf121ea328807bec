#pragma once
// Curves on logarithmic axes, as SVG that any browser shows.

#include <string>
#include <vector>

namespace earthshine {

struct PlotPoint {
    double x = 0, y = 0;
    std::string label;  ///< shown when the pointer rests on the point
};

struct PlotSeries {
    std::string name;
    std::vector<PlotPoint> points;  ///< joined in this order
};

/// Both axes are logarithmic; points that are not finite and above 0 are left out. Series without a point that can be
/// shown do not appear in the legend.
struct Plot {
    std::string title, xTitle, yTitle;
    std::vector<PlotSeries> series;
};

/// The whole SVG file as text.
std::string svgOf(const Plot& plot);

}  // namespace earthshine
