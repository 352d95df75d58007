// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace deltasplat {

/// Limits the number of threads that the library uses while this object lives. Results never depend
/// on it.
class ThreadLimit {
  public:
    /// @param threads  at least 1, or 0 for all hardware threads
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

    /// Returns how many threads 0 stands for.
    static int hardwareThreads();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Returns how many threads the library would use now.
int threadCount();

}  // namespace deltasplat
