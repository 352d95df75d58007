// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "deltasplat/progress.h"

namespace deltasplat {

/// Passes on warnings, each of them once.
class WarnOnce {
  public:
    /// @param listener  must live as long
    explicit WarnOnce(const Listener& listener) : listener_(listener) {}

    void warn(const std::string& text) {
        if (known_.insert(text).second) listener_.warn(text);
    }

  private:
    const Listener& listener_;
    std::set<std::string> known_;
};

}  // namespace deltasplat
