// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>
#include <sys/resource.h>

#include <string>

#include "deltasplat/error.h"

namespace deltasplat::test {

/// While it lives, this process can write files of at most `bytes`; more is an error (EFBIG).
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        oldHandler_ = ::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        ::signal(SIGXFSZ, oldHandler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    rlimit old_{};
    void (*oldHandler_)(int) = SIG_DFL;
};

/// Returns what the code is called: "output" for ErrorCode::kOutput.
inline std::string codeName(ErrorCode code) {
    switch (code) {
        case ErrorCode::kFailed:
            return "failed";
        case ErrorCode::kUsage:
            return "usage";
        case ErrorCode::kInput:
            return "input";
        case ErrorCode::kOutput:
            return "output";
        case ErrorCode::kInterrupted:
            return "interrupted";
    }
    return "unknown";
}

/// Returns "<code's name>: <message>" of the Error that `action` throws, or "no error".
template <typename Action>
std::string errorOf(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return codeName(error.code()) + ": " + error.what();
    }
    return "no error";
}

}  // namespace deltasplat::test
