// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Which codes are seen, asked for whole ranges.
class SeenCodes {
  public:
    /// @param isSeen  isSeen(code) for 0 .. kCodeCount - 1
    template <typename IsSeen>
    explicit SeenCodes(const IsSeen& isSeen) : before_(std::size_t(kCodeCount) + 1) {
        for (int code = 0; code < kCodeCount; ++code)
            before_[std::size_t(code) + 1] = before_[std::size_t(code)] + (isSeen(code) ? 1 : 0);
    }
    /// Whether any of lowest .. highest is.
    bool hasAny(Code lowest, Code highest) const {
        return before_[std::size_t(highest) + 1] != before_[lowest];
    }

  private:
    std::vector<int> before_;  // [code]: how many before it are seen
};

}  // namespace deltasplat
