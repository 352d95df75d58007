// SPDX-License-Identifier: Apache-2.0
#include "base/silent_stderr.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace deltasplat {
namespace {

// Two that overlap would put back the wrong one.
std::mutex& turn() {
    static std::mutex mutex;
    return mutex;
}

}  // namespace

SilentStderr::SilentStderr() {
    turn().lock();
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    before_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    if (before_ >= 0) ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
}

SilentStderr::~SilentStderr() {
    if (before_ >= 0) {
        std::fflush(stderr);
        ::dup2(before_, STDERR_FILENO);
        ::close(before_);
    }
    turn().unlock();
}

}  // namespace deltasplat
