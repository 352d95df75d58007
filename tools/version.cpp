// SPDX-License-Identifier: Apache-2.0
#include "version.h"

#include <OpenImageIO/oiioversion.h>
#include <openvdb/version.h>
#include <tbb/version.h>

#include "deltasplat/simd.h"

namespace deltasplat {
namespace {

// Libraries say 20407 for 2.4.7; asked at run time, since a library may be newer than its header.
std::string dotted(int version) {
    return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
           std::to_string(version % 100);
}

}  // namespace

std::string programVersion() {
    return DELTASPLAT_VERSION;
}

std::vector<std::pair<std::string, std::string>> libraryVersions() {
    return {{"OpenVDB", openvdb::getLibraryVersionString()},
            {"OpenImageIO", dotted(OIIO_VERSION)},
            {"TBB", TBB_runtime_version()}};
}

std::string versionText() {
    std::string text = "deltasplat " + programVersion() + "\n";
    for (const auto& [library, version] : libraryVersions())
        text.append(library).append(" ").append(version).append("\n");
    std::string levels;
    for (const std::string& level : simdLevels()) levels += (levels.empty() ? "" : ", ") + level;
    return text + "SIMD level " + simdLevel() + " (of " + levels + ")";
}

}  // namespace deltasplat
