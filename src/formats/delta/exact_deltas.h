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

/// Inactive voxels whose value is not the background, such as the inside of level sets.
struct InactiveValues {
    std::vector<double> values;  ///< increasing
    std::shared_ptr<const CodeTree>
        numbers;           ///< active at these voxels: the index of the value; may be null
    bool tooMany = false;  ///< more than 65536 different values: none is kept
    /// Whether a value or the background is a whole number that no double holds.
    bool rounded = false;
};

/// Returns a scalar grid's background as a double; 0 for masks.
double backgroundOf(const TreeGrid& grid);

InactiveValues findInactiveValues(const TreeGrid& grid);

/// Deltas of a grid's own values.
struct ExactDeltas {
    std::shared_ptr<openvdb::TreeBase> deltas;  ///< zigzag numbers, in (slice, u, v) order
    std::vector<std::uint64_t> slabDeltas;      ///< deltas of each slab
};

struct ExactDeltaOptions {
    int sliceAxis = 2;
    int keyInterval = 8;  ///< a multiple of 8
    IndexBox box;         ///< holds all active voxels and all inactive values
    /// Value of active voxels without deltas, in a volume without empty places.
    std::optional<double> rest;
    const InactiveValues& inactive;
};

/// Returns the type that holds a grid's values by their bits; nothing for values without slots.
std::optional<ExactValues> exactValuesOf(const TreeGrid& grid);

/// Takes the differences of consecutive slices. Multi-threaded; deterministic. Memory grows with
/// the active voxels and the surface of tiles.
/// @param grid  passes exactValuesOf; active values are finite
/// @throw Error(kFailed) if the deltas do not fit into memory
ExactDeltas takeExactDeltas(const TreeGrid& grid, const ExactDeltaOptions& options,
                            const std::string& where);

}  // namespace deltasplat
