// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Returns the sRGB colours of a well-known colour map over 0..1: viridis, inferno, magma, plasma,
/// cividis or turbo. Of another name there are none.
std::vector<TransferFunction::ColorPoint> colorMap(const std::string& name);

}  // namespace deltasplat
