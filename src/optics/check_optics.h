// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// @throw Error(kUsage) naming what is out of range: unit distance, extinction, range, or points of
///        the transfer function (none, not finite, not in order)
void checkOptics(const Optics& optics);

}  // namespace deltasplat
