// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace deltasplat {

/// Limits the threads for the calling thread's requests to the library, while this object lives.
/// The last limit made counts; limits may end in any order. Each thread has its own limits, or
/// none; all requests together never use more than the largest. Results never depend on it.
class ThreadLimit {
  public:
    /// @param threads  at least 1, or 0 for all hardware threads
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

    /// Returns the threads that 0 stands for: cores of the affinity, or of the cgroup if fewer.
    static int hardwareThreads();

    struct Impl;

  private:
    std::shared_ptr<Impl> impl_;
};

/// Returns how many threads the library would now use for the calling thread's requests.
int threadCount();

}  // namespace deltasplat
