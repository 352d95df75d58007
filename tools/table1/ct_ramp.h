// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Returns the transfer function of examples/ct.json, so that it is there without the file: clear
/// below 22 % of the range, then translucent tissue, then denser white; normalized, linear colours.
TransferFunction ctRamp();

}  // namespace deltasplat
