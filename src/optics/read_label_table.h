// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "optics/label_function.h"

namespace deltasplat {

/// Reads the looks of labels: a colour table of 3D Slicer (.ctbl), or label descriptions of
/// ITK-SNAP. Labels that are not listed, hidden ones and those without opacity are clear; of a
/// label that is listed twice the last line counts.
/// @throw Error(kInput) naming file and line, if it is missing or malformed
TransferFunction readLabelTable(const std::filesystem::path& file);

}  // namespace deltasplat
