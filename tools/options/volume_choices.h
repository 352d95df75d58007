// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// How to read one of the volumes that --volume and --series choose among.
struct VolumeChoice {
    ReadOptions read;
    VolumeEntry entry;  ///< as far as it says which volume it is
};

/// Returns how to read what there is to be told of an input: every DICOM series, of several volumes
/// of a file the first; or what `options` choose. Of other inputs, among them a .vdb with several
/// grids, one choice that is `options`.
/// @throw as listVolumes
std::vector<VolumeChoice> choicesIn(const std::filesystem::path& input, const ReadOptions& options);

/// Returns how a DICOM series is named, "1.2.840.1: CT, Thorax 1.5 mm"; of other volumes no text.
std::string seriesText(const VolumeEntry& entry);

/// Returns whether one of several volumes or series has to be chosen; false where that cannot be
/// found out.
bool hasSeveral(const std::filesystem::path& input, const ReadOptions& options);

}  // namespace deltasplat
