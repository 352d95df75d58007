// SPDX-License-Identifier: Apache-2.0
#include "heap_growth.h"

#include <cstdlib>

namespace deltasplat {

#ifdef __GLIBC__
void expectPieces(std::size_t bytes) {
    // Where it does not fit into what is left of the 64 MiB that are mapped at a time, nothing is
    // gained: small beside those.
    constexpr std::size_t kStep = std::size_t{1} << 20;
    thread_local std::size_t left = 0;
    if (bytes <= left) {
        left -= bytes;
        return;
    }
    left = kStep > bytes ? kStep - bytes : 0;
    // What is given back stays the heap's, for it is less than what goes back to the system. (Where
    // the piece was mapped by itself, glibc maps none of its size any more once it is back.) No
    // compiler may leave this out.
    void* volatile step = std::malloc(kStep);
    std::free(step);
}
#else
void expectPieces(std::size_t) {}
#endif

}  // namespace deltasplat
