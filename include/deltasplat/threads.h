// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace deltasplat {

/// Limits the number of threads that the library uses for what the calling thread asks of it, while
/// this object lives. Of several the last made counts; they may end in any order. Other threads
/// have limits of their own, or none; while there are any, the process has no more threads for all
/// of this than the largest. Results never depend on it.
class ThreadLimit {
  public:
    /// @param threads  at least 1, or 0 for all hardware threads
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

    /// Returns how many threads 0 stands for: the cores of its affinity, or of its cgroup if fewer.
    static int hardwareThreads();

    struct Impl;

  private:
    std::shared_ptr<Impl> impl_;
};

/// Returns how many threads the library would use now for what the calling thread asks of it.
int threadCount();

}  // namespace deltasplat
