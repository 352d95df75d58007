// SPDX-License-Identifier: Apache-2.0
// Byte 0 chooses the options, the rest is the .vdb file.
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "fuzz/fuzz_target.h"

namespace deltasplat::fuzz {
namespace {

template <typename Grid>
typename Grid::Ptr smallGrid(const std::string& name) {
    auto grid = Grid::create();
    grid->setName(name);
    for (int i = 0; i < 700; ++i) {
        grid->tree().setValue(openvdb::Coord(i % 13, i / 13 % 11 - 5, i / 40),
                              typename Grid::ValueType(i * 37 % 101));
    }
    grid->tree().addTile(1, openvdb::Coord(128, 64, -256), typename Grid::ValueType(3), true);
    return grid;
}

// With offsets as a file has them, or without as a stream.
std::string bytesOf(const openvdb::GridCPtrVec& grids, std::uint32_t compression, bool seekable) {
    if (!seekable) {
        std::ostringstream out;
        openvdb::io::Stream stream(out);
        stream.setCompression(compression);
        stream.write(grids);
        return out.str();
    }
    const std::string path = fileWith(".seed.vdb", nullptr, 0);
    openvdb::io::File file(path);
    file.setCompression(compression);
    file.write(grids);
    std::ostringstream out;
    out << std::ifstream(path, std::ios::binary).rdbuf();
    std::remove(path.c_str());
    return out.str();
}

}  // namespace

std::vector<std::string> seeds() {
    openvdb::initialize();
    auto half = smallGrid<openvdb::FloatGrid>("half");
    half->setSaveFloatAsHalf(true);
    auto levelSet = smallGrid<openvdb::FloatGrid>("ls");
    levelSet->setGridClass(openvdb::GRID_LEVEL_SET);
    levelSet->tree().root().setBackground(3.0f, true);
    auto instance = openvdb::FloatGrid::create(half->treePtr());
    instance->setName("instance");
    instance->setSaveFloatAsHalf(true);
    const std::vector<openvdb::GridCPtrVec> files{
        {smallGrid<openvdb::FloatGrid>("density")},
        {half, smallGrid<openvdb::Int32Grid>("i"), instance},
        {smallGrid<openvdb::DoubleGrid>("d"), smallGrid<openvdb::Int64Grid>("l")},
        {smallGrid<openvdb::BoolGrid>("b"), smallGrid<openvdb::MaskGrid>("m"), levelSet}};
    std::vector<std::string> inputs;
    for (const openvdb::GridCPtrVec& grids : files) {
        for (const std::uint32_t compression : {0u, 2u, 3u, 4u, 6u}) {
            inputs.push_back('\0' + bytesOf(grids, compression, true));
        }
        inputs.push_back('\1' + bytesOf(grids, 6, false));
    }
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size < 1 || size > (std::size_t{1} << 20)) return 0;
    ReadOptions options;
    options.levelSetToFog = (data[0] & 1) == 0;
    if ((data[0] & 2) != 0) options.nanValue = 1.5;
    fuzz::readAndCheck(fuzz::fileWith(".vdb", data + 1, size - 1), options);
    return 0;
}
