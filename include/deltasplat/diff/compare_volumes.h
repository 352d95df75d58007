// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <string>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// What compareVolumes counts and tolerates.
struct CompareOptions {
    double fail = 0;  ///< data units, at least 0: larger errors count in VolumeComparison::overFail
    double warn = 0;  ///< data units, at least 0: larger errors count in VolumeComparison::overWarn
    /// Voxels, at least 0: largest shift due to rounding, also from a whole number of voxels. The
    /// coarser transform's own rounding is always allowed.
    double shift = 1e-6;
    /// Binary digits of each transform's numbers: 24 in formats of 32-bit floats.
    int placeDigitsA = std::numeric_limits<double>::digits;
    int placeDigitsB = std::numeric_limits<double>::digits;
};

/// How two volumes differ. A voxel's error is |value in A - value in B|, in data units.
///
/// *Compared* voxels are active, or differ from the background, in A or in B: every voxel of a
/// dense volume; the active ones of a fog volume; band and inside of a level set. Other voxels are
/// background in both; the two backgrounds are compared once. Outside its box a dense volume (one
/// without background) is inactive, with the other's background (0 if both are dense).
struct VolumeComparison {
    std::uint64_t voxels = 0;  ///< number of compared voxels
    double meanError = 0;
    double rmsError = 0;
    double maxError = 0;
    glm::ivec3 maxAt{0};     ///< where: the voxel of smallest z, then y, then x;
                             ///< (0,0,0) if maxError is 0
    double valueA = 0;       ///< value of A at maxAt, if maxError is not 0
    double valueB = 0;       ///< value of B at maxAt, if maxError is not 0
    std::string valueTextA;  ///< valueA as a decimal number, exact for 64-bit integers too
    std::string valueTextB;
    std::uint64_t overFail = 0;  ///< compared voxels whose error is above CompareOptions::fail
    std::uint64_t overWarn = 0;  ///< compared voxels whose error is above CompareOptions::warn
    std::uint64_t activeMismatch = 0;  ///< voxels that are active in one volume only
    double backgroundError = 0;        ///< |background of A - of B|; 0 if one of them is dense
    /// A's index of B's voxel (0,0,0): not 0 if B is shifted in the world by whole voxels.
    glm::ivec3 offset{0};
    /// Largest world distance, in units of the smallest voxel size, between A's and B's place of a
    /// corner of the box around both, after `offset`.
    double shift = 0;

    /// `shift` is at most CompareOptions::shift, or the transforms' numbers differ by at most half
    /// a unit of the last digit of the coarser one.
    bool transformEqual = true;
    bool sizeEqual =
        true;  ///< boxes are equal after `offset`; always true unless both volumes are dense
    bool typeEqual = true;  ///< value types have the same name
    bool classEqual = true;
    bool nameEqual = true;

    /// Whether every value, active state, background, size and place agrees; names may differ.
    bool equal() const {
        return maxError == 0 && activeMismatch == 0 && backgroundError == 0 && sizeEqual &&
               transformEqual;
    }
};

/// Compares two volumes voxel by voxel, at equal indices. If transforms differ by whole voxels, as
/// of a .vdb and a dense file made from it, voxels at the same world place, or within half a voxel
/// of it, are compared (B is then copied). Values come from `source` if it is there, inactive ones
/// included, else from codes, with the background in inactive voxels. Tiles are compared as tiles,
/// so the extent of a box has no influence. Differences of 64-bit integers are exact before they
/// become a double. Infinities and NaN, which only inactive voxels can hold, equal themselves;
/// other differences that are not finite count as the largest double. 0 equals -0. If both volumes
/// name a patient's coordinate system, one is used. Bit-identical for any number of threads.
/// @throw whatever `listener.progress` throws
VolumeComparison compareVolumes(const Volume& a, const Volume& b,
                                const CompareOptions& options = {}, const Listener& listener = {});

}  // namespace deltasplat
