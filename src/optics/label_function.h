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

/// What the voxels of a label look like.
struct LabelLook {
    int label = 0;
    glm::dvec3 rgb{0.0};  ///< sRGB, 0..1
    double opacity = 0;   ///< 0..1, over one unit distance
};

/// Returns a value of an active voxel that is no whole number, if there is one.
std::optional<double> anyBroken(const Volume& volume);

/// Whether a file says that its values are labels, and they can be.
bool holdsLabels(const Volume& volume);

/// Returns the transfer function of data values that are labels: each has its own look half way to
/// its neighbours, all others are clear. It is categorical.
/// @param looks  at least one, labels rising
TransferFunction labelFunction(const std::vector<LabelLook>& looks);

/// Returns such a function with the colours that a file gives labels, of those that both have.
TransferFunction withColors(const TransferFunction& function, const LabelList& labels);

/// Returns the looks of which labelFunction made a function.
std::vector<LabelLook> looksOf(const TransferFunction& function);

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

/// Reads the looks of labels: a colour table of 3D Slicer (.ctbl; index, name, red, green, blue and
/// perhaps alpha, all of 0..255), or label descriptions of ITK-SNAP (index, red, green, blue of
/// 0..255, alpha of 0..1, visible, mesh visible, "name"). Labels that are not listed, hidden ones
/// and those without opacity are clear, with a warning where nothing else is listed; of a label
/// that is listed twice the last line counts.
/// @throw Error(kInput) naming file and line, if it is missing or malformed
TransferFunction readLabelTable(const std::filesystem::path& file, const Listener& listener = {});

/// Returns the names and colours of such a table. 0 is what has no label, and left out.
/// @throw as readLabelTable
LabelList readLabelList(const std::filesystem::path& file);

/// Returns what such a table calls its labels; some may be "".
/// @throw as readLabelTable
std::map<int, std::string> readLabelNames(const std::filesystem::path& file);

}  // namespace deltasplat
