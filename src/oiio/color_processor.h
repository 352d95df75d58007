// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "files/file_bytes.h"

namespace deltasplat {

/// A file that is in memory only, for writers that write to nothing but files with names.
class MemoryFile {
  public:
    /// @throw Error(kFailed) if the system makes none
    MemoryFile();

    /// The name under which this process can open it, as long as this object lives.
    std::string name() const { return "/proc/self/fd/" + std::to_string(file_.get()); }
    /// Returns all that was written.
    /// @throw Error(kFailed) if it cannot be read
    std::string bytes() const;

  private:
    Descriptor file_;
};

}  // namespace deltasplat
