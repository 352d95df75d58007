// SPDX-License-Identifier: Apache-2.0
// What OpenVDB's library has of constants that its headers, or we, refer to: they are there before
// the library is. Values are compared with the library's by tests/unit/vdb_metadata_test.cpp.
#include <openvdb/Grid.h>
#include <openvdb/util/Util.h>

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

#define NAME(member, text) const char* const GridBase::member = text;
#include "modules/openvdb_names.inc"
#undef NAME

#if OPENVDB_LIBRARY_MAJOR_VERSION_NUMBER < 11
namespace util {
const Index32 INVALID_IDX = Index32(-1);
}
#endif

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
