// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Whether a transfer function makes a stretch of values clear, not only single ones: of blocks
/// whose values all lie in it nothing is shown.
/// @param hasRange  whether it is normalized to a range beyond which there may be values
bool hidesValues(const TransferFunction& function, bool hasRange);

}  // namespace deltasplat
