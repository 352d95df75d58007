// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/vdb_walk.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>

#include "formats/vdb/vdb_file.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::TempFolder;

template <typename Grid>
typename Grid::Ptr scattered() {
    openvdb::initialize();
    using T = typename Grid::ValueType;
    auto grid = Grid::create();
    for (int i = 0; i < 400; ++i) {
        grid->tree().setValue(Coord(i * 37 % 5000, i * 91 % 700 - 350, i * 13 % 99), T(i % 7));
    }
    grid->tree().addTile(1, Coord(-400, 0, 0), T(1), true);
    grid->tree().addTile(3, Coord(0, 8192, 0), T(1), true);
    return grid;
}

// The walk must end where the grid ends, and find as many nodes as OpenVDB has.
template <typename Grid>
void expectWholeWalk(std::uint32_t compression, bool half) {
    const TempFolder folder;
    auto grid = scattered<Grid>();
    grid->setSaveFloatAsHalf(half);
    openvdb::io::File file("a.vdb");
    file.setCompression(compression);
    file.write(openvdb::GridCPtrVec{grid});

    const VdbFile vdb("a.vdb");
    ASSERT_EQ(vdb.grids().size(), 1u);
    const VdbGrid& listed = vdb.grids()[0];
    VdbValueFormat format;
    ASSERT_TRUE(format.setType(listed.type, listed.half));
    VdbBytes bytes(std::make_shared<const FileBytes>("a.vdb"));
    bytes.seek(listed.data);
    format.compression = bytes.u32();
    readMetadata(bytes);
    ASSERT_EQ(bytes.text(), "UniformScaleMap");
    bytes.skip(5 * 3 * sizeof(double));
    const VdbTreeSize size = walkTree(bytes, format);
    EXPECT_EQ(bytes.position(), listed.end);

    const std::vector<openvdb::Index32> nodes = grid->tree().nodeCount();
    EXPECT_EQ(size.leaves, nodes[0]);
    EXPECT_EQ(size.lower, nodes[1]);
    EXPECT_EQ(size.upper, nodes[2]);
    EXPECT_GT(size.memoryBytes(format), double(grid->memUsage()));
    EXPECT_LT(size.memoryBytes(format), 25.0 * double(grid->memUsage()));
}

template <typename Grid>
void expectWholeWalks() {
    using namespace openvdb::io;
    for (const bool half : {false, true}) {
        for (const std::uint32_t mask : {0u, std::uint32_t(COMPRESS_ACTIVE_MASK)}) {
            expectWholeWalk<Grid>(mask | COMPRESS_NONE, half);
            expectWholeWalk<Grid>(mask | COMPRESS_ZIP, half);
            expectWholeWalk<Grid>(mask | COMPRESS_BLOSC, half);
        }
    }
}

TEST(VdbWalk, EndsWhereTheGridEnds) {
    expectWholeWalks<openvdb::FloatGrid>();
    expectWholeWalks<openvdb::DoubleGrid>();
    expectWholeWalks<openvdb::Int32Grid>();
    expectWholeWalks<openvdb::Int64Grid>();
    expectWholeWalks<openvdb::BoolGrid>();
    expectWholeWalks<openvdb::MaskGrid>();
    expectWholeWalks<openvdb::Vec3SGrid>();
    expectWholeWalks<openvdb::Vec3DGrid>();
    expectWholeWalks<openvdb::Vec3IGrid>();
}

TEST(VdbWalk, UnknownTypes) {
    VdbValueFormat format;
    EXPECT_FALSE(format.setType("ptdataidx32", false));
    EXPECT_TRUE(format.setType("double", true));
    EXPECT_EQ(format.bytes, 8u);
    EXPECT_EQ(format.stored, 2u);
}

}  // namespace
}  // namespace deltasplat
