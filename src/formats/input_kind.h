// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/progress.h"

namespace deltasplat {

struct Format;

struct InputKind {
    const Format* format = nullptr;  ///< from the table of formats (format.h)
    std::string name;                ///< without folder, extensions and counter
    /// The input, a DICOM folder's slices (unordered), or a stack's images in numeric order.
    std::vector<std::filesystem::path> files;

    bool is(const Format& one) const { return format == &one; }
};

/// Whether the extension is one of images; a stack of images is a volume.
bool isImageName(const std::filesystem::path& file);

/// Whether the extension is that of a TIFF, which may hold several volumes.
bool isTiffName(const std::filesystem::path& file);

/// Identifies an input: a file by its extension, a folder by its contents, a name with `####` or
/// `%04d` by the files that match. Warns of skipped files in a folder.
/// @throw Error(kInput) if no such file exists, or none can be read
InputKind findInput(const std::filesystem::path& input, const Listener& listener);

}  // namespace deltasplat
