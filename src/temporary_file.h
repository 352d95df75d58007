// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "descriptor.h"
#include "temporary_list.h"

namespace deltasplat {

/// A new, empty, locked file beside the one that it is to become, named
/// `.deltasplat.<name>.<number>.tmp`, removed by the destructor unless it was renamed. Its lock
/// (flock) ends with its process, however that ends: who can take it knows that nobody writes the
/// file any more. That is how creating one removes what dead processes left of the same name,
/// whatever machine or container they ran on, as long as the file system has locks; where it has
/// none, nothing is removed.
class TemporaryFile {
  public:
    /// @param folder     a descriptor of the folder, which must outlive this
    /// @param mode       permissions, less the umask
    /// @param finalPath  for messages
    /// @throw Error(kOutput) if it cannot be created
    TemporaryFile(int folder, const std::string& name, mode_t mode,
                  const std::filesystem::path& finalPath);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::string& name() const { return name_; }
    int descriptor() const { return file_.get(); }
    /// Returns whether a name in the folder is of this very file.
    bool isAt(const std::string& name) const;
    /// Says that the file now has another name, or none: there is nothing to remove.
    void release();

  private:
    bool create(const std::string& name, mode_t mode);

    int folder_;
    std::string name_;
    Descriptor file_;
    TemporaryEntry* entry_ = nullptr;  // in the list of all temporary files
};

}  // namespace deltasplat
