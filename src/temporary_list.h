// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <string>

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

}  // namespace deltasplat
