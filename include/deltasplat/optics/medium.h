// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// What a grid adds to a medium that the volume is the first part of: something that swallows
/// light, or fire. All parts together are one medium: where several are, extinctions add up, and
/// what shines is dimmed by all of them. A grid may lie in the world as it likes; it is read at the
/// volume's voxels, between its own linearly, or as the mean of those that fall into one.
struct MediumPart {
    enum class Kind {
        kAbsorption,  ///< as a volume: a transfer function's colours and opacities
        /// Shines in a transfer function's colours times their opacities, times `strength`, on each
        /// unit distance. Swallows nothing.
        kEmission,
        /// Shines as a black body of so many kelvin; swallows nothing. Its radiance on each unit
        /// distance is strength * 5.670374e-14 T^4 / pi, as Cycles has it: 0.091 at 1500 K; from
        /// 798 K (Draper's point, below which nothing is seen to glow) down to 500 K it fades out.
        /// Colours are those of black bodies, of luminance 1.
        kBlackbody,
    };

    std::shared_ptr<const Volume> volume;
    Kind kind = Kind::kBlackbody;
    TransferFunction transferFunction;  ///< not of black bodies
    /// Data values of 0 and 1 of a normalized transfer function; empty: defaultRange.
    std::optional<glm::dvec2> range;
    double strength = 1;     ///< 0..kMostLight; of absorption it scales the extinction
    double kelvinScale = 1;  ///< of black bodies: kelvin = scale * value + offset
    double kelvinOffset = 0;
};

/// Grids whose values the colours of a volume are multiplied by: red, green and blue, scene-linear,
/// at least 0. Where none of their voxels is near, colours stay as they are.
using ColorGrids = std::array<std::shared_ptr<const Volume>, 3>;

/// Parts that there may be beside the volume: three, or one if there are colour grids.
inline constexpr int kMostParts = 3;
inline constexpr int kMostPartsWithColors = 1;

/// What glows less than this, summed up over the longest way through the volume, is not there.
inline constexpr double kLeastGlow = 0x1p-20;

}  // namespace deltasplat
