// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/progress.h"

namespace deltasplat {

struct Format;

/// What an input's name leads to.
struct InputKind {
    const Format* format = nullptr;  ///< a line of the table of formats (format.h)
    std::string name;                ///< without folder, extensions and counter
    /// The input itself, the slices of a DICOM folder in no order, or the images of a stack in the
    /// order of their numbers.
    std::vector<std::filesystem::path> files;

    bool is(const Format& one) const { return format == &one; }
};

/// Whether a file's extension is that of images, of which a stack is a volume.
bool isImageName(const std::filesystem::path& file);

/// Whether a file's extension is that of a TIFF, which may hold several volumes.
bool isTiffName(const std::filesystem::path& file);

/// Finds out what an input is: a file by its extension, a folder by what lies in it, a name with
/// `####` or `%04d` by the files that it stands for. Warns of files in a folder that are passed
/// over.
/// @throw Error(kInput) if there is no such file, or none that can be read
InputKind findInput(const std::filesystem::path& input, const Listener& listener);

}  // namespace deltasplat
