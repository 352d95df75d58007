// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace deltasplat::test {

/// Returns a memory limit of `more` bytes beyond what the process takes now, of which a sanitizer
/// takes hundreds of megabytes.
inline std::uint64_t memoryBeyond(std::uint64_t more) {
    std::uint64_t pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return resident * std::uint64_t(::sysconf(_SC_PAGESIZE)) + more;
}

}  // namespace deltasplat::test
