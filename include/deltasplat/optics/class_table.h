// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "deltasplat/delta/delta_grid.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Classified colour of every slot: premultiplied integer RGBA with one scale a channel.
struct ClassTable {
    static constexpr int kMax = 65535;  ///< the largest entry of each channel that is not all zero

    /// [kSlotCount]: entry 0 (empty) is zero; entry code + 1 is that code's premultiplied RGBA for
    /// one slice.
    std::vector<std::array<std::uint16_t, 4>> entries;
    /// Value of one integer unit of each channel; 0 for a channel that is zero throughout.
    glm::dvec4 scale{0.0};
};

/// What turns data values into light.
struct Optics {
    TransferFunction transferFunction;
    /// Data values of 0 and 1 of a normalized transfer function, the first the smaller; empty:
    /// defaultRange.
    std::optional<glm::dvec2> range;
    std::optional<double>
        unitDistance;  ///< world units of one opacity step, > 0; empty: the smallest voxel size
    double extinctionScale = 1;  ///< >= 0; multiplies the extinction
};

/// Classifies every code that occurs in the volume (entries of the others are zero): extinction per
/// world unit sigma_t = -ln(1 - opacity) / unitDistance * extinctionScale, alpha = 1 - exp(-sigma_t
/// * sliceStepWorld). Opacity 1 stays 1 at any step, as long as the extinction is not scaled to 0.
/// @param sliceStepWorld  world distance between consecutive slices along the line of sight, > 0
/// @throw Error(kUsage) naming the option if unit distance, extinction or range is out of range
ClassTable classify(const Volume& volume, const Optics& optics, double sliceStepWorld);

/// Returns for every slot the smallest slot with the same entry (0 for those that are all zero),
/// the map that `DeltaOptions::slotMap` takes: two codes that look alike make no delta.
std::vector<Slot> mergeAlikeSlots(const ClassTable& table);

}  // namespace deltasplat
