// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cfenv>
#include <cstddef>
#include <functional>

namespace deltasplat {

/// Calls body(i) for every i in [0, count), on all threads, in any order. Once all threads have
/// stopped, rethrows the first exception of a body.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

/// Calls body(begin, end) for short pieces that cover [0, count), as parallelFor does. Meant for
/// many small items.
void parallelForChunks(std::size_t count,
                       const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body. While this thread waits for other threads in it, the thread takes on no other work,
/// so that a lock may be held meanwhile.
void isolated(const std::function<void()>& body);

/// While an object lives, its thread rounds to nearest, keeps denormals and traps nothing, whatever
/// the caller has set; the caller's state comes back at the end. Every function of the library that
/// makes numbers for pixels or files holds one, and so does every piece of parallel work.
class DefaultFloats {
  public:
    DefaultFloats() {
        std::fegetenv(&callers_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~DefaultFloats() { std::fesetenv(&callers_); }
    DefaultFloats(const DefaultFloats&) = delete;
    DefaultFloats& operator=(const DefaultFloats&) = delete;

  private:
    std::fenv_t callers_;
};

}  // namespace deltasplat
