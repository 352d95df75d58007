// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "formats/delta/exact_slots.h"
#include "volume/code_tree.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// The inactive voxels of a grid that hold another value than the background, as the inside of
/// level sets does.
struct InactiveValues {
    std::vector<double> values;  ///< increasing
    std::shared_ptr<const CodeTree>
        numbers;           ///< active at those voxels: the value's number; may be null
    bool tooMany = false;  ///< more than 65536 different ones: none is kept
    /// Whether one of them, or the background, is a whole number that no double holds.
    bool rounded = false;
};

/// Returns a scalar grid's background as a double; 0 for masks.
double backgroundOf(const TreeGrid& grid);

/// Collects the inactive values of a scalar grid.
InactiveValues findInactiveValues(const TreeGrid& grid);

/// What a grid's own values become, slice by slice.
struct ExactDeltas {
    std::shared_ptr<openvdb::TreeBase> deltas;  ///< zigzag numbers, in (slice, u, v) order
    std::vector<std::uint64_t> slabDeltas;      ///< deltas of each slab
};

/// How to take them.
struct ExactDeltaOptions {
    int sliceAxis = 2;
    int keyInterval = 8;  ///< a multiple of 8
    IndexBox box;         ///< holds all active voxels and `inactive`
    /// The value of active voxels that are not spoken of, in a volume without empty places.
    std::optional<double> rest;
    const InactiveValues& inactive;
};

/// Returns how a grid's values can be stored by their own bits; empty if its type has no such code
/// book, or one of its values no slot.
std::optional<ExactValues> exactValuesOf(const TreeGrid& grid);

/// Takes the differences of consecutive slices. Multi-threaded; deterministic. Memory grows with
/// the active voxels and the surface of tiles.
/// @param grid  exactValuesOf it; active values are finite
/// @param where  for messages
/// @throw Error(kFailed) if they do not fit into memory
ExactDeltas takeExactDeltas(const TreeGrid& grid, const ExactDeltaOptions& options,
                            const std::string& where);

}  // namespace deltasplat
