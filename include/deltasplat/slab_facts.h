// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/slab_part.h"

namespace deltasplat {

/// Writes what parts of a picture have to know of the whole volume: which values there are, and how
/// slabs are cut and what they cost. Of a delta grid that is seen along its slices, without looks
/// of voxels' own and with nothing held, parts that have the file read no more than what they show;
/// of anything else it says that they need all. The file appears when it is whole. Deterministic.
/// @param options  that parts are made with: the same in all
/// @param input    that the volume was read from: its size, its first bytes and its last are noted
/// @throw Error(kOutput)
void writeSlabFacts(const LayeredPicture& picture, const Notes& options,
                    const std::filesystem::path& input, const std::filesystem::path& file);

/// Reads of a delta grid what some parts of a picture show: the slabs of its file that hold their
/// slices, each from its key slice on. No picture but these parts can be made of the volume.
/// @param input    the volume; which grid, `reading` says
/// @param facts    what writeSlabFacts has written
/// @param options  as given there
/// @return nothing where parts need all of the volume
/// @throw Error(kInput) for a file that holds no facts, or those of another file or of other
///        options; as readVolume
std::optional<Volume> readSlabVolume(const std::filesystem::path& input, const ReadOptions& reading,
                                     const std::filesystem::path& facts, const Notes& options,
                                     const SlabShare& share, const Listener& listener = {});

}  // namespace deltasplat
