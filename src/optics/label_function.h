// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "deltasplat/ingest/label_list.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

struct LabelLook {
    int label = 0;
    glm::dvec3 rgb{0.0};  ///< sRGB, 0..1
    double opacity = 0;   ///< 0..1, over one unit distance
};

/// Returns a fractional value of an active voxel, if there is one.
std::optional<double> anyBroken(const Volume& volume);

/// Returns whether the file declares its values to be labels and all of them are whole numbers.
bool holdsLabels(const Volume& volume);

/// Returns the categorical function of labels; each reaches half way to its neighbours.
/// @param looks  at least one, sorted by label
TransferFunction labelFunction(const std::vector<LabelLook>& looks);

/// Returns a label function with the colours of those of its labels that a file colours.
TransferFunction withColors(const TransferFunction& function, const LabelList& labels);

/// Returns the looks from which labelFunction made a function.
std::vector<LabelLook> looksOf(const TransferFunction& function);

struct LabelChanges {
    std::set<int> hidden;             ///< made clear
    std::set<int> shown;              ///< all other labels are made clear; empty: none is
    std::map<int, double> opacities;  ///< 0..1, over one unit distance, in place of the table's

    bool empty() const { return hidden.empty() && shown.empty() && opacities.empty(); }
};

/// Returns a table of labels with the changes made. Labels missing in the table are ignored.
/// @throw Error(kUsage) if the function is no table of labels
TransferFunction changeLabels(const TransferFunction& function, const LabelChanges& changes);

/// Warns of labels among the changes that the table does not have or no active voxel has.
void warnOfAbsentLabels(const LabelChanges& changes, const TransferFunction& table,
                        const Volume& volume, const Listener& listener);

/// Warns of values of active voxels, other than 0, that are missing in the table and so clear.
/// Values that the changes make clear cause no warning.
void warnOfUnlistedLabels(const LabelChanges& changes, const TransferFunction& table,
                          const Volume& volume, const Listener& listener);

/// Reads the looks of labels: a colour table of 3D Slicer (.ctbl; index, name, red, green, blue and
/// perhaps alpha, all 0..255), or label descriptions of ITK-SNAP (index, red, green, blue 0..255,
/// alpha 0..1, visible, mesh visible, "name"). Unlisted and hidden labels are clear. Warns if all
/// labels are clear. The last line of a label counts.
/// @throw Error(kInput) naming file and line, if the table is missing or malformed
TransferFunction readLabelTable(const std::filesystem::path& file, const Listener& listener = {});

/// Returns the names and colours of such a table, without label 0, which means "no label".
/// @throw as readLabelTable
LabelList readLabelList(const std::filesystem::path& file);

/// Returns the labels' names in such a table, like readLabelTable; a name may be "".
std::map<int, std::string> readLabelNames(const std::filesystem::path& file);

}  // namespace deltasplat
