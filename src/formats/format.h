// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "formats/dense/dense_layout.h"

namespace deltasplat {

struct DenseSource;
struct InputKind;
struct ReadOptions;

/// A format of volumes: all that others know of it. Each lies in a folder of its own, with what
/// reads and what writes it, and has a line in the table (format.cpp).
struct Format {
    /// Of files that are read, in lower case, those first that messages name first.
    std::vector<std::string> extensions;
    /// Whether files are also read with ".gz" behind.
    bool mayBePacked = true;
    /// Whether files say where voxels lie; others leave it to ReadOptions::raw.
    bool saysPlace = true;
    /// Whether a file may hold several volumes, of which ReadOptions::volume chooses one.
    bool mayHoldSeveral = false;
    /// Opens an input by its headers. Null for .vdb, which has grids.
    DenseSource (*open)(const std::filesystem::path& input, const InputKind& kind,
                        const ReadOptions& options, const Listener& listener) = nullptr;
    /// Returns the files that an input consists of, itself the first. Null: itself alone.
    std::vector<std::filesystem::path> (*files)(const std::filesystem::path& input) = nullptr;
    /// How volumes are written, by extension.
    std::vector<DenseFormat> written = {};
};

/// Returns the table of all formats.
std::span<const Format* const> formats();

/// Returns the format that reads a file by its extension; null if there is none.
const Format* formatOf(const std::filesystem::path& file);

/// Returns how a file of an extension is written; null if it is no dense one.
const DenseFormat* findDenseFormat(const std::string& extension);

/// Returns what all formats read, and write, by extension, for messages.
std::string readableText();
std::string writableText();

const Format& dicomFormat();
const Format& imageFormat();
const Format& metaImageFormat();
const Format& niftiFormat();
const Format& npyFormat();
const Format& nrrdFormat();
const Format& rawVolumeFormat();
const Format& vdbFormat();

}  // namespace deltasplat
