// SPDX-License-Identifier: Apache-2.0
// Answers --version without what all else needs.
#include <csignal>
#include <cstdio>

#include "deltasplat/error.h"
#include "process/print_out.h"
#include "version.h"

int main() {
    using namespace deltasplat;
    std::signal(SIGPIPE, SIG_IGN);
    try {
        printOut(versionText() + "\n");
        return 0;
    } catch (const Error& error) {
        if (isReaderGone()) return 128 + SIGPIPE;
        std::fprintf(stderr, "deltasplat: %s\n", error.what());
        return 4;
    }
}
