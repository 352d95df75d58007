// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume/code_tree.h"

namespace deltasplat {

/// Gives a volume whose codes were cut a source in which no more is active than in those, and the
/// smallest and largest value that is left in it.
/// @throw Error(kFailed) if it does not fit into memory
void cutSource(Volume& volume);

}  // namespace deltasplat
