// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace deltasplat {

/// Lets work in while what all of it takes fits, in the order in which it comes; what does not fit
/// by itself waits until it is alone. Thread-safe.
class MemoryGate {
  public:
    /// @param bytes  that all work in progress may take
    explicit MemoryGate(std::uint64_t bytes) : most_(bytes) {}

    /// Work that has been let in, until it ends.
    class Pass {
      public:
        Pass(MemoryGate& gate, std::uint64_t bytes);
        ~Pass();
        Pass(const Pass&) = delete;
        Pass& operator=(const Pass&) = delete;

        /// Which share of all it takes, at most 1.
        double share() const;

      private:
        MemoryGate& gate_;
        std::uint64_t bytes_;
    };

  private:
    std::uint64_t most_;
    std::uint64_t taken_ = 0;
    std::uint64_t next_ = 0;    // to come
    std::uint64_t served_ = 0;  // of those that came
    std::mutex mutex_;
    std::condition_variable changed_;
};

}  // namespace deltasplat
