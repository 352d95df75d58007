// SPDX-License-Identifier: Apache-2.0
// What writeVdb() writes has to be, to the last byte but the tag, what openvdb::io::File writes.
#include "formats/vdb/write_vdb.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdint>
#include <future>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "formats/delta/word_tree.h"
#include "formats/vdb/vdb_file.h"
#include "unit/convert_helpers.h"
#include "unit/random_grid.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::Inactive;
using testing::kAllInactive;
using testing::randomGrid;
using testing::TempFolder;

constexpr std::size_t kTagPlace = 21;
constexpr std::size_t kTagBytes = 36;

std::vector<WrittenGrid> written(const openvdb::GridCPtrVec& grids) {
    std::vector<WrittenGrid> all;
    for (const auto& grid : grids) all.push_back(writtenGrid(fromOpenVdb(grid)));
    return all;
}

std::string withoutTag(const std::string& file) {
    std::string bytes = testing::readBytes(file);
    EXPECT_GE(bytes.size(), kTagPlace + kTagBytes);
    return bytes.erase(kTagPlace, kTagBytes);
}

void expectSameBytes(const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata = {}) {
    const TempFolder folder;
    openvdb::io::File theirs("theirs.vdb");
    theirs.write(grids, metadata);
    theirs.close();
    writeVdb("ours.vdb", written(grids), metadata);
    const std::string a = withoutTag("theirs.vdb");
    const std::string b = withoutTag("ours.vdb");
    ASSERT_EQ(a.size(), b.size());
    const auto place = std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin();
    EXPECT_EQ(std::size_t(place), a.size());
}

template <typename Grid>
void expectSameBytesOfAll(int background) {
    unsigned seed = 1;
    for (const Inactive inactive : kAllInactive) {
        for (const bool half : {false, true}) {
            const auto grid = randomGrid<Grid>(40, inactive, background, ++seed);
            grid->setSaveFloatAsHalf(half);
            SCOPED_TRACE(grid->type() + " half " + std::to_string(half) + " kind " +
                         std::to_string(int(inactive)));
            expectSameBytes({grid});
        }
    }
}

TEST(WriteVdb, GridsOfAllTypesAreOpenVdbs) {
    for (const int background : {0, 3}) {
        expectSameBytesOfAll<openvdb::FloatGrid>(background);
        expectSameBytesOfAll<openvdb::DoubleGrid>(background);
        expectSameBytesOfAll<openvdb::Int32Grid>(background);
        expectSameBytesOfAll<openvdb::Int64Grid>(background);
        expectSameBytesOfAll<openvdb::BoolGrid>(background);
        expectSameBytesOfAll<openvdb::Vec3SGrid>(background);
    }
    expectSameBytesOfAll<openvdb::MaskGrid>(0);
}

TEST(WriteVdb, NotesOfFewAndManyLeavesAreOpenVdbs) {
    // Arrays are packed from 49 bytes on, and padded up to 128.
    for (const int leaves : {0, 1, 2, 6, 7, 15, 16, 17, 48, 49, 50, 127, 128, 129, 1000}) {
        SCOPED_TRACE(leaves);
        expectSameBytes({randomGrid<openvdb::FloatGrid>(leaves, Inactive::kBoth, 2, 5)});
        expectSameBytes({randomGrid<openvdb::BoolGrid>(leaves, Inactive::kBoth, 0, 5)});
    }
}

TEST(WriteVdb, ValuesThatDoNotPackAreOpenVdbs) {
    std::mt19937_64 random(3);
    const auto noise = openvdb::FloatGrid::create(0);
    const auto wide = openvdb::Int64Grid::create(0);
    for (int i = 0; i < 4000; ++i) {
        const Coord place(int(random() % 16), int(random() % 16), int(random() % 16));
        noise->tree().setValueOn(place, float(double(random()) * 0x1p-64));
        wide->tree().setValueOn(place, std::int64_t(random()));
    }
    const auto odd = openvdb::FloatGrid::create(0.1F);
    odd->tree().setValueOn(Coord(0, 0, 0), std::numeric_limits<float>::quiet_NaN());
    odd->tree().setValueOn(Coord(0, 0, 1), std::numeric_limits<float>::infinity());
    odd->tree().setValueOff(Coord(0, 0, 2), std::numeric_limits<float>::quiet_NaN());
    odd->tree().setValueOff(Coord(0, 9, 2), -0.0F);
    // A leaf and a node without any active voxel.
    odd->tree().setValueOff(Coord(0, 0, 20), 0.1F);
    odd->tree().touchLeaf(Coord(-5000, 0, 0));
    for (const bool half : {false, true}) {
        noise->setSaveFloatAsHalf(half);
        odd->setSaveFloatAsHalf(half);
        expectSameBytes({noise});
        expectSameBytes({wide});
        expectSameBytes({odd});
    }
}

TEST(WriteVdb, NamesAreToldApartAsByOpenVdb) {
    openvdb::GridCPtrVec grids;
    for (const char* const name : {"a", "", "b", "a", "",
                                   "a\x1e"
                                   "1",
                                   "a\x1e"
                                   "0"}) {
        const auto grid = randomGrid<openvdb::FloatGrid>(1, Inactive::kBackground, 0, 1);
        grid->setName(name);
        grids.push_back(grid);
    }
    expectSameBytes(grids);
    expectSameBytes({});
}

TEST(WriteVdb, MetadataAndMapsAreOpenVdbs) {
    openvdb::MetaMap file;
    file.insertMeta("creator", openvdb::StringMetadata("somebody"));
    file.insertMeta("size", openvdb::Vec3DMetadata({1, 2, 3}));
    const auto grid = randomGrid<openvdb::FloatGrid>(3, Inactive::kBackground, 0, 1);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->insertMeta("matrix", openvdb::Mat4DMetadata(openvdb::Mat4d::identity()));
    grid->insertMeta("flag", openvdb::BoolMetadata(true));
    grid->insertMeta(openvdb::GridBase::META_FILE_VOXEL_COUNT, openvdb::Int64Metadata(5));
    openvdb::Mat4d shear = openvdb::Mat4d::identity();
    shear(0, 1) = 0.25;
    shear(3, 0) = 7;
    using openvdb::math::Transform;
    for (const Transform::Ptr& transform :
         {Transform::createLinearTransform(0.3), Transform::createLinearTransform(shear),
          Transform::createFrustumTransform(openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)),
                                            0.5, 2)}) {
        grid->setTransform(transform);
        expectSameBytes({grid}, file);
    }
    // OpenVDB takes this one only where it is an int64.
    auto odd = written({grid});
    odd[0].metadata.insert(openvdb::GridBase::META_FILE_VOXEL_COUNT, std::string("many"));
    const TempFolder folder;
    writeVdb("odd.vdb", odd);
    EXPECT_EQ(testing::readGrid<openvdb::FloatGrid>("odd.vdb")->activeVoxelCount(),
              grid->activeVoxelCount());
}

TEST(WriteVdb, BytesDependOnNothingButTheGrids) {
    const TempFolder folder;
    const auto grid = randomGrid<openvdb::FloatGrid>(3000, Inactive::kTwo, 1, 9);
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        writeVdb(std::to_string(threads) + ".vdb", written({grid}));
    }
    const std::string bytes = testing::readBytes("1.vdb");
    EXPECT_EQ(bytes, testing::readBytes("2.vdb"));
    EXPECT_EQ(bytes, testing::readBytes("5.vdb"));
    EXPECT_EQ(writtenBytes(writtenGrid(fromOpenVdb(grid))), bytes.size());
    grid->tree().setValueOn(Coord(0), 12345);
    writeVdb("other.vdb", written({grid}));
    EXPECT_NE(bytes.substr(kTagPlace, kTagBytes),
              testing::readBytes("other.vdb").substr(kTagPlace, kTagBytes));
}

TEST(WriteVdb, LeavesThatAreNotKeptArePackedAgain) {
    const WrittenGrid grid =
        writtenGrid(fromOpenVdb(randomGrid<openvdb::FloatGrid>(3000, Inactive::kTwo, 1, 9)));
    std::vector<std::string> packed;
    for (const std::uint64_t kept : {0, 1000000, 1 << 30}) {
        std::uint64_t room = kept;
        LeafPieces pieces(*grid.tree, false);
        pieces.pack(room, [](double) {});
        packed.emplace_back();
        pieces.take([&](const std::string& bytes) { packed.back() += bytes; });
        EXPECT_EQ(packed.back().size(), pieces.bytes());
        EXPECT_TRUE(packed.back() == packed.front());
        EXPECT_EQ(room == kept, kept == 0);
    }
    EXPECT_GT(packed.front().size(), 2000000u);
}

template <typename Grid>
void expectSameDeltas() {
    const TempFolder folder;
    const auto grid = randomGrid<Grid>(300, Inactive::kBackground, 0, 9);
    writeVdb("grid.vdb", {writtenGrid(fromOpenVdb(grid))});
    writeVdb("deltas.vdb", {writtenDeltas(fromOpenVdb(grid))});
    EXPECT_TRUE(testing::readBytes("deltas.vdb") == testing::readBytes("grid.vdb"));
}

TEST(WriteVdb, DeltasAreWrittenAsAnyGridIs) {
    expectSameDeltas<openvdb::Int32Grid>();
    expectSameDeltas<openvdb::Int64Grid>();
}

TEST(WriteVdb, NotesOfWordsAreNotPacked) {
    const TempFolder folder;
    openvdb::initialize();
    std::mt19937_64 random(5);
    std::vector<std::uint64_t> words(200 * 512 + 7);
    for (std::uint64_t& word : words) word = random();
    const auto grid = openvdb::Int64Grid::create(treeOfWords(words));
    grid->setName("words");
    writeVdb("packed.vdb", {writtenGrid(fromOpenVdb(grid))});
    writeVdb("words.vdb", {writtenWords(fromOpenVdb(grid))});
    EXPECT_GT(testing::readBytes("words.vdb").size(), testing::readBytes("packed.vdb").size());
    for (const char* const name : {"packed.vdb", "words.vdb"}) {
        SCOPED_TRACE(name);
        const VdbFile file(name);
        const auto leaves = file.readLeaves(file.grids().front(), VdbFile::Find::kByNotes);
        ASSERT_TRUE(leaves);
        EXPECT_EQ(leaves->leaves().size(), grid->tree().leafCount());
        openvdb::io::File theirs(name);
        theirs.open(/*delayLoad=*/true);
        const auto read = openvdb::gridPtrCast<openvdb::Int64Grid>(theirs.readGrid("words"));
        ASSERT_EQ(read->activeVoxelCount(), grid->activeVoxelCount());
        std::size_t wrong = 0;
        for (auto value = grid->cbeginValueOn(); value; ++value)
            wrong += read->tree().getValue(value.getCoord()) == *value ? 0 : 1;
        EXPECT_EQ(wrong, 0u);
    }
}

TEST(WriteVdb, OtherGridsAreRefused) {
    EXPECT_THROW(writtenGrid(fromOpenVdb(openvdb::Vec3DGrid::create())), Error);
}

TEST(WriteVdb, APipeTakesAFile) {
    const TempFolder folder;
    const auto grid = randomGrid<openvdb::FloatGrid>(30, Inactive::kTwo, 1, 9);
    writeVdb("file.vdb", written({grid}));
    ASSERT_EQ(::mkfifo("pipe.vdb", 0600), 0);
    auto reading = std::async(std::launch::async, [] { return withoutTag("pipe.vdb"); });
    writeVdb("pipe.vdb", written({grid}));
    EXPECT_EQ(reading.get(), withoutTag("file.vdb"));
}

}  // namespace
}  // namespace deltasplat
