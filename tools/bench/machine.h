// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace deltasplat {

/// What times depend on besides the work. Names neither the host nor anything on it.
struct Machine {
    std::string cpu;  ///< model, as the system calls it
    int logicalCores = 0;
    std::string simd;               ///< SIMD level in use
    std::uint64_t memoryBytes = 0;  ///< physical memory; 0: not known
    std::string os;                 ///< "Debian GNU/Linux 12 (bookworm), Linux 6.1.0"
    std::string compiler;           ///< "GCC 12.2.0"
};

Machine thisMachine();

}  // namespace deltasplat
