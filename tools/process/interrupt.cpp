// SPDX-License-Identifier: Apache-2.0
#include "process/interrupt.h"

#include <poll.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "process/handle_signal.h"

namespace deltasplat {
namespace {

enum State : int {
    kWorking,
    kInterrupted,
    kCommitting,  // a file has its final name
    kWritten      // all have
};
std::atomic<int> state{kWorking};
std::atomic<int> firstSignal{0};
std::atomic<bool> filesStand{false};

static_assert(std::atomic<int>::is_always_lock_free, "signal handlers cannot wait");

extern "C" {

// Ends the program, whatever it is in the middle of. Only what handlers may do.
static void endAtOnce(int signal) {
    // An alarm that nobody here has set.
    int before = 0;
    firstSignal.compare_exchange_strong(before, signal);
    if (state == kWritten) ::_exit(0);
    removeTemporaryFiles();
    constexpr std::string_view kLine = "deltasplat: interrupted\n";
    // Where nobody reads, there is nobody to wait for.
    pollfd reader{STDERR_FILENO, POLLOUT, 0};
    if (::poll(&reader, 1, 0) == 1) (void)!::write(STDERR_FILENO, kLine.data(), kLine.size());
    ::_exit(interruptExitCode());
}

static void hear(int signal) {
    int before = 0;
    firstSignal.compare_exchange_strong(before, signal);
    before = kWorking;
    const bool first = state.compare_exchange_strong(before, kInterrupted);
    if (!first && before == kInterrupted) endAtOnce(signal);
    // Within a second, of which the system takes what it needs to take gigabytes back. As safe in a
    // handler as alarm(), which Linux makes of it.
    constexpr itimerval kSoon{{0, 0}, {0, 300'000}};
    ::setitimer(ITIMER_REAL, &kSoon, nullptr);
}

}  // extern "C"

void handleUnlessIgnored(int signal) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    // A job put into the background by a script has the signal ignored, and is to keep it so.
    if (before.sa_handler != SIG_IGN) handleSignal(signal, hear);
}

// From here on the outcome is decided: a file with its final name, or an interrupt.
void passCommitGate() {
    if (filesStand) return throwIfInterrupted();
    int before = kWorking;
    if (!state.compare_exchange_strong(before, kCommitting) && before == kInterrupted)
        throwIfInterrupted();
}

}  // namespace

void handleSignals() {
    // One that was set before the program was started is not for it.
    ::alarm(0);
    handleUnlessIgnored(SIGINT);
    handleUnlessIgnored(SIGTERM);
    handleUnlessIgnored(SIGHUP);
    handleSignal(SIGALRM, endAtOnce);
    sigset_t alarm;
    sigemptyset(&alarm);
    sigaddset(&alarm, SIGALRM);
    sigprocmask(SIG_UNBLOCK, &alarm, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    setCommitGate(passCommitGate);
}

void interruptBetweenFiles() {
    filesStand = true;
}

void allIsWritten() {
    if (filesStand) return;
    int before = kCommitting;
    state.compare_exchange_strong(before, kWritten);
}

bool isInterrupted() {
    return state == kInterrupted;
}

int interruptExitCode() {
    return 128 + firstSignal;
}

void throwIfInterrupted() {
    if (isInterrupted()) throw Error(ErrorCode::kInterrupted, "interrupted");
}

}  // namespace deltasplat
