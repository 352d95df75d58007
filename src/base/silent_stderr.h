// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// While an object lives, standard error goes nowhere, for all threads. Meant for libraries that
/// print there and cannot be told not to.
class SilentStderr {
  public:
    SilentStderr();
    ~SilentStderr();
    SilentStderr(const SilentStderr&) = delete;
    SilentStderr& operator=(const SilentStderr&) = delete;

  private:
    int before_ = -1;
};

}  // namespace deltasplat
