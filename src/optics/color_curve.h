// SPDX-License-Identifier: Apache-2.0
// Based on: M. Zeyen, T. Post, H. Hagen, J. Ahrens, D. Rogers and R. Bujack, "Color Interpolation
// for Non-Euclidean Color Spaces", IEEE VIS 2018; and G. Sharma, W. Wu and E. N. Dalal, "The
// CIEDE2000 Color-Difference Formula", 2005.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Returns whether all points, and so all values, have one colour, to the last bit.
bool hasOneColor(const TransferFunction& function);

/// The colours of a transfer function, converted once into the space where colours are mixed.
class ColorCurve {
  public:
    /// @param function  has at least one colour
    explicit ColorCurve(const TransferFunction& function);

    /// As TransferFunction::colorAt.
    glm::dvec3 at(double x) const;

  private:
    // A straight mix of colours from `begin` up to the next stretch.
    struct Stretch {
        double begin, end;
        glm::dvec3 from, to;
    };

    void addStretch(const TransferFunction::ColorPoint& left,
                    const TransferFunction::ColorPoint& right);
    void addDiverging(double begin, double end, glm::dvec3 from, glm::dvec3 to);
    glm::dvec3 mixable(const glm::dvec3& rgb) const;
    glm::dvec3 linear(const glm::dvec3& mixed) const;

    ColorSpace space_;
    bool linearColors_;
    TransferFunction::ColorPoint first_, last_;
    std::vector<Stretch> stretches_;  // each of length > 0
};

/// Returns the CIEDE2000 difference of two colours of L*a*b*, with all weights 1.
double colorDifference(const glm::dvec3& lab1, const glm::dvec3& lab2);

/// Finds the shortest ways between colours (CIEDE2000) on a grid of 17 levels per channel.
class ColorPaths {
  public:
    struct Stop {
        glm::dvec3 rgb{0.0};  ///< sRGB
        double share = 0;     ///< of the way that lies before this stop, 0..1
    };

    ColorPaths();

    /// Returns the stops of the way. The two colours replace the grid points nearest to them.
    /// @param from, to  sRGB, each 0..1
    std::vector<Stop> between(const glm::dvec3& from, const glm::dvec3& to);

  private:
    static constexpr int kLevels = 17;
    static constexpr int kPoints = kLevels * kLevels * kLevels;
    static constexpr int kNeighbours = 27;  // including the point itself

    double stepLength(int point, int neighbour, int other);
    std::vector<int> pointsBetween(int from, int to);

    std::vector<glm::dvec3> lab_;  // [kPoints]
    std::vector<double> steps_;    // [kPoints][kNeighbours], below 0 until computed
};

}  // namespace deltasplat
