// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include <array>
#include <memory>
#include <string>

#include "deltasplat/ingest/label_list.h"
#include "formats/vdb/vdb_file.h"
#include "volume/vdb_metadata.h"

namespace deltasplat {

/// Metadata that say what a grid was before it was one, so that it can become that again.
inline constexpr const char* kSourceTypeKey = "deltasplat_source_type";  ///< "uint8", ...
inline constexpr const char* kSpaceKey = "deltasplat_space";             ///< as Volume::space
inline constexpr const char* kLengthUnitKey = "deltasplat_length_unit";  ///< as Volume::lengthUnit
inline constexpr const char* kLabelsKey = "deltasplat_labels";           ///< as labelText

/// All voxels of what it was, which active ones may no longer span: corners as vec3i.
inline constexpr const char* kBoxMinKey = "deltasplat_box_min";
inline constexpr const char* kBoxMaxKey = "deltasplat_box_max";

/// What OpenVDB calls the classes of grids.
inline constexpr const char* kUnknownClass = "unknown";
inline constexpr const char* kLevelSetClass = "level set";
inline constexpr const char* kFogClass = "fog volume";
inline constexpr const char* kStaggeredClass = "staggered";

/// Returns what a grid's metadata hold of Volume::labels: a line for each, "7 0.5 0.25 1 kidney" of
/// value, red, green and blue (or "7 - kidney" without a colour), and name.
std::string labelText(const LabelList& labels);

/// Returns the labels of such a text. A line that is none is passed over.
std::shared_ptr<const LabelList> labelsOfText(const std::string& text);

/// Returns the labels that metadata tell of; null where they tell of none.
std::shared_ptr<const LabelList> labelsIn(const VdbMetadata& metadata);

/// Returns which of these a grid's metadata name; other names are unknown.
std::string gridClassOf(const VdbMetadata& metadata);

/// Returns the names of the metadata that OpenVDB's writers note beside a grid, and set anew
/// whenever they write it.
inline std::array<const char*, 6> fileMetadata() {
    using openvdb::GridBase;
    return {GridBase::META_FILE_BBOX_MIN,    GridBase::META_FILE_BBOX_MAX,
            GridBase::META_FILE_COMPRESSION, GridBase::META_FILE_MEM_BYTES,
            GridBase::META_FILE_VOXEL_COUNT, GridBase::META_FILE_DELAYED_LOAD};
}

/// Whether simulation programs give this name to fields that only help their solvers or their own
/// display, and that fill the whole domain: "phi_obstacle", "flags", "shadow", "x_noise", ...
bool isHelperName(const std::string& gridName);

/// Returns the grid that is read where none is asked for, or nullptr if there are no numbers: the
/// one named `density`, else the first fog volume, else the first of another class, else `phi`;
/// helpers only where there is nothing else. It may be one that cannot be read: who reads it says
/// so, since the next one would be another thing than is meant.
/// @throw Error(kInput) if a grid's metadata, which have its class, are damaged
const VdbGrid* defaultGrid(const VdbFile& file);
/// The same for lists, which leave it to who reads the grid to say what is damaged: then nullptr.
const VdbGrid* toldDefaultGrid(const VdbFile& file);

}  // namespace deltasplat
