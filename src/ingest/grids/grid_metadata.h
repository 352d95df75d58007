// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/MetaMap.h>
#include <openvdb/Metadata.h>

#include <string>

namespace deltasplat {

/// Metadata that say what a grid was before it was one, so that it can become that again.
inline constexpr const char* kSourceTypeKey = "deltasplat_source_type";  ///< "uint8", ...
inline constexpr const char* kSpaceKey = "deltasplat_space";             ///< as Volume::space

/// All voxels of what it was, which active ones may no longer span: corners as vec3i.
inline constexpr const char* kBoxMinKey = "deltasplat_box_min";
inline constexpr const char* kBoxMaxKey = "deltasplat_box_max";

/// Returns the text under a key; empty if there is none.
inline std::string textMetadata(const openvdb::MetaMap& metadata, const char* key) {
    const auto text = metadata.getMetadata<openvdb::StringMetadata>(key);
    return text ? text->value() : "";
}

}  // namespace deltasplat
