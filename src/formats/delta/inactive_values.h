// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

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

}  // namespace deltasplat
