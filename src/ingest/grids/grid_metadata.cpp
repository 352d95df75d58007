// SPDX-License-Identifier: Apache-2.0
#include "ingest/grids/grid_metadata.h"

#include <openvdb/Grid.h>

#include "lower_case.h"

namespace deltasplat {

std::string gridClassOf(const VdbMetadata& metadata) {
    constexpr const char* kSpaces = " \t\n\v\f\r";
    const std::string stored = metadata.text(openvdb::GridBase::META_GRID_CLASS);
    const std::size_t begin = stored.find_first_not_of(kSpaces);
    if (begin == std::string::npos) return kUnknownClass;
    const std::string name =
        lowerCase(stored.substr(begin, stored.find_last_not_of(kSpaces) + 1 - begin));
    const bool isKnown = name == kLevelSetClass || name == kFogClass || name == kStaggeredClass;
    return isKnown ? name : kUnknownClass;
}

}  // namespace deltasplat
