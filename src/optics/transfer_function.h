// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Returns the position of x from a to b, 0..1. Halves keep the differences from overflowing.
inline double wayBetween(double a, double b, double x) {
    return (0.5 * x - 0.5 * a) / (0.5 * b - 0.5 * a);
}

/// Returns the defaultRange that all volumes of a type share; nothing if it depends on the values.
inline std::optional<glm::dvec2> rangeOfType(const std::string& type) {
    if (type == "uint8") return glm::dvec2(0, 255);
    return std::nullopt;
}

/// Returns whether a whole interval of values is clear. Blocks of such values show nothing.
/// @param hasRange  whether values may lie beyond the range that it is normalized to
bool hidesValues(const TransferFunction& function, bool hasRange);

/// Returns whether a value is known to be shown before its volume is read. False if the function is
/// normalized to the still unknown range of the volume's values.
/// @param range  Optics::range
/// @param type   Volume::type
bool showsValue(const TransferFunction& function, const std::optional<glm::dvec2>& range,
                const std::string& type, double value);

/// Returns the share of a volume's active voxels, 0..1, that a transfer function makes clear.
/// Voxels of the background, known or guessed (guessBackground), do not count.
/// @param range  Optics::range
double hiddenShare(const Volume& volume, const TransferFunction& function,
                   const std::optional<glm::dvec2>& range);

}  // namespace deltasplat
