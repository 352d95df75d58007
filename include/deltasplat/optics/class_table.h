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

/// Classified colours: premultiplied integer RGBA with one scale a channel. Codes that look alike
/// share a class, so that they make no deltas; class 0 is what cannot be seen.
struct ClassTable {
    using Color = std::array<std::int16_t, 4>;
    static constexpr int kMax = 32767;  ///< the largest value of each channel that is not all zero
    /// Classes are numbered with 16 bits. Where all 65536 codes look different, the last two share
    /// a class.
    static constexpr int kMaxClasses = 65536;

    /// Premultiplied RGBA of each class for one slice; entry 0 is zero. No two are alike.
    std::vector<Color> colors{Color{}};
    /// [kSlotCount]: the class of every slot, the map that `DeltaOptions::slotMap` takes. 0 for
    /// slot 0, for codes that do not occur and for clear ones.
    std::vector<Slot> classOfSlot;
    /// Value of one integer unit of each channel; 0 for a channel that is zero throughout.
    glm::dvec4 scale{0.0};
    /// All classes have one colour and differ in opacity alone. Then a class's number is its
    /// opacity, and its channels are equal wherever the scale is not 0; all opacities have a class.
    bool oneColor = false;

    const Color& colorOfCode(Code code) const { return colors[classOfSlot[code + 1]]; }
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

/// Classifies every code that occurs in the volume: extinction per world unit sigma_t = -ln(1 -
/// opacity) / unitDistance * extinctionScale, alpha = 1 - exp(-sigma_t * sliceStepWorld). Opacity 1
/// stays 1 at any step, as long as the extinction is not scaled to 0. Deterministic;
/// multi-threaded.
/// @param sliceStepWorld  world distance between consecutive slices along the line of sight, > 0
/// @throw Error(kUsage) naming the option if unit distance, extinction or range is out of range
ClassTable classify(const Volume& volume, const Optics& optics, double sliceStepWorld);

}  // namespace deltasplat
