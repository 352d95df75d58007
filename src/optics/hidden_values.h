// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

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

}  // namespace deltasplat
