#include "truth/form_factor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace earthshine::truth {

namespace {

constexpr double kPi = std::numbers::pi;

// Gauss and Legendre's four points on [0; 1].
constexpr double kNodes[] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr double kWeights[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

double kernelAt(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& other,
                const glm::dvec3& otherNormal) {
    const glm::dvec3 d = other - point;
    const double d2 = glm::dot(d, d);
    return std::max(glm::dot(normal, d), 0.0) * std::max(-glm::dot(otherNormal, d), 0.0) / (kPi * d2 * d2);
}

Rectangle part(const Rectangle& r, double u, double v, double size) {
    return {r.at(u, v), size * r.sideU, size * r.sideV};
}

}  // namespace

glm::dvec3 Rectangle::normal() const {
    return glm::normalize(glm::cross(sideU, sideV));
}

double Rectangle::area() const {
    return glm::length(glm::cross(sideU, sideV));
}

double parallelRectangles(double x, double y) {
    const double x2 = 1.0 + x * x, y2 = 1.0 + y * y;
    return 2.0 / (kPi * x * y) *
           (0.5 * std::log(x2 * y2 / (x2 + y2 - 1.0)) + x * std::sqrt(y2) * std::atan(x / std::sqrt(y2)) +
            y * std::sqrt(x2) * std::atan(y / std::sqrt(x2)) - x * std::atan(x) - y * std::atan(y));
}

double perpendicularRectangles(double h, double w) {
    const double h2 = h * h, w2 = w * w, r = std::sqrt(h2 + w2);
    const double logarithm = std::log((1.0 + w2) * (1.0 + h2) / (1.0 + w2 + h2)) +
                             w2 * std::log(w2 * (1.0 + w2 + h2) / ((1.0 + w2) * (w2 + h2))) +
                             h2 * std::log(h2 * (1.0 + h2 + w2) / ((1.0 + h2) * (h2 + w2)));
    return (w * std::atan(1.0 / w) + h * std::atan(1.0 / h) - r * std::atan(1.0 / r) + 0.25 * logarithm) / (kPi * w);
}

double pointUnderCorner(double a, double b) {
    const double s = std::sqrt(1.0 + a * a), t = std::sqrt(1.0 + b * b);
    return (a / s * std::atan(b / s) + b / t * std::atan(a / t)) / (2.0 * kPi);
}

double pointAcrossEdge(double x, double y) {
    const double q = std::sqrt(x * x + y * y);
    return (std::atan(1.0 / y) - y / q * std::atan(1.0 / q)) / (2.0 * kPi);
}

double pointByQuadrature(const glm::dvec3& point, const glm::dvec3& normal, const Rectangle& to) {
    // Halved until it is small against its distance, where four points an axis are exact to 1e-8.
    const double size = std::max(glm::length(to.sideU), glm::length(to.sideV));
    if (size > 1e-6 && size > 0.5 * glm::length(to.centre() - point)) {
        double sum = 0.0;
        for (int i = 0; i < 4; ++i)
            sum += pointByQuadrature(point, normal, part(to, 0.5 * (i % 2), 0.5 * (i / 2), 0.5));
        return sum;
    }
    double sum = 0.0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            sum += kWeights[i] * kWeights[j] * kernelAt(point, normal, to.at(kNodes[i], kNodes[j]), to.normal());
    return sum * to.area();
}

double meanByQuadrature(const Rectangle& from, const Rectangle& to) {
    constexpr int kCells = 32;  // for the corner that touches: elsewhere one would do
    double sum = 0.0;
    for (int cell = 0; cell < kCells * kCells; ++cell) {
        const Rectangle r = part(from, double(cell % kCells) / kCells, double(cell / kCells) / kCells, 1.0 / kCells);
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                sum += kWeights[i] * kWeights[j] * pointByQuadrature(r.at(kNodes[i], kNodes[j]), from.normal(), to);
    }
    return sum / (kCells * kCells);
}

}  // namespace earthshine::truth
