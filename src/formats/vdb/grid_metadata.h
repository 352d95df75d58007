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

/// Metadata keys that record the origin of a grid, so that reading restores the original volume.
inline constexpr const char* kSourceTypeKey = "deltasplat_source_type";  ///< "uint8", ...
inline constexpr const char* kSpaceKey = "deltasplat_space";             ///< as Volume::space
inline constexpr const char* kLengthUnitKey = "deltasplat_length_unit";  ///< as Volume::lengthUnit
inline constexpr const char* kLabelsKey = "deltasplat_labels";           ///< as labelText

/// Box of all original voxels, which the active voxels may no longer span: corners as vec3i.
inline constexpr const char* kBoxMinKey = "deltasplat_box_min";
inline constexpr const char* kBoxMaxKey = "deltasplat_box_max";

/// Names of grid classes in OpenVDB.
inline constexpr const char* kUnknownClass = "unknown";
inline constexpr const char* kLevelSetClass = "level set";
inline constexpr const char* kFogClass = "fog volume";
inline constexpr const char* kStaggeredClass = "staggered";

/// Returns a line per label: value, RGB and name ("7 0.5 0.25 1 kidney"; "7 - kidney" without RGB).
std::string labelText(const LabelList& labels);

/// Returns the labels of such a text and skips malformed lines.
std::shared_ptr<const LabelList> labelsOfText(const std::string& text);

/// Returns the labels in a grid's metadata, or null without any.
std::shared_ptr<const LabelList> labelsIn(const VdbMetadata& metadata);

/// Returns the class in a grid's metadata; unknown names become kUnknownClass.
std::string gridClassOf(const VdbMetadata& metadata);

/// Returns the keys that OpenVDB's writers set anew whenever they write a grid.
inline std::array<const char*, 6> fileMetadata() {
    using openvdb::GridBase;
    return {GridBase::META_FILE_BBOX_MIN,    GridBase::META_FILE_BBOX_MAX,
            GridBase::META_FILE_COMPRESSION, GridBase::META_FILE_MEM_BYTES,
            GridBase::META_FILE_VOXEL_COUNT, GridBase::META_FILE_DELAYED_LOAD};
}

/// Whether simulation programs give this name to fields that only serve their solvers or displays
/// and fill the whole domain: "phi_obstacle", "flags", "shadow", "x_noise", ...
bool isHelperName(const std::string& gridName);

/// Returns the grid to read by default, or nullptr if none has numbers: `density`, else the first
/// fog volume, else the first of another class, else `phi`, else a helper. The grid may be
/// unreadable, because its successor would not be the grid that is meant.
/// @throw Error(kInput) if a grid's metadata, which hold its class, are damaged
const VdbGrid* defaultGrid(const VdbFile& file);
/// Does the same for listings, with nullptr for damage: reading the grid reports it.
const VdbGrid* toldDefaultGrid(const VdbFile& file);

}  // namespace deltasplat
