// SPDX-License-Identifier: Apache-2.0
// Based on: M. Zeyen, T. Post, H. Hagen, J. Ahrens, D. Rogers and R. Bujack, "Color Interpolation
// for Non-Euclidean Color Spaces", IEEE VIS 2018; and G. Sharma, W. Wu and E. N. Dalal, "The
// CIEDE2000 Color-Difference Formula", 2005.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace deltasplat {

/// Returns the CIEDE2000 difference of two colours of L*a*b*, with all weights 1.
double colorDifference(const glm::dvec3& lab1, const glm::dvec3& lab2);

/// Finds the shortest ways between colours, as CIEDE2000 measures them, over a grid of 17 levels a
/// channel; a step goes to one of 26 neighbours.
class ColorPaths {
  public:
    struct Stop {
        glm::dvec3 rgb{0.0};  ///< sRGB
        double share = 0;     ///< of the way that lies before it, 0..1
    };

    ColorPaths();

    /// Returns the stops of the way, the two colours included: they take the places of the points
    /// of the grid that are nearest to them.
    /// @param from, to  sRGB, each 0..1
    std::vector<Stop> between(const glm::dvec3& from, const glm::dvec3& to);

  private:
    static constexpr int kLevels = 17;
    static constexpr int kPoints = kLevels * kLevels * kLevels;
    static constexpr int kNeighbours = 27;  // the point itself among them

    double stepLength(int point, int neighbour, int other);
    std::vector<int> pointsBetween(int from, int to);

    std::vector<glm::dvec3> lab_;  // [kPoints]
    std::vector<double> steps_;    // [kPoints][kNeighbours], less than 0 if not yet asked for
};

}  // namespace deltasplat
