// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <string>

#include "files/descriptor.h"

namespace deltasplat {

/// Where the bytes of an output are to go, found once: what is renamed or replaced later on does
/// not lead elsewhere.
struct OutputTarget {
    Descriptor folder;                    ///< good for calls as openat, not for reading
    std::string name;                     ///< in that folder; of a regular file, or of none
    std::optional<struct stat> existing;  ///< empty: there is no such file yet
    bool isDevice = false;                ///< a device, a pipe or an open file: written to as it is
    bool isOpenFile = false;              ///< known by a descriptor (/dev/stdout, /proc/self/fd/3)
};

/// Follows links to where `file` leads. A link at its end that lies in a folder which others than
/// its owner may write is followed only if it is this user's, the superuser's or the folder
/// owner's.
/// @throw Error(kOutput) if the folder does not exist, if the file is a folder or may not be
/// written, or if it is a link that cannot be resolved
OutputTarget findTarget(const std::filesystem::path& file);

/// Opens a device, a pipe or an open file for writing; of the latter nothing is lost that is in it:
/// a descriptor of this process goes on where it is, others' files are appended to. -1: errno says
/// why not.
Descriptor openDirectly(const OutputTarget& target);

}  // namespace deltasplat
