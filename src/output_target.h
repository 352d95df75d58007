// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <string>

#include "descriptor.h"

namespace deltasplat {

/// Where the bytes of an output are to go, found once: what is renamed or replaced later on does
/// not lead elsewhere.
struct OutputTarget {
    Descriptor folder;                    ///< good for calls as openat, not for reading
    std::string name;                     ///< in that folder; of a regular file, or of none
    std::optional<struct stat> existing;  ///< empty: there is no such file yet
    bool isDevice = false;                ///< a device or a pipe: written to as it is, by its path
};

/// Follows links to where `file` leads. A link at its end is followed as Linux does with
/// fs.protected_symlinks, whether that is set or not: in a folder that all may write and whose
/// files belong to their owners (such as /tmp) only the links of this user and of the folder's
/// owner.
/// @throw Error(kOutput) if the folder does not exist, if the file is a folder or may not be
/// written, or if it is a link that cannot be resolved
OutputTarget findTarget(const std::filesystem::path& file);

}  // namespace deltasplat
