// SPDX-License-Identifier: Apache-2.0
// Writes a volume as a delta grid and walks its changes with OpenVDB alone:
//   walk_deltas cloud.vdb deltas.vdb
// docs/delta-grid.md says what the numbers mean.
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cstdio>
#include <map>

#include "deltasplat/delta/delta_file.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"

using namespace deltasplat;

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "Usage: walk_deltas INPUT OUTPUT.vdb\n"), 2;
    try {
        ReadOptions read;
        read.keepSource = true;
        DeltaFileOptions options;
        options.pack = false;  // a voxel for each change, instead of a stream of bits
        DeltaFile deltas;
        const DeltaFileEntry entry = deltas.add(readVolume(argv[1], read), options);
        deltas.write(argv[2]);

        openvdb::initialize();
        openvdb::io::File file(argv[2]);
        file.open();
        const auto grid =
            openvdb::gridPtrCast<openvdb::Int32Grid>(file.readGrid(file.beginName().gridName()));
        if (!grid) return std::fprintf(stderr, "values of 64 bits have Int64Grids\n"), 1;
        std::map<int, long> changes;  // [slice]
        long all = 0;
        for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel) {
            ++changes[voxel.getCoord().x()];
            ++all;
        }
        std::printf("%ld changes along %c, slabs of %d slices\n", all, "xyz"[entry.sliceAxis],
                    entry.keyInterval);
        for (const auto& [slice, count] : changes)
            if (slice % 16 == 0) std::printf("slice %3d: %ld\n", slice, count);
        return all == long(entry.deltas) ? 0 : 1;
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
