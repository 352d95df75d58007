// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace deltasplat {

/// Has what is allocated from now on, by all threads, lie in pages of 2 MiB, where the system gives
/// them on request (Linux, glibc): else it hands out memory by 4 KiB as they are first written to,
/// which takes longer than writing them (docs/performance.md). They are asked for by 31 MiB of a
/// thread's heap, and for each block from 32 MiB on, while twice as much lies free in such pages,
/// for making free ones takes longer still. Comes after reuseMemory.
void useLargePages();

/// Returns how many bytes lie free in pages of 2 MiB and larger ones; 0 where nobody says.
std::size_t bytesInFreeLargePages();

}  // namespace deltasplat
