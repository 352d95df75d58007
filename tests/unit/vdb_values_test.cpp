// SPDX-License-Identifier: Apache-2.0
// A grid read leaf by leaf is the volume that its tree gives.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/threads.h"
#include "ingest/vdb/vdb_file.h"
#include "support/same_volume.h"
#include "unit/ingest_helpers.h"
#include "unit/vdb_helpers.h"

namespace deltasplat {
namespace {

using testing::expectError;
using testing::makeGrid;
using testing::readBytes;
using testing::TempFolder;
using testing::writeBytes;

void writeAs(std::uint32_t compression, const openvdb::GridBase::Ptr& grid) {
    openvdb::io::File file("a.vdb");
    file.setCompression(compression);
    file.write(openvdb::GridCPtrVec{grid});
}

std::vector<std::uint32_t> compressions() {
    using namespace openvdb::io;
    std::vector<std::uint32_t> all;
    for (const std::uint32_t mask : {0u, std::uint32_t(COMPRESS_ACTIVE_MASK)}) {
        for (const std::uint32_t how : {COMPRESS_NONE, COMPRESS_ZIP, COMPRESS_BLOSC})
            all.push_back(mask | how);
    }
    return all;
}

// Who keeps the source has the tree.
Volume readByTree() {
    ReadOptions options;
    options.keepSource = true;
    Volume volume = readVolume("a.vdb", options);
    EXPECT_NE(volume.source, nullptr);
    return volume;
}

// The same nodes, tiles and codes.
void expectSame(const Volume& a, const Volume& b) {
    test::expectSameFacts(a, b);
    const CodeTree::Tree& p = a.codes->tree();
    const CodeTree::Tree& q = b.codes->tree();
    ASSERT_TRUE(p.hasSameTopology(q));
    std::uint64_t wrong = 0;
    auto there = q.cbeginValueOn();
    for (auto here = p.cbeginValueOn(); here; ++here, ++there) wrong += *here == *there ? 0 : 1;
    EXPECT_EQ(wrong, 0u);
}

void expectSameBothWays(const openvdb::GridBase::Ptr& grid) {
    const TempFolder folder;
    for (const std::uint32_t compression : compressions()) {
        SCOPED_TRACE(compression);
        writeAs(compression, grid);
        const VdbFile file("a.vdb");
        ASSERT_TRUE(file.readValues(file.grids().front()));
        const Volume volume = readVolume("a.vdb");
        EXPECT_EQ(volume.source, nullptr);
        expectSame(volume, readByTree());
    }
}

// With leaves that are full, empty, or partly there.
template <typename Grid>
typename Grid::Ptr gridOf(const std::function<typename Grid::ValueType(int)>& value) {
    auto grid = makeGrid<Grid>("a", value, value(3));
    for (int i = 0; i < 512; ++i) {
        grid->tree().setValue(openvdb::Coord(800 + i / 64, i / 8 % 8, i % 8), value(i));
        grid->tree().setValueOff(openvdb::Coord(900 + i / 64, i / 8 % 8, i % 8), value(i));
    }
    return grid;
}

float halfOf(int i) {
    return std::ldexp(float(i % 1000) - 500, i % 9 - 20);
}

TEST(VdbValues, Halves) {
    const auto grid = gridOf<openvdb::FloatGrid>(halfOf);
    grid->setSaveFloatAsHalf(true);
    expectSameBothWays(grid);
    const auto doubles = gridOf<openvdb::DoubleGrid>([](int i) { return double(halfOf(i)); });
    doubles->setSaveFloatAsHalf(true);
    expectSameBothWays(doubles);
}

TEST(VdbValues, Floats) {
    expectSameBothWays(gridOf<openvdb::FloatGrid>(halfOf));
    expectSameBothWays(gridOf<openvdb::FloatGrid>([](int i) { return float(i % 50000 + 7); }));
    expectSameBothWays(gridOf<openvdb::FloatGrid>([](int i) { return float(i % 99) * 0.1f; }));
    expectSameBothWays(gridOf<openvdb::DoubleGrid>([](int i) { return std::sin(double(i)); }));
}

// More than codes there are: the book is none of the exact ones.
TEST(VdbValues, FloatsThatCodesRound) {
    auto grid = gridOf<openvdb::FloatGrid>([](int i) { return std::exp(float(i % 97) * 0.1f); });
    for (int i = 0; i < 70000; ++i)
        grid->tree().setValue(openvdb::Coord(i % 41, i / 41 % 41, 400 + i / 1681),
                              std::sqrt(float(i) + 0.1f));
    expectSameBothWays(grid);
}

TEST(VdbValues, Integers) {
    expectSameBothWays(gridOf<openvdb::Int32Grid>([](int i) { return i % 300 - 150; }));
    expectSameBothWays(gridOf<openvdb::Int32Grid>([](int i) { return i % 17 * 100000000; }));
    expectSameBothWays(
        gridOf<openvdb::Int64Grid>([](int i) { return std::int64_t(i % 19) << 40; }));
}

TEST(VdbValues, NothingActive) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(2);
    grid->setName("a");
    grid->setSaveFloatAsHalf(true);
    expectSameBothWays(grid);
}

// Where a grid keeps halves, the value of a tile of the root is a float.
TEST(VdbValues, ATileThatIsNoHalf) {
    const TempFolder folder;
    auto grid = gridOf<openvdb::FloatGrid>(halfOf);
    grid->setSaveFloatAsHalf(true);
    grid->tree().addTile(3, openvdb::Coord(0, 8192, 0), 0.1f, true);
    writeAs(openvdb::io::COMPRESS_BLOSC, grid);
    const Volume volume = readVolume("a.vdb");
    EXPECT_EQ(volume.codeBook.kind, CodeBook::Kind::kTable);
    expectSame(volume, readByTree());
}

TEST(VdbValues, WhatIsNotFiniteIsRefusedOrReplaced) {
    const TempFolder folder;
    for (const bool half : {true, false}) {
        auto grid = gridOf<openvdb::FloatGrid>(halfOf);
        grid->setSaveFloatAsHalf(half);
        grid->tree().setValue(openvdb::Coord(803, 2, 1), std::numeric_limits<float>::infinity());
        writeAs(openvdb::io::COMPRESS_BLOSC, grid);
        expectError(ErrorCode::kInput,
                    "a.vdb: grid \"a\": got 1 NaN or infinite active values, the first at "
                    "(803, 2, 1); expected finite values (`nanValue` VALUE replaces them)",
                    [] { readVolume("a.vdb"); });
        ReadOptions options;
        options.nanValue = 0.5;
        EXPECT_EQ(readVolume("a.vdb", options).replaced, 1u);
        // Inactive ones are nobody's business.
        grid->tree().setValueOff(openvdb::Coord(803, 2, 1));
        writeAs(openvdb::io::COMPRESS_BLOSC, grid);
        EXPECT_EQ(readVolume("a.vdb").replaced, 0u);
    }
}

// Every bit of a file that is packed, turned: an error, or a volume; never more.
TEST(VdbValues, DamagedValues) {
    const TempFolder folder;
    openvdb::initialize();
    for (const auto compression : {openvdb::io::COMPRESS_BLOSC, openvdb::io::COMPRESS_ZIP}) {
        openvdb::FloatGrid::Ptr one = openvdb::FloatGrid::create();
        one->setName("a");
        one->setSaveFloatAsHalf(true);
        for (int i = 0; i < 512; ++i)
            one->tree().setValue(openvdb::Coord(i / 64, i / 8 % 8, i % 8), halfOf(i * i));
        writeAs(compression, one);
        const std::string sound = readBytes("a.vdb");
        int refused = 0;
        for (std::size_t at = sound.size() - 200; at < sound.size(); at += 3) {
            std::string bytes = sound;
            bytes[at] = char(bytes[at] ^ 0x55);
            writeBytes("a.vdb", bytes);
            try {
                readVolume("a.vdb");
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), ErrorCode::kInput);
                ++refused;
            }
        }
        if (compression == openvdb::io::COMPRESS_ZIP) {
            EXPECT_GT(refused, 40);
        }
    }
}

TEST(VdbValues, TheNumberOfThreadsChangesNothing) {
    const TempFolder folder;
    writeAs(openvdb::io::COMPRESS_BLOSC,
            gridOf<openvdb::FloatGrid>([](int i) { return std::sin(float(i)); }));
    const Volume one = [] {
        const ThreadLimit limit(1);
        return readVolume("a.vdb");
    }();
    const ThreadLimit limit(5);
    expectSame(readVolume("a.vdb"), one);
}

}  // namespace
}  // namespace deltasplat
