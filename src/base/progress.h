// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>

#include "deltasplat/progress.h"

namespace deltasplat {

using Clock = std::chrono::steady_clock;

/// Returns the wall-clock seconds that have passed since `start`.
inline double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns a listener for a part of the work. Its progress 0..1 is reported as `from`..`to`.
/// @param listener  outlives the returned one
inline Listener partOf(const Listener& listener, double from, double to) {
    return {[&listener, from, to](double share) { listener.report(from + (to - from) * share); },
            listener.warning};
}

/// Reports the progress of several threads to a listener: one call at a time, never falling. No
/// thread waits for a slow listener; reports that come meanwhile are left out.
class SharedProgress {
  public:
    explicit SharedProgress(const Listener& listener) : listener_(listener) {}

    /// @throw what the listener throws
    void report(double share) {
        if (telling_.test_and_set(std::memory_order_acquire)) return;
        const Release release{telling_};
        told_ = std::max(told_, share);
        listener_.report(told_);
    }

  private:
    struct Release {
        std::atomic_flag& flag;
        ~Release() { flag.clear(std::memory_order_release); }
    };

    const Listener& listener_;
    // No mutex: a listener may call the library, and this thread may then report here again.
    std::atomic_flag telling_ = ATOMIC_FLAG_INIT;
    double told_ = 0;
};

}  // namespace deltasplat
