// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ingest/vdb/vdb_metadata.h"

namespace deltasplat {

/// Metadata that say what a grid was before it was one, so that it can become that again.
inline constexpr const char* kSourceTypeKey = "deltasplat_source_type";  ///< "uint8", ...
inline constexpr const char* kSpaceKey = "deltasplat_space";             ///< as Volume::space
inline constexpr const char* kLengthUnitKey = "deltasplat_length_unit";  ///< as Volume::lengthUnit

/// All voxels of what it was, which active ones may no longer span: corners as vec3i.
inline constexpr const char* kBoxMinKey = "deltasplat_box_min";
inline constexpr const char* kBoxMaxKey = "deltasplat_box_max";

/// What OpenVDB calls the classes of grids.
inline constexpr const char* kUnknownClass = "unknown";
inline constexpr const char* kLevelSetClass = "level set";
inline constexpr const char* kFogClass = "fog volume";
inline constexpr const char* kStaggeredClass = "staggered";

/// Returns which of these a grid's metadata name; other names are unknown.
std::string gridClassOf(const VdbMetadata& metadata);

}  // namespace deltasplat
