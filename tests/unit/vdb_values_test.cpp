// SPDX-License-Identifier: Apache-2.0
// A grid read leaf by leaf is the volume that its tree gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/threads.h"
#include "formats/vdb/packed_values.h"
#include "formats/vdb/vdb_file.h"
#include "support/same_volume.h"
#include "unit/ingest_helpers.h"
#include "unit/vdb_helpers.h"
#include "volume/tree_types.h"

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
    EXPECT_NE(volume.source(), nullptr);
    return volume;
}

void expectErrorBothWays() {
    EXPECT_THROW(readVolume("a.vdb"), Error);
    EXPECT_THROW(readByTree(), Error);
}

void expectErrorBothWays(const std::string& message) {
    expectError(ErrorCode::kInput, message, [] { readVolume("a.vdb"); });
    expectError(ErrorCode::kInput, message, [] { readByTree(); });
}

// The same nodes, tiles and codes.
void expectSame(const Volume& a, const Volume& b) {
    test::expectSameFacts(a, b);
    const CodeTree::Tree& p = a.codes()->tree();
    const CodeTree::Tree& q = b.codes()->tree();
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
        ASSERT_TRUE(file.readValues(file.grids().front(), VdbFile::Find::kByWalking));
        const Volume volume = readVolume("a.vdb");
        EXPECT_EQ(volume.source(), nullptr);
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

// Of all sizes and values, active and inactive, in nodes with leaves and in such without.
template <typename Grid>
typename Grid::Ptr gridOfTiles(const std::function<typename Grid::ValueType(int)>& value) {
    auto grid = gridOf<Grid>(value);
    auto& tree = grid->tree();
    for (int i = 0; i < 300; ++i) {
        tree.addTile(1, openvdb::Coord(800 + i % 7 * 8, 64 + i / 7 % 7 * 8, i / 49 * 8), value(i),
                     i % 3 != 0);
        tree.addTile(2, openvdb::Coord(-4096 + i % 8 * 128, i / 8 % 8 * 128, i / 64 * 128),
                     value(7 * i), i % 4 != 0);
    }
    tree.addTile(3, openvdb::Coord(0, 8192, 0), value(5), true);
    tree.addTile(3, openvdb::Coord(0, 12288, 0), value(6), false);
    return grid;
}

TEST(VdbValues, Tiles) {
    const auto halves = gridOfTiles<openvdb::FloatGrid>(halfOf);
    halves->setSaveFloatAsHalf(true);
    expectSameBothWays(halves);
    const auto doubles = gridOfTiles<openvdb::DoubleGrid>([](int i) { return double(halfOf(i)); });
    doubles->setSaveFloatAsHalf(true);
    expectSameBothWays(doubles);
    expectSameBothWays(gridOfTiles<openvdb::FloatGrid>([](int i) { return float(i % 99) * 0.1f; }));
    expectSameBothWays(gridOfTiles<openvdb::Int32Grid>([](int i) { return i % 300 - 150; }));
    expectSameBothWays(
        gridOfTiles<openvdb::Int64Grid>([](int i) { return std::int64_t(i % 19) << 40; }));
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
    EXPECT_EQ(volume.codeBook().kind, CodeBook::Kind::kTable);
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
                    "a.vdb: grid \"a\": got 1 NaN or infinite active value, the first at "
                    "(803, 2, 1); expected finite values (`nanValue` VALUE replaces them)",
                    [] { readVolume("a.vdb"); });
        ReadOptions options;
        options.nanValue = 0.5;
        EXPECT_EQ(readVolume("a.vdb", options).replaced(), 1u);
        // Inactive ones are nobody's business.
        grid->tree().setValueOff(openvdb::Coord(803, 2, 1));
        writeAs(openvdb::io::COMPRESS_BLOSC, grid);
        EXPECT_EQ(readVolume("a.vdb").replaced(), 0u);
    }
}

// Bytes of a file that is packed, changed: an error, or a volume; never more.
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

// Whether values are halves is in a file twice. OpenVDB believes one for how long they are, and the
// other for how they are packed.
TEST(VdbValues, HalvesThatMetadataCallsFloats) {
    const TempFolder folder;
    for (const bool half : {true, false}) {
        const auto grid = gridOf<openvdb::FloatGrid>(halfOf);
        grid->setSaveFloatAsHalf(half);
        for (const std::uint32_t compression : compressions()) {
            SCOPED_TRACE(compression);
            writeAs(compression, grid);
            const Volume sound = readVolume("a.vdb");
            std::string bytes = readBytes("a.vdb");
            const std::string key = openvdb::GridBase::META_SAVE_HALF_FLOAT;
            const std::size_t at = bytes.find(key);
            ASSERT_NE(at, std::string::npos);
            // Of another name, and of another value: behind its name come type and size.
            std::string renamed = bytes;
            renamed[at] = 'X';
            bytes[at + key.size() + 4 + 4 + 4] = char(!half);
            for (const std::string& contradictory : {renamed, bytes}) {
                writeBytes("a.vdb", contradictory);
                expectSame(readVolume("a.vdb"), sound);
                expectSame(readByTree(), sound);
            }
        }
    }
}

TEST(VdbValues, MetadataOfTwoTypes) {
    const TempFolder folder;
    const auto grid = gridOf<openvdb::FloatGrid>(halfOf);
    grid->insertMeta("frame_a", openvdb::Int32Metadata(1));
    grid->insertMeta("frame_b", openvdb::StringMetadata("1"));
    writeAs(openvdb::io::COMPRESS_BLOSC, grid);
    std::string bytes = readBytes("a.vdb");
    bytes[bytes.find("frame_b") + 6] = 'a';
    writeBytes("a.vdb", bytes);
    expectErrorBothWays(
        "a.vdb: got metadata \"frame_a\" of two types; expected a sound OpenVDB file");
}

TEST(VdbValues, MasksThatDiffer) {
    const TempFolder folder;
    const auto grid = gridOf<openvdb::FloatGrid>(halfOf);
    writeAs(openvdb::io::COMPRESS_NONE, grid);
    std::string bytes = readBytes("a.vdb");
    // The last leaf: its mask, a byte that says what is inactive, and 512 values.
    const std::size_t mask = bytes.size() - 512 * sizeof(float) - 1 - 64;
    bytes[mask] = char(bytes[mask] ^ 1);
    writeBytes("a.vdb", bytes);
    expectErrorBothWays("a.vdb: got a leaf of two different masks; expected a sound OpenVDB tree");
}

// What masks are told apart by cannot be worked out by who makes a file.
TEST(VdbValues, MasksThatAreMadeToDifferUnseen) {
    const TempFolder folder;
    for (const bool half : {true, false}) {
        const auto grid = gridOf<openvdb::FloatGrid>(halfOf);
        grid->setSaveFloatAsHalf(half);
        writeAs(openvdb::io::COMPRESS_NONE, grid);
        std::string bytes = readBytes("a.vdb");
        const std::size_t at = bytes.size() - 512 * (half ? 2 : 4) - 1 - sizeof(VdbLeaf::Mask);
        VdbLeaf::Mask mask;
        std::memcpy(mask.data(), &bytes[at], sizeof mask);
        // What one word changes in sums by multiplication, the next takes back.
        const auto after = [](std::uint64_t word) {
            const std::uint64_t sum = word * 0x9E3779B97F4A7C15;
            return sum ^ sum >> 32;
        };
        VdbLeaf::Mask products = mask;
        products[0] ^= 7;
        products[1] ^= after(mask[0]) ^ after(products[0]);
        VdbLeaf::Mask highBits = mask;
        highBits[0] ^= std::uint64_t{1} << 63;
        highBits[1] ^= std::uint64_t{1} << 63 | std::uint64_t{1} << 31;
        VdbLeaf::Mask swapped = mask;
        swapped[0] = mask[0] << 32 | (mask[0] >> 32 ^ 1);
        for (const VdbLeaf::Mask& other : {products, highBits, swapped}) {
            ASSERT_NE(other, mask);
            std::memcpy(&bytes[at], other.data(), sizeof other);
            writeBytes("a.vdb", bytes);
            expectErrorBothWays(
                "a.vdb: got a leaf of two different masks; expected a sound OpenVDB tree");
        }
    }
}

// A size makes nobody ask for as much memory.
TEST(VdbValues, ChunksOfAnySize) {
    const TempFolder folder;
    for (const auto compression : {openvdb::io::COMPRESS_BLOSC, openvdb::io::COMPRESS_ZIP}) {
        const auto grid = gridOf<openvdb::FloatGrid>([](int i) { return std::sin(float(i)); });
        writeAs(compression, grid);
        std::string bytes = readBytes("a.vdb");
        const VdbFile file("a.vdb");
        const auto values = file.readValues(file.grids().front(), VdbFile::Find::kByWalking);
        ASSERT_TRUE(values);
        const VdbLeaf& leaf = values->leaves.leaves().back();
        const std::int64_t size = 1000000;
        std::memcpy(&bytes[leaf.begin + 64 + 1], &size, sizeof size);
        writeBytes("a.vdb", bytes + std::string(2000000, '\0'));
        expectErrorBothWays();
    }
}

// OpenVDB takes zipped values that have the right size, whatever their checksum says.
// What does not pack stands in a chunk as it is.
TEST(VdbValues, ChunksThatAreStored) {
    std::mt19937 random(3);
    std::vector<std::uint32_t> words(1024);
    for (std::uint32_t& word : words) word = std::uint32_t(random());
    const std::size_t bytes = words.size() * sizeof words[0];
    std::string chunk;
    ASSERT_EQ(appendBlosc(words.data(), bytes, chunk), std::int64_t(bytes + 16));
    std::vector<char> values(bytes + kUnpackBytes);
    ASSERT_TRUE(unpackBlosc(chunk, values, bytes));
    EXPECT_EQ(std::memcmp(values.data(), words.data(), bytes), 0);
    EXPECT_FALSE(unpackBlosc(chunk, values, bytes - 1));
    EXPECT_FALSE(unpackBlosc({chunk.data(), chunk.size() - 1}, values, bytes));
    EXPECT_FALSE(unpackBlosc(chunk, {values.data(), bytes - 1}, bytes));
    // One byte less, of which the chunk says nothing but its size.
    std::string shorter = chunk.substr(0, chunk.size() - 1);
    const auto size = std::uint32_t(shorter.size());
    std::memcpy(&shorter[12], &size, sizeof size);
    EXPECT_FALSE(unpackBlosc(shorter, values, bytes));
    // Of another version.
    chunk[0] = 7;
    EXPECT_FALSE(unpackBlosc(chunk, values, bytes));
}

TEST(VdbValues, DamagedZipIsRefusedByWhoeverReadsIt) {
    const TempFolder folder;
    openvdb::initialize();
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("a");
    for (int i = 0; i < 512; ++i) {
        vectors->tree().setValue(openvdb::Coord(i / 64, i / 8 % 8, i % 8),
                                 openvdb::Vec3s(halfOf(i * i), 0, 1));
    }
    for (const openvdb::GridBase::Ptr& grid :
         {openvdb::GridBase::Ptr(gridOf<openvdb::FloatGrid>(halfOf)),
          openvdb::GridBase::Ptr(vectors)}) {
        writeAs(openvdb::io::COMPRESS_ZIP, grid);
        const std::string sound = readBytes("a.vdb");
        ReadOptions options;
        options.keepSource = true;
        if (grid->isType<openvdb::Vec3SGrid>()) options.gridName = "a.x";
        readVolume("a.vdb", options);
        // The last bytes of the last chunk are its checksum.
        for (const std::size_t back : {1, 3, 40}) {
            std::string bytes = sound;
            bytes[sound.size() - back] = char(bytes[sound.size() - back] ^ 1);
            writeBytes("a.vdb", bytes);
            expectError(ErrorCode::kInput,
                        "a.vdb: grid \"a\": got leaves that are damaged; expected a sound "
                        "OpenVDB grid",
                        [&] { readVolume("a.vdb", options); });
        }
    }
}

// So are values that nobody sees.
TEST(VdbValues, DamagedZipOfInactiveVoxels) {
    const TempFolder folder;
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create();
    grid->setName("a");
    for (int i = 0; i < 512; ++i) {
        grid->tree().setValue(openvdb::Coord(i / 64, i / 8 % 8, i % 8), 1);
        grid->tree().setValueOff(openvdb::Coord(64 + i / 64, i / 8 % 8, i % 8), halfOf(i * i));
    }
    writeAs(openvdb::io::COMPRESS_ZIP, grid);
    std::string bytes = readBytes("a.vdb");
    bytes.back() = char(bytes.back() ^ 1);
    writeBytes("a.vdb", bytes);
    expectErrorBothWays();
}

// Tiles of an upper node are zipped as well.
TEST(VdbValues, DamagedZipOfTiles) {
    const TempFolder folder;
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0);
    grid->setName("a");
    for (int i = 0; i < 500; ++i)
        grid->tree().addTile(1, openvdb::Coord(8 * (i % 16), 8 * (i / 16 % 16), 8 * (i / 256)),
                             halfOf(i * i), true);
    writeAs(openvdb::io::COMPRESS_ZIP, grid);
    std::string bytes = readBytes("a.vdb");
    bytes[bytes.size() - 8 - 64] = char(bytes[bytes.size() - 8 - 64] ^ 1);
    writeBytes("a.vdb", bytes);
    expectErrorBothWays();
}

// What a file notes of its leaves' sizes is believed only where leaves are found by it.
TEST(VdbValues, NotesThatAreWrong) {
    const TempFolder folder;
    const auto grid = gridOf<openvdb::FloatGrid>(halfOf);
    for (const bool half : {true, false}) {
        grid->setSaveFloatAsHalf(half);
        writeAs(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK, grid);
        const std::string sound = readBytes("a.vdb");
        const Volume whole = readByTree();
        const std::size_t note = sound.find("__delayedload");
        ASSERT_NE(note, std::string::npos);
        int believed = 0;
        for (std::size_t at = note + 17; at < note + 17 + 120; ++at) {
            SCOPED_TRACE(at);
            std::string bytes = sound;
            bytes[at] = char(bytes[at] ^ 1);
            writeBytes("a.vdb", bytes);
            const VdbFile file("a.vdb");
            believed += file.readValues(file.grids().front(), VdbFile::Find::kByNotes) ? 1 : 0;
            expectSame(readVolume("a.vdb"), whole);
        }
        EXPECT_GT(believed, 0);
    }
}

// Whoever reads may be told to stop, while leaves are looked for and while they are unpacked.
TEST(VdbValues, AListenerMayEndIt) {
    struct Stop {};
    const TempFolder folder;
    writeAs(openvdb::io::COMPRESS_NONE,
            gridOf<openvdb::FloatGrid>([](int i) { return std::sin(float(i)); }));
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        std::vector<double> shares;
        Listener listener;
        listener.progress = [&](double share) { shares.push_back(share); };
        readVolume("a.vdb", {}, listener);
        EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
        EXPECT_GT(shares.size(), 1u);
        for (const double at : {shares.front(), shares.back()}) {
            listener.progress = [at](double share) {
                if (share >= at) throw Stop();
            };
            EXPECT_THROW(readVolume("a.vdb", {}, listener), Stop);
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
