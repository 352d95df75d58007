// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace deltasplat {

/// Limits this process's memory wherever the library asks before it allocates: work beyond the
/// limit is refused up front with Error(kFailed). For the whole process, not thread-safe.
/// @param bytes  of the whole process, its libraries included; 0: no limit but the machine's
void setMemoryLimit(std::uint64_t bytes);

/// Returns the limit set; 0 if there is none.
std::uint64_t memoryLimit();

}  // namespace deltasplat
