// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/diff/compare_volumes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "default_floats.h"
#include "diff/compare_trees.h"
#include "diff/error_sums.h"
#include "diff/voxel_source.h"
#include "length_unit.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

// How many of one's units of length another's is, where both are known.
double unitFactor(const Volume& other, const Volume& volume) {
    if (other.lengthUnit == volume.lengthUnit) return 1;
    const double from = millimetresIn(volume.lengthUnit), to = millimetresIn(other.lengthUnit);
    return from > 0 && to > 0 ? from / to : 1;
}

// Turns a patient's coordinates from one system into the other: both have z up, and x and y run
// against each other. Lengths are those of the other's unit then.
glm::dmat4 inSpaceOf(const Volume& other, const Volume& volume) {
    const bool turned =
        !volume.space.empty() && !other.space.empty() && volume.space != other.space;
    const double unit = unitFactor(other, volume);
    if (!turned && unit == 1) return volume.worldFromIndex;
    glm::dmat4 turn(1.0);
    turn[0][0] = turn[1][1] = turned ? -unit : unit;
    turn[2][2] = unit;
    return turn * volume.worldFromIndex;
}

IndexBox movedBox(const IndexBox& box, const glm::ivec3& offset) {
    return box.empty() ? box : IndexBox{box.min + offset, box.max + offset};
}

// Returns how far apart the places of B's voxels are from those of A's that lie `offset` further
// on. The map between both places is affine, so the corners move farthest.
double shiftOf(const Volume& a, const Volume& b, const glm::ivec3& offset) {
    const glm::dmat4 placeA = glm::translate(a.worldFromIndex, glm::dvec3(offset));
    const glm::dmat4 placeB = inSpaceOf(a, b);
    if (placeA == placeB) return 0;
    const glm::dmat4 moved = placeB - placeA;
    IndexBox box = boxOfBoth(movedBox(a.box, -offset), b.box);
    // Without any voxels, a transform is where its first ones would be.
    if (box.empty()) box = {glm::ivec3(0), glm::ivec3(1)};
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(cornerOf(box, corner), 1);
        farthest = std::max(farthest, glm::length(glm::dvec3(moved * index)));
    }
    const double voxel = std::min(smallestSize(a), unitFactor(a, b) * smallestSize(b));
    return std::min(farthest / voxel, std::numeric_limits<double>::max());
}

// Returns the whole number of voxels that is nearest to the way from A's voxel (0,0,0) to B's; 0 if
// indices do not reach so far.
glm::ivec3 nearestOffset(const Volume& a, const Volume& b) {
    const glm::dvec3 way(inSpaceOf(a, b)[3] - a.worldFromIndex[3]);
    const glm::dvec3 voxels = glm::round(glm::inverse(glm::dmat3(a.worldFromIndex)) * way);
    constexpr double kMost = 0x1p29;
    const bool inReach =
        std::max({std::abs(voxels.x), std::abs(voxels.y), std::abs(voxels.z)}) <= kMost;
    return inReach ? glm::ivec3(voxels) : glm::ivec3(0);
}

void takePlaces(const Volume& a, const Volume& b, const CompareOptions& options,
                VolumeComparison& result) {
    result.shift = shiftOf(a, b, glm::ivec3(0));
    if (result.shift > options.shift) {
        const glm::ivec3 offset = nearestOffset(a, b);
        const double rest = shiftOf(a, b, offset);
        if (rest <= options.shift) {
            result.offset = offset;
            result.shift = rest;
        }
    }
    result.transformEqual = result.shift <= options.shift;
    result.sizeEqual =
        a.hasBackground || b.hasBackground || a.box == movedBox(b.box, result.offset);
}

void takeSums(const ErrorSums& sums, VolumeComparison& result) {
    result.voxels = sums.voxels;
    if (sums.voxels > 0) {
        // Rounding must not make a mean larger than the largest.
        const long double count = static_cast<long double>(sums.voxels);
        result.meanError = std::min(double(sums.sum / count), sums.max);
        result.rmsError = std::min(double(std::sqrt(sums.sumOfSquares / count)), sums.max);
    }
    result.maxError = sums.max;
    result.maxAt = {sums.maxAt.x(), sums.maxAt.y(), sums.maxAt.z()};
    result.valueA = sums.maxA.rounded();
    result.valueB = sums.maxB.rounded();
    result.valueTextA = sums.maxA.text();
    result.valueTextB = sums.maxB.text();
    result.overFail = sums.overFail;
    result.overWarn = sums.overWarn;
    result.activeMismatch = sums.activeMismatch;
}

}  // namespace

VolumeComparison compareVolumes(const Volume& a, const Volume& b, const CompareOptions& options,
                                const Listener& listener) {
    const DefaultFloats floats;
    const bool wide = holdsInt64(a) || holdsInt64(b);
    // A dense volume says nothing about a background, so it takes the other's.
    const WideValue backgroundA = backgroundOf(a.hasBackground ? a : b, wide);
    const WideValue backgroundB = backgroundOf(b.hasBackground ? b : a, wide);
    const ErrorTerms terms{backgroundA, backgroundB, options.fail, options.warn, wide};

    VolumeComparison result;
    takePlaces(a, b, options, result);
    const openvdb::Coord offset(result.offset.x, result.offset.y, result.offset.z);
    takeSums(compareTrees({a, wide, backgroundA}, {b, wide, backgroundB, offset}, terms, listener),
             result);
    result.backgroundError = errorOf(backgroundA, backgroundB);
    result.typeEqual = a.type == b.type;
    result.classEqual = a.gridClass == b.gridClass;
    result.nameEqual = a.name == b.name;
    return result;
}

}  // namespace deltasplat
