// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace deltasplat {

/// Limits the memory of this process, as far as the library is asked before it takes any: what
/// would lead beyond is refused up front with Error(kFailed). For the whole process, not
/// thread-safe.
/// @param bytes  of the process altogether, its libraries included; 0: no limit but the machine's
void setMemoryLimit(std::uint64_t bytes);

/// Returns the limit set; 0 if there is none.
std::uint64_t memoryLimit();

}  // namespace deltasplat
