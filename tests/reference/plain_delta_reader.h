// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

namespace deltasplat::testing {

/// A volume read from a delta grid by docs/delta-grid.md alone: OpenVDB's calls, none of the
/// library's. Dense and slow.
struct PlainVolume {
    openvdb::Coord min, max;  ///< box, in the source's index space
    double background = 0;
    std::string sourceType;
    openvdb::Mat4d worldFromIndex;      ///< of the source; row vectors, as OpenVDB has them
    openvdb::MetaMap metadata;          ///< the source's own
    std::vector<double> values;         ///< [x][y][z] of the box, z fastest
    std::vector<unsigned char> active;  ///< likewise

    std::size_t at(const openvdb::Coord& xyz) const;
    /// The value of any voxel; the background outside of the box.
    double valueAt(const openvdb::Coord& xyz) const;
    bool activeAt(const openvdb::Coord& xyz) const;
};

/// Reads the delta grid of a name from a file.
PlainVolume readPlainDeltas(const std::string& file, const std::string& grid);

}  // namespace deltasplat::testing
