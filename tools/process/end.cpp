// SPDX-License-Identifier: Apache-2.0
#include "process/end.h"

#include <cstdio>
#include <cstdlib>

namespace deltasplat {

void endProgram(int exitCode) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    std::exit(exitCode);
#else
    std::fflush(nullptr);
    std::_Exit(exitCode);
#endif
}

}  // namespace deltasplat
