// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// What `--stats` of convert, delta and restore tells.
struct ConversionStats {
    std::uint64_t inputBytes = 0;  ///< of all files that the input consists of
    std::uint64_t outputBytes = 0;
    std::uint64_t voxels = 0;  ///< in the boxes of all volumes
    std::uint64_t active = 0;
    std::uint64_t deltas = 0;
    std::vector<std::string> codeBooks;  ///< of all volumes, each once
    double maxError = 0;                 ///< over all voxels
    bool lossless = true;
    bool areLabels = false;  ///< of any volume; not told
    double seconds = 0;

    /// Adds what there is to say of a volume.
    /// @param codeBook  name of the one that it is stored by
    void add(const Volume& volume, const std::string& codeBook);
    /// Adds what came of another conversion.
    void add(const ConversionStats& other);

  private:
    void addBook(const std::string& book);
};

/// Returns the bytes of files; one that is no regular file counts as none.
std::uint64_t bytesOf(const std::vector<std::filesystem::path>& files);

/// Returns the JSON object of `--stats`.
std::string statsJson(const ConversionStats& stats);

/// Returns a few lines for people.
std::string statsSummary(const ConversionStats& stats);

}  // namespace deltasplat
