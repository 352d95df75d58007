// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <string>

#include "files/descriptor.h"

namespace deltasplat {

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
