// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "deltasplat/progress.h"

namespace deltasplat {

/// Tells a listener how far several threads are: from one at a time, never falling. No thread waits
/// for a listener that takes its time; what would be told meanwhile is left out.
class SharedProgress {
  public:
    explicit SharedProgress(const Listener& listener) : listener_(listener) {}

    /// @throw what the listener throws
    void report(double share) {
        const std::unique_lock lock(telling_, std::try_to_lock);
        if (!lock.owns_lock() || share < told_) return;
        told_ = share;
        listener_.report(share);
    }

  private:
    const Listener& listener_;
    std::mutex telling_;
    double told_ = 0;
};

}  // namespace deltasplat
