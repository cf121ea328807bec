#include "image/svg_plot.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace earthshine {

namespace {

constexpr int kWidth = 820, kHeight = 480, kLeft = 80, kRight = 230, kTop = 44, kBottom = 56;
// Okabe and Ito's colours, which nearly everybody can tell apart.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

bool isShown(const PlotPoint& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && p.x > 0.0 && p.y > 0.0;
}

/// A logarithmic axis over whole powers of ten.
struct Axis {
    int first = 0, last = 1;  ///< exponents
    double from, to;          ///< pixels

    double at(double value) const { return from + (std::log10(value) - first) / (last - first) * (to - from); }
};

Axis axisOver(const std::vector<double>& values, double from, double to) {
    Axis axis{0, 1, from, to};
    if (values.empty()) return axis;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    axis.first = int(std::floor(std::log10(*low)));
    axis.last = std::max(int(std::ceil(std::log10(*high))), axis.first + 1);
    return axis;
}

std::string power(int exponent) {
    if (exponent >= -3 && exponent <= 4) return fmt::format("{:g}", std::pow(10.0, exponent));
    return fmt::format("1e{}", exponent);
}

}  // namespace

std::string svgOf(const Plot& plot) {
    std::vector<double> xs, ys;
    for (const PlotSeries& series : plot.series)
        for (const PlotPoint& p : series.points)
            if (isShown(p)) {
                xs.push_back(p.x);
                ys.push_back(p.y);
            }
    const Axis x = axisOver(xs, kLeft, kWidth - kRight), y = axisOver(ys, kHeight - kBottom, kTop);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" "
        "font-size=\"13\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n"
        "<text x=\"{2}\" y=\"26\" font-size=\"16\">{3}</text>\n",
        kWidth, kHeight, kLeft, escaped(plot.title));
    for (int e = x.first; e <= x.last; ++e) {
        const double at = x.at(std::pow(10.0, e));
        svg += fmt::format(
            "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
            "text-anchor=\"middle\">{4}</text>\n",
            at, kTop, kHeight - kBottom, kHeight - kBottom + 18, power(e));
    }
    for (int e = y.first; e <= y.last; ++e) {
        const double at = y.at(std::pow(10.0, e));
        svg += fmt::format(
            "<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
            "text-anchor=\"end\">{5}</text>\n",
            at, kLeft, kWidth - kRight, kLeft - 6, at + 4, power(e));
    }
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (kLeft + kWidth - kRight) / 2,
                       kHeight - 14, escaped(plot.xTitle));
    svg += fmt::format("<text transform=\"translate(20 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                       (kTop + kHeight - kBottom) / 2, escaped(plot.yTitle));
    std::size_t shown = 0;
    for (const PlotSeries& series : plot.series) {
        if (std::none_of(series.points.begin(), series.points.end(), isShown)) continue;
        const char* color = kColors[shown % std::size(kColors)];
        std::string path, dots;
        for (const PlotPoint& p : series.points) {
            if (!isShown(p)) continue;
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.at(p.x), y.at(p.y));
            dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"><title>{}</title></circle>", x.at(p.x),
                                y.at(p.y), escaped(p.label));
        }
        const int row = kTop + 8 + 20 * int(shown++);
        svg += fmt::format("<path d=\"{0}\" fill=\"none\" stroke=\"{1}\" stroke-width=\"2\"/><g fill=\"{1}\">{2}", path,
                           color, dots);
        svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"4\"/></g><text x=\"{}\" y=\"{}\">{}</text>\n",
                           kWidth - kRight + 20, row - 4, kWidth - kRight + 32, row, escaped(series.name));
    }
    return svg + "</svg>\n";
}

}  // namespace earthshine
