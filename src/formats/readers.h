// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "formats/dense/dense_source.h"
#include "volume/volume_checks.h"

namespace deltasplat {

/// Opens a stack of images (`files`, in order), or one image's pages, by headers.
/// @throw as readVolume
DenseSource openImages(const std::filesystem::path& input, const std::string& name,
                       const std::vector<std::filesystem::path>& files, const ReadOptions& options,
                       const Listener& listener);

/// Reads one scalar grid of a .vdb file, or with `all` (and no grid name) every one; see
/// forEachVolume.
void readVdb(const std::filesystem::path& file, const ReadOptions& options, bool all,
             const VolumeVisitor& visitor, const Listener& listener);

/// Like readVolume, for compareVolumes and for writers of unsigned integers: 64-bit unsigned values
/// that neither codes nor int64 hold stay exact, as bits in an int64 grid (holdsUnsigned).
Volume readCompared(const std::filesystem::path& file, const ReadOptions& options,
                    const Listener& listener);

/// Returns the binary digits of a file's placement numbers: a double's, or a float's in NIfTI-1.
int placeDigitsOf(const std::filesystem::path& file);

}  // namespace deltasplat
