// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "picture/draw_plan.h"

namespace deltasplat::test {

/// While one lives, slices of small volumes are joined as those of large ones are.
class SmallJoined {
  public:
    SmallJoined() : before_(leastVoxelsJoined.exchange(0)) {}
    ~SmallJoined() { leastVoxelsJoined = before_; }
    SmallJoined(const SmallJoined&) = delete;
    SmallJoined& operator=(const SmallJoined&) = delete;

  private:
    std::uint64_t before_;
};

}  // namespace deltasplat::test
