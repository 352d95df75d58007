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

/// A format of volumes, as the rest of the library sees it. Its code has a folder of its own; its
/// line in the table is in format.cpp.
struct Format {
    std::vector<std::string> extensions;  ///< lower-case, to read, in the order of messages
    bool mayBePacked = true;  ///< whether readers also take the extensions with ".gz" appended
    bool saysPlace = true;    ///< whether files say where voxels lie; else ReadOptions::raw does
    bool mayHoldSeveral = false;  ///< volumes in one file; ReadOptions::volume chooses
    /// Opens an input by its headers. Null for .vdb, whose grids readVdb reads.
    DenseSource (*open)(const std::filesystem::path& input, const InputKind& kind,
                        const ReadOptions& options, const Listener& listener) = nullptr;
    /// Returns the files of an input, the input itself first. Null: only the input.
    std::vector<std::filesystem::path> (*files)(const std::filesystem::path& input) = nullptr;
    std::vector<DenseFormat> written = {};  ///< one writer per extension
};

std::span<const Format* const> formats();

/// Returns the format with the file's extension, or null.
const Format* formatOf(const std::filesystem::path& file);

/// Returns the writer for an extension, or null if no dense format has it.
const DenseFormat* findDenseFormat(const std::string& extension);

/// Lists the extensions that can be read, or written, for messages.
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
