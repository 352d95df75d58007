// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <csignal>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void rememberInterrupt(int /*signal*/) {
    interrupted = 1;
}

void catchOnce(int signal) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    // A job put into the background by a script has the signal ignored, and is to keep it so.
    if (before.sa_handler == SIG_IGN) return;
    struct sigaction action {};
    action.sa_handler = rememberInterrupt;
    // Without SA_RESTART what waits in a system call wakes up and sees the interrupt.
    action.sa_flags = SA_RESETHAND;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
}

}  // namespace

void handleSignals() {
    catchOnce(SIGINT);
    catchOnce(SIGTERM);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

bool isInterrupted() {
    return interrupted != 0;
}

void throwIfInterrupted() {
    if (isInterrupted()) throw Error(ErrorCode::kInterrupted, "interrupted");
}

}  // namespace deltasplat
