// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "formats/dense/dense_source.h"
#include "volume/volume_checks.h"

namespace deltasplat {

/// Opens a stack of images, or the pages of one, by headers.
/// @param input   for messages
/// @param files   in order
/// @throw as readVolume
DenseSource openImages(const std::filesystem::path& input, const std::string& name,
                       const std::vector<std::filesystem::path>& files, const ReadOptions& options,
                       const Listener& listener);

/// Reads one scalar grid of a .vdb file, or with `all` (and no grid name) every one; as
/// forEachVolume.
void readVdb(const std::filesystem::path& file, const ReadOptions& options, bool all,
             const VolumeVisitor& visitor, const Listener& listener);

/// Reads a volume for compareVolumes, or for writeVolumes to write in a format that has unsigned
/// integers: as readVolume, but those of 64 bits of which neither codes nor int64 hold all stay
/// what they are. Volume::source is then a grid of int64 with their bits (holdsUnsigned).
Volume readCompared(const std::filesystem::path& file, const ReadOptions& options,
                    const Listener& listener);

/// Returns how many binary digits the numbers have in which a file says where its voxels lie: those
/// of a double but in formats of 32-bit floats.
int placeDigitsOf(const std::filesystem::path& file);

}  // namespace deltasplat
