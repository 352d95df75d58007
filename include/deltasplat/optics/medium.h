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

/// An absorbing or glowing grid that joins the volume in one medium: extinctions add up, and all
/// parts dim all light. A grid may lie anywhere in the world. It is read at the volume's voxels:
/// linearly between the grid's voxels, or as the mean of the grid's voxels inside one.
struct MediumPart {
    enum class Kind {
        kAbsorption,  ///< like a volume: a transfer function's colours and opacities
        /// Absorbs nothing; shines in a transfer function's colours times opacities times
        /// `strength` per unit distance.
        kEmission,
        /// Shines as a black body of a temperature in kelvin, in colours of luminance 1; absorbs
        /// nothing. Radiance per unit distance is strength * 5.670374e-14 T^4 / pi, as in Cycles:
        /// 0.091 at 1500 K. It fades out from 798 K (Draper's point, first visible glow) to 500 K.
        kBlackbody,
    };

    std::shared_ptr<const Volume> volume;
    Kind kind = Kind::kBlackbody;
    TransferFunction transferFunction;  ///< not for black bodies
    /// Data values of 0 and 1 of a normalized transfer function; empty: defaultRange.
    std::optional<glm::dvec2> range;
    double strength = 1;     ///< 0..kMostLight; for absorption it scales the extinction
    double kelvinScale = 1;  ///< black bodies: kelvin = scale * value + offset
    double kelvinOffset = 0;
};

/// Grids of red, green and blue, scene-linear, >= 0, that multiply the volume's colours. Colours do
/// not change where no voxel of a grid is near.
using ColorGrids = std::array<std::shared_ptr<const Volume>, 3>;

/// Most parts beside the volume: three, or one with colour grids.
inline constexpr int kMostParts = 3;
inline constexpr int kMostPartsWithColors = 1;

/// Glow below this sum over the longest way through the volume counts as none.
inline constexpr double kLeastGlow = 0x1p-20;

}  // namespace deltasplat
