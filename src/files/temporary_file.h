// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

#include "files/file_bytes.h"

namespace deltasplat {

/// A file, by its device and inode.
struct FileIdentity {
    dev_t device = 0;
    ino_t number = 0;

    bool operator==(const FileIdentity&) const = default;
};

FileIdentity identityOf(const struct stat& status);
/// @param file  a descriptor
FileIdentity identityOf(int file);
/// Returns whether a name in a folder belongs to this file. Links are not followed. Signal handlers
/// may call it.
bool isAt(const FileIdentity& file, int folder, const char* name);

/// A name in a folder. The descriptor of the folder outlives this.
struct NameInFolder {
    int folder;
    const std::string& name;
};

/// An entry of the list of temporary files.
struct TemporaryEntry;

/// Notes a file that a signal handler has to remove (removeTemporaryFiles() in atomic_file.h),
/// where the process ends without destroying its objects.
TemporaryEntry* listTemporary(const NameInFolder& file);
/// Takes an entry off the list; does nothing for null.
void unlist(TemporaryEntry* entry) noexcept;

/// A new, empty, locked file `.deltasplat.<name>.<number>.tmp` beside the output. The destructor
/// removes it unless it was renamed. Its lock (flock) ends with its process, however the process
/// ends. So a process that can take the lock knows that nobody writes the file any more, and
/// removes it when it creates one of the same name. Where the file system has no locks, nothing is
/// removed.
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
    /// Returns whether a name in the folder belongs to this very file.
    bool isAt(const std::string& name) const;
    /// Forgets the file, because it has another name now, or none.
    void release();

  private:
    bool create(const std::string& name, mode_t mode);

    int folder_;
    std::string name_;
    Descriptor file_;
    TemporaryEntry* entry_ = nullptr;  // in the list of all temporary files
};

/// The place of an output, found once, so that nothing renamed or replaced later leads the bytes
/// elsewhere.
struct OutputTarget {
    Descriptor folder;                    ///< for openat and the like, not for reading
    std::string name;                     ///< in that folder: of a regular file, or unused
    std::optional<struct stat> existing;  ///< empty if there is no such file yet
    bool isDevice = false;                ///< a device, pipe or open file: written to directly
    bool isOpenFile = false;              ///< named by a descriptor: /dev/stdout, /proc/self/fd/3
};

/// Follows links to where `file` leads. A link at its end that lies in a folder which others than
/// its owner may write is followed only if it is this user's, the superuser's or the folder
/// owner's.
/// @throw Error(kOutput) if the folder does not exist, if the file is a folder or may not be
/// written, or if it is a link that cannot be resolved
OutputTarget findTarget(const std::filesystem::path& file);

/// Opens a device, a pipe or an open file for writing. An open file keeps its contents: a
/// descriptor of this process goes on at its position, files of other processes are appended to.
/// @return -1 if it fails; then errno says why
Descriptor openDirectly(const OutputTarget& target);

}  // namespace deltasplat
