// SPDX-License-Identifier: Apache-2.0
// What OpenVDB's library has of constants that its headers, or we, refer to: they are there before
// the library is.
#include <openvdb/Grid.h>
#include <openvdb/util/Util.h>

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

const char* const GridBase::META_GRID_CLASS = "class";
const char* const GridBase::META_GRID_CREATOR = "creator";
const char* const GridBase::META_GRID_NAME = "name";
const char* const GridBase::META_SAVE_HALF_FLOAT = "is_saved_as_half_float";
const char* const GridBase::META_FILE_BBOX_MIN = "file_bbox_min";
const char* const GridBase::META_FILE_BBOX_MAX = "file_bbox_max";
const char* const GridBase::META_FILE_COMPRESSION = "file_compression";
const char* const GridBase::META_FILE_MEM_BYTES = "file_mem_bytes";
const char* const GridBase::META_FILE_VOXEL_COUNT = "file_voxel_count";
const char* const GridBase::META_FILE_DELAYED_LOAD = "file_delayed_load";

namespace util {
const Index32 INVALID_IDX = Index32(-1);
}

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
