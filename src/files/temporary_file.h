// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>
#include <sys/types.h>

#include <filesystem>
#include <string>

#include "files/descriptor.h"

namespace deltasplat {

/// A file, by its number in the system.
struct FileIdentity {
    dev_t device = 0;
    ino_t number = 0;

    bool operator==(const FileIdentity&) const = default;
};

FileIdentity identityOf(const struct stat& status);
/// @param file  a descriptor
FileIdentity identityOf(int file);
/// Returns whether a name in a folder, links not followed, is of this file. For signal handlers,
/// too.
bool isAt(const FileIdentity& file, int folder, const char* name);

/// A name in a folder, the latter by a descriptor that outlives this.
struct NameInFolder {
    int folder;
    const std::string& name;
};

/// A place in the list of temporary files.
struct TemporaryEntry;

/// Notes a file that has to be removed when the process ends without destroying its objects, in a
/// form that signal handlers can read (removeTemporaryFiles() in atomic_file.h).
TemporaryEntry* listTemporary(const NameInFolder& file);
/// Takes an entry off the list. Null: does nothing.
void unlist(TemporaryEntry* entry) noexcept;

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
