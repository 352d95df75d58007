// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "descriptor.h"
#include "temporary_list.h"

namespace deltasplat {

/// Keeps a name in a folder to one at a time of those who ask for it, in whatever process: the
/// others wait. It is the lock (flock) of a file `.deltasplat.<name>.pair.tmp`, which is there as
/// long as somebody has it or waits; what a killed process leaves is used by the next one. Where
/// the file system has no locks nobody waits.
class NameLock {
  public:
    /// @param name       its folder must outlive this
    /// @param finalPath  for messages
    /// @throw Error(kOutput) if the file can neither be made nor opened
    NameLock(const NameInFolder& name, const std::filesystem::path& finalPath);
    ~NameLock();
    NameLock(const NameLock&) = delete;
    NameLock& operator=(const NameLock&) = delete;

  private:
    int folder_;
    std::string file_;
    Descriptor lock_;
    int place_ = -1;  // in the list of all temporary files
};

}  // namespace deltasplat
