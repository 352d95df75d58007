// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// How far x is on the way from a to b, 0..1; halves, so that no difference overflows.
inline double wayBetween(double a, double b, double x) {
    return (0.5 * x - 0.5 * a) / (0.5 * b - 0.5 * a);
}

/// Returns what defaultRange is of all volumes of a type; nothing if it is that of their values.
inline std::optional<glm::dvec2> rangeOfType(const std::string& type) {
    if (type == "uint8") return glm::dvec2(0, 255);
    return std::nullopt;
}

/// Whether a transfer function makes a stretch of values clear, not only single ones: of blocks
/// whose values all lie in it nothing is shown.
/// @param hasRange  whether it is normalized to a range beyond which there may be values
bool hidesValues(const TransferFunction& function, bool hasRange);

/// Whether a value is shown, as far as that is known before its volume is: not where the range that
/// a normalized transfer function has is that of the volume's values.
/// @param range  Optics::range
/// @param type   Volume::type
bool showsValue(const TransferFunction& function, const std::optional<glm::dvec2>& range,
                const std::string& type, double value);

/// Returns the share of a volume's active voxels that a transfer function makes clear, 0..1. Voxels
/// of the background do not count, nor those of a guessed one (guessBackground).
/// @param range  Optics::range
double hiddenShare(const Volume& volume, const TransferFunction& function,
                   const std::optional<glm::dvec2>& range);

}  // namespace deltasplat
