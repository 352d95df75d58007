// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// What is to become of the labels of a table.
struct LabelChanges {
    std::set<int> hidden;             ///< made clear
    std::set<int> shown;              ///< all others are made clear; empty: none is
    std::map<int, double> opacities;  ///< 0..1, over one unit distance, in place of the table's

    bool empty() const { return hidden.empty() && shown.empty() && opacities.empty(); }
};

/// Returns a table of labels with the changes made; labels that it does not have are passed over.
/// @throw Error(kUsage) if the function is no table of labels
TransferFunction changeLabels(const TransferFunction& function, const LabelChanges& changes);

/// Warns of labels among the changes that the table does not have or no active voxel has.
void warnOfAbsentLabels(const LabelChanges& changes, const TransferFunction& table,
                        const Volume& volume, const Listener& listener);

/// Warns of values of active voxels, other than 0, that the table does not have: they are clear.
/// Not of those that the changes make clear.
void warnOfUnlistedLabels(const LabelChanges& changes, const TransferFunction& table,
                          const Volume& volume, const Listener& listener);

}  // namespace deltasplat
