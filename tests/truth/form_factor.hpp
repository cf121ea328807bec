#pragma once
// Form factors between rectangles: closed forms from the literature, and the same numbers by quadrature of the
// definition, so that neither a misprint nor a slip of ours can pass for the truth.
//   F(x -> rectangle) = 1/pi  integral over the rectangle of cos+ cos+ / d^2 dA
//   F(1 -> 2)         = the mean of F(x -> 2) over rectangle 1
// A Lambertian rectangle of radiosity M sends a point the irradiance M F.

#include <glm/vec3.hpp>

namespace earthshine::truth {

/// A parallelogram with right angles; its front is where cross(sideU, sideV) points.
struct Rectangle {
    glm::dvec3 corner{0.0};
    glm::dvec3 sideU{1.0, 0.0, 0.0};
    glm::dvec3 sideV{0.0, 1.0, 0.0};

    glm::dvec3 at(double u, double v) const { return corner + u * sideU + v * sideV; }
    glm::dvec3 centre() const { return at(0.5, 0.5); }
    glm::dvec3 normal() const;  ///< unit
    double area() const;
};

/// Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11: equal parallel rectangles of sides
/// a x b, opposite each other at distance c; x = a / c, y = b / c.
double parallelRectangles(double x, double y);

/// Howell C-14: two rectangles at right angles with a common edge of length l; h and w are the other sides over l. From
/// the one of side w to the other.
double perpendicularRectangles(double h, double w);

/// A point below the corner of a parallel rectangle a x b at distance c; a / c, b / c (Howell B-3).
double pointUnderCorner(double a, double b);

/// A point of a plane at right angles to a rectangle b (along the common edge) x a: opposite the end of the edge, c
/// away from it; x = a / b, y = c / b (Howell B-4).
double pointAcrossEdge(double x, double y);

/// The definition, integrated numerically to about 1e-7.
double pointByQuadrature(const glm::dvec3& point, const glm::dvec3& normal, const Rectangle& to);
double meanByQuadrature(const Rectangle& from, const Rectangle& to);

}  // namespace earthshine::truth
