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

/// A header about to be replaced together with the data file that it describes. Its old file gets
/// the name `aside`, which is a placeholder's until then; its new one has the name `fresh`.
struct HeaderChange {
    NameInFolder header;
    const std::string& aside;
    FileIdentity placeholder;
    const std::string& fresh;
    FileIdentity freshFile;
    NameInFolder data;
    FileIdentity freshData;
};

/// What the process has to tidy up when it ends without destroying its objects, in a form that
/// signal handlers can read (removeTemporaryFiles() in atomic_file.h). Returns a place in the list;
/// -1 if that is full.
int listTemporary(const NameInFolder& file);
int listHeaderChange(const HeaderChange& change);
/// Takes a place off the list. -1: does nothing.
void unlist(int place) noexcept;
/// Brings a change of a header to its end, and takes it off the list: if the data file has been
/// replaced, the new header gets its name and the old one is removed; if not, the old one gets its
/// name back. -1: does nothing.
void settleHeaderChange(int place) noexcept;

}  // namespace deltasplat
