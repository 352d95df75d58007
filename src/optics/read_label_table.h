// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "deltasplat/ingest/label_list.h"
#include "optics/label_function.h"

namespace deltasplat {

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
