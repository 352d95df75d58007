// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace deltasplat {

/// What a long-running call tells its caller. Both members may be empty.
struct Listener {
    /// Receives the share done, 0..1, never falling. Called from one thread at a time, not always
    /// the same. May throw (`Error` with `kInterrupted`) to stop the work; nothing is left behind.
    std::function<void(double)> progress;
    /// Receives a one-line remark that is no error, without prefix or line end; it names options as
    /// Error.
    std::function<void(const std::string&)> warning;

    void report(double share) const {
        if (progress) progress(share);
    }
    void warn(const std::string& line) const {
        if (warning) warning(line);
    }
};

}  // namespace deltasplat
