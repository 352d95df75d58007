// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Tells the C library, where it is one that can be told, to keep what is freed for what is
/// allocated next: large buffers that are given back to the system after each picture cost a page
/// fault for every 4 KiB of the next one (docs/performance.md).
void reuseMemory();

/// Gives back to the system what is kept so, for work that takes much of what there is.
void giveBackMemory();

}  // namespace deltasplat
