// SPDX-License-Identifier: Apache-2.0
#include "process/reuse_memory.h"

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace deltasplat {

void reuseMemory() {
#ifdef __GLIBC__
    // The largest that glibc takes.
    constexpr int kMappedApart = 32 << 20;
    // Sheets, layers and the picture of most volumes together.
    constexpr int kKept = 256 << 20;
    mallopt(M_MMAP_THRESHOLD, kMappedApart);
    mallopt(M_TRIM_THRESHOLD, kKept);
#endif
}

void giveBackMemory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace deltasplat
