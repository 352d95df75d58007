// SPDX-License-Identifier: Apache-2.0
#include "version.h"

#include <OpenImageIO/imageio.h>
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

std::string versionText() {
    std::string levels;
    for (const std::string& level : simdLevels()) levels += (levels.empty() ? "" : ", ") + level;
    return "deltasplat " + programVersion() + "\n" +                      //
           "OpenVDB " + openvdb::getLibraryVersionString() + "\n" +       //
           "OpenImageIO " + dotted(OIIO::openimageio_version()) + "\n" +  //
           "TBB " + TBB_runtime_version() + "\n" +                        //
           "SIMD level " + simdLevel() + " (of " + levels + ")";
}

}  // namespace deltasplat
