// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

namespace deltasplat {

/// Sets what a signal does. What waits in a system call goes on waiting: libraries take an
/// interrupted read for an error.
inline void handleSignal(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
}

}  // namespace deltasplat
