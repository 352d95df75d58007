// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// @throw Error(kUsage) naming the option that is out of range
void checkOptics(const Optics& optics);

}  // namespace deltasplat
