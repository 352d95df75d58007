// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

namespace deltasplat {

/// How many words several packers may store together.
class WordBudget {
  public:
    explicit WordBudget(double words) : most_(words), isSpent_(words <= 0) {}

    /// Takes some. Returns whether they, and all before them, may be stored.
    bool take(std::size_t words) {
        if (double(taken_ += words) > most_) isSpent_ = true;
        return !isSpent_;
    }
    /// Says that what was taken is so much of all that there will be: nothing may be stored where
    /// all is going to be too much.
    void foresee(double share) {
        if (double(taken_) > most_ * share) isSpent_ = true;
    }
    bool isSpent() const { return isSpent_; }

  private:
    double most_;
    std::atomic<std::size_t> taken_ = 0;
    std::atomic<bool> isSpent_;
};

}  // namespace deltasplat
