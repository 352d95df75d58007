// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cfenv>

namespace deltasplat {

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
