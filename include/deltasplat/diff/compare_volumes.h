// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <string>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// What compareVolumes counts, and what it lets through.
struct CompareOptions {
    double fail = 0;  ///< data units, at least 0: larger errors count in VolumeComparison::overFail
    double warn = 0;  ///< data units, at least 0: larger errors count in VolumeComparison::overWarn
    /// Voxels, at least 0: the largest shift that is rounding only, also from a whole number of
    /// voxels. What the coarser of the two transforms cannot hold is rounding anyway.
    double shift = 1e-6;
    /// Binary digits of the numbers of which each transform is made: in formats that hold them as
    /// 32-bit floats, 24.
    int placeDigitsA = std::numeric_limits<double>::digits;
    int placeDigitsB = std::numeric_limits<double>::digits;
};

/// How two volumes differ. A voxel's error is |value in A - value in B|, in data units.
///
/// *Compared* voxels are those that are active or hold another value than the background in A or in
/// B: every voxel of a dense volume; the active ones of a fog volume; band and inside of a level
/// set. All others are background in both, and the two backgrounds are compared once. A dense
/// volume (one without background) has no voxels outside its box; there, it takes part as inactive
/// voxels of the other volume's background (0 if both are dense).
struct VolumeComparison {
    std::uint64_t voxels = 0;    ///< compared ones
    double meanError = 0;        ///< mean of the errors over the compared voxels
    double rmsError = 0;         ///< root of the mean of the squared errors
    double maxError = 0;         ///< largest error
    glm::ivec3 maxAt{0};         ///< where: the voxel of smallest z, then y, then x;
                                 ///< (0,0,0) if maxError is 0
    double valueA = 0;           ///< value of A at maxAt, if maxError is not 0
    double valueB = 0;           ///< value of B at maxAt, if maxError is not 0
    std::string valueTextA;      ///< valueA as a decimal number, exact for 64-bit integers too
    std::string valueTextB;      ///< likewise valueB
    std::uint64_t overFail = 0;  ///< compared voxels whose error is above CompareOptions::fail
    std::uint64_t overWarn = 0;  ///< compared voxels whose error is above CompareOptions::warn
    std::uint64_t activeMismatch = 0;  ///< voxels that are active in one volume only
    double backgroundError = 0;        ///< |background of A - of B|; 0 if one of them is dense
    /// A's index of the voxel that is (0,0,0) in B: not 0 if B's indices count from elsewhere in
    /// the world, by whole voxels.
    glm::ivec3 offset{0};
    /// Largest distance between the places in the world that A and B give a corner of the box that
    /// holds both, `offset` taken into account, in units of the smallest voxel size.
    double shift = 0;

    /// `shift` is at most CompareOptions::shift, or no number of either transform differs by more
    /// than half a unit of the last digit of the coarser one.
    bool transformEqual = true;
    bool sizeEqual = true;   ///< boxes are equal, `offset` taken into account; always true
                             ///< unless both volumes are dense
    bool typeEqual = true;   ///< value types have the same name
    bool classEqual = true;  ///< grid classes have the same name
    bool nameEqual = true;   ///< grids have the same name

    /// Whether everything but the names of types, classes and grids agrees: every value, active
    /// state, background, size and place.
    bool equal() const {
        return maxError == 0 && activeMismatch == 0 && backgroundError == 0 && sizeEqual &&
               transformEqual;
    }
};

/// Compares two volumes voxel by voxel: those of the same indices, or if their transforms differ by
/// whole voxels, as those of a .vdb and of a dense file made from it do, those at the same place in
/// the world, or within half a voxel of it (B is then copied). Where a volume has `source`, its own
/// values are taken, inactive ones included, otherwise those that its codes stand for (inactive
/// voxels then hold the background). Tiles are compared as tiles, so that nothing depends on the
/// extent of a box. Differences of 64-bit integers are exact before they become a double.
/// Infinities and NaN, which only inactive voxels can hold, equal themselves; any other difference
/// that is no finite number counts as the largest double. 0 equals -0. If both volumes name their
/// patient's coordinate system, they are compared in one.
///
/// The result is the same to the last bit for any number of threads.
/// @throw whatever `listener.progress` throws
VolumeComparison compareVolumes(const Volume& a, const Volume& b,
                                const CompareOptions& options = {}, const Listener& listener = {});

}  // namespace deltasplat
