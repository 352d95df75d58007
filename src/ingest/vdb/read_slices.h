// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

struct SlabFacts;

/// Some slices of a delta grid, and what is known of all of it.
struct SlicesWanted {
    glm::ivec2 blocks{0};  ///< of 8 slices, first and last; those beyond the box count for nothing
    IndexBox box;          ///< as Volume::box
    std::vector<std::uint64_t> histogram;  ///< as Volume::histogram
    std::shared_ptr<const SlabFacts> facts;
};

/// Reads a grid of a .vdb file as readVolume chooses it, of a delta grid as readDeltaBlocks reads
/// it the slices alone that are wanted: all that is said of the volume is that of the whole.
/// @return nothing if it is another grid, is not sound, or does not say where its leaves are
/// @throw as readVolume
std::optional<Volume> readVdbSlices(const std::filesystem::path& file, const ReadOptions& options,
                                    const SlicesWanted& wanted, const Listener& listener);

}  // namespace deltasplat
