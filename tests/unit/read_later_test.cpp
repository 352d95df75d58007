// SPDX-License-Identifier: Apache-2.0
// A raw volume whose voxels are read when they are asked for is the volume that is read at once,
// shows the same pictures, and says so if its file is not what it was; so are packed deltas.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/delta/delta_file.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/memory_limit.h"
#include "deltasplat/render.h"
#include "formats/delta/word_tree.h"
#include "support/same_volume.h"
#include "support/some_scene.h"
#include "unit/ingest_helpers.h"
#include "volume/code_blocks.h"
#include "volume/code_tree.h"
#include "volume/slot_blocks.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

using test::expectSameVolume;
using testing::bytesOf;
using testing::expectError;
using testing::TempFolder;
using testing::writeBytes;

constexpr glm::ivec3 kDims{203, 45, 35};

// A ball of noise whose middle is uniform, single voxels far from it, and nothing else: rows in
// which many blocks are mixed, few, and none.
template <typename T>
std::vector<T> makeValues() {
    std::vector<T> values(std::size_t(kDims.x * kDims.y * kDims.z), T(3));
    std::mt19937 random(7);
    std::size_t i = 0;
    for (int z = 0; z < kDims.z; ++z) {
        for (int y = 0; y < kDims.y; ++y) {
            for (int x = 0; x < kDims.x; ++x, ++i) {
                const double radius = std::hypot(x / 5.0 - 18, y - 20, z - 17);
                if (radius < 13) values[i] = T(100 - 5 * radius + double(random() % 16));
                if (radius < 4) values[i] = T(120);
            }
        }
    }
    values.front() = std::numeric_limits<T>::min();
    values.back() = std::numeric_limits<T>::max();
    values[std::size_t(kDims.x * kDims.y * 30 + 77)] = T(90);
    return values;
}

ReadOptions later() {
    ReadOptions options;
    options.readLater = true;
    return options;
}

template <typename T>
std::string writeValues(const std::string& type, bool bigEndian = false) {
    const std::string file = "v_203x45x35_" + type + (bigEndian ? "be" : "") + ".raw";
    writeBytes(file, bytesOf(makeValues<T>(), bigEndian));
    return file;
}

std::size_t countUnread(const Volume& volume) {
    std::size_t unread = 0;
    for (const CodeLeaf& one : *volume.codes()->leaves())
        unread += one.leaf->buffer().empty() ? 1 : 0;
    return unread;
}

// What shows voxels with at least this code, for listBlocks.
std::vector<Slot> codesFrom(int least) {
    std::vector<Slot> map(kSlotCount, kEmptySlot);
    for (int code = least; code < kCodeCount; ++code) map[std::size_t(code) + 1] = code + 1;
    return map;
}

template <typename T>
void isTheSameVolume(const std::string& type) {
    for (const bool bigEndian : {false, true}) {
        SCOPED_TRACE(type + (bigEndian ? " big-endian" : ""));
        const std::string file = writeValues<T>(type, bigEndian);
        const Volume volume = readVolume(file, later());
        EXPECT_TRUE(volume.codes()->lacksLeaves());
        expectSameVolume(volume, readVolume(file));
        EXPECT_FALSE(volume.codes()->lacksLeaves());
    }
}

TEST(ReadLater, isTheSameVolume) {
    const TempFolder folder;
    isTheSameVolume<std::uint8_t>("uint8");
    isTheSameVolume<std::int8_t>("int8");
    isTheSameVolume<std::uint16_t>("uint16");
    isTheSameVolume<std::int16_t>("int16");
}

TEST(ReadLater, onlyWhatIsAskedForIsRead) {
    const TempFolder folder;
    const std::string file = writeValues<std::uint8_t>("uint8");
    const Volume whole = readVolume(file);
    const Volume volume = readVolume(file, later());
    const std::size_t all = volume.codes()->leaves()->size();
    // Rows with few leaves are read while they are at hand.
    const std::size_t unread = countUnread(volume);
    EXPECT_GT(unread, all / 2);
    EXPECT_LT(unread, all);
    for (const int axis : {0, 1, 2}) {
        const std::vector<Slot> map = codesFrom(axis == 1 ? 80 : 100);
        const std::vector<CodeBlock> blocks = listBlocks(*volume.codes(), axis, map);
        const std::vector<CodeBlock> expected = listBlocks(*whole.codes(), axis, map);
        ASSERT_EQ(blocks.size(), expected.size());
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            ASSERT_EQ(blocks[i].position, expected[i].position);
            ASSERT_EQ(blocks[i].lowest, expected[i].lowest);
            ASSERT_EQ(blocks[i].highest, expected[i].highest);
            ASSERT_EQ(bool(blocks[i].leaf), bool(expected[i].leaf));
            if (!blocks[i].leaf) continue;
            ASSERT_FALSE(blocks[i].leaf->buffer().empty());
            EXPECT_EQ(*blocks[i].leaf, *expected[i].leaf);
        }
        EXPECT_GT(countUnread(volume), 0u);
    }
    EXPECT_LT(countUnread(volume), unread);
    expectSameVolume(volume, whole);
}

// What is known to be asked for is read at once, of all types by their values.
template <typename T>
void readsWhatIsWanted(const std::string& type) {
    SCOPED_TRACE(type);
    const std::string file = writeValues<T>(type);
    const Volume none = readVolume(file, later());
    ReadOptions options = later();
    options.isWanted = [&](const std::string& ofType, double value) {
        EXPECT_EQ(ofType, type);
        return value >= 85;
    };
    const Volume volume = readVolume(file, options);
    const Code least = volume.codeBook().codeOf(85);
    std::size_t wanted = 0;
    for (const CodeLeaf& one : *volume.codes()->leaves()) {
        if (one.highest < least) continue;
        ++wanted;
        EXPECT_FALSE(one.leaf->buffer().empty()) << one.leaf->origin();
    }
    EXPECT_GT(wanted, 10u);
    EXPECT_LT(countUnread(volume), countUnread(none));
    EXPECT_GT(countUnread(volume), 0u);
    expectSameVolume(volume, readVolume(file));
}

TEST(ReadLater, whatIsWantedIsReadAtOnce) {
    const TempFolder folder;
    readsWhatIsWanted<std::uint8_t>("uint8");
    readsWhatIsWanted<std::int8_t>("int8");
    readsWhatIsWanted<std::uint16_t>("uint16");
    readsWhatIsWanted<std::int16_t>("int16");
}

TEST(ReadLater, cutsReadWhatIsLeft) {
    const TempFolder folder;
    const std::string file = writeValues<std::uint16_t>("uint16");
    const Volume volume = readVolume(file, later());
    Cut cut;
    cut.cropIndex = IndexBox{{60, 3, 11}, {107, 30, 20}};
    const std::size_t unread = countUnread(volume);
    const Volume part = cutVolume(volume, cut);
    EXPECT_GT(countUnread(volume), unread / 2);
    expectSameVolume(part, cutVolume(readVolume(file), cut));
}

TEST(ReadLater, showsTheSamePictures) {
    const TempFolder folder;
    const std::string file = writeValues<std::uint8_t>("uint8");
    const Volume whole = readVolume(file);
    RenderOptions options;
    options.camera.direction = {-1, 0.8, -0.6};
    options.camera.sizePixels = {40, 40};
    options.optics = test::someOptics(test::Colors::kSeveral);
    std::vector<RenderOptions> some(7, options);
    some[1].camera.projection = Projection::kPerspective;
    some[2].mode = Mode::kXray;
    some[3].mode = Mode::kMip;
    some[4].optics = test::someOptics(test::Colors::kLit);
    some[5].optics = test::someOptics(test::Colors::kFog);
    some[6].camera.sizePixels = {500, 400};  // voxels are divided
    for (const RenderOptions& one : some) {
        const Volume volume = readVolume(file, later());
        EXPECT_EQ(render(volume, one).image.rgba, render(whole, one).image.rgba);
    }
}

TEST(ReadLater, manyThreadsAskAtOnce) {
    const TempFolder folder;
    const std::string file = writeValues<std::uint8_t>("uint8");
    const Volume volume = readVolume(file, later());
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&, i] {
            if (i % 4 == 3) return void(volume.codes()->tree());
            for (const CodeBlock& block :
                 listBlocks(*volume.codes(), i % 3, codesFrom(130 - 15 * i)))
                EXPECT_FALSE(block.leaf && block.leaf->buffer().empty());
        });
    }
    for (std::thread& thread : threads) thread.join();
    expectSameVolume(volume, readVolume(file));
}

TEST(ReadLater, aFileThatGoesStaysOpen) {
    const TempFolder folder;
    const std::string file = writeValues<std::uint8_t>("uint8");
    const Volume whole = readVolume(file);
    const Volume volume = readVolume(file, later());
    std::filesystem::remove(file);
    writeValues<std::int8_t>("int8");
    std::filesystem::rename("v_203x45x35_int8.raw", file);
    expectSameVolume(volume, whole);
}

TEST(ReadLater, aFileThatChangesIsRefused) {
    const TempFolder folder;
    const std::string file = writeValues<std::uint8_t>("uint8");
    const Volume volume = readVolume(file, later());
    const std::string message =
        file +
        ": got a file that was written to while it was read; expected one that stays as it is";
    std::filesystem::last_write_time(
        file, std::filesystem::last_write_time(file) + std::chrono::seconds(1));
    const std::size_t unread = countUnread(volume);
    for (int i = 0; i < 2; ++i) {
        expectError(ErrorCode::kInput, message, [&] { volume.codes()->tree(); });
        EXPECT_EQ(countUnread(volume), unread);
    }
    const Volume shorter = readVolume(file, later());
    std::filesystem::resize_file(file, 1000);
    expectError(ErrorCode::kInput, message,
                [&] { listBlocks(*shorter.codes(), 2, codesFrom(100)); });
}

TEST(ReadLater, memoryIsAskedForBeforeItIsTaken) {
    const TempFolder folder;
    const std::string file = writeValues<std::uint16_t>("uint16");
    const Volume volume = readVolume(file, later());
    setMemoryLimit(1);
    try {
        volume.codes()->tree();
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kFailed);
    }
    setMemoryLimit(0);
    expectSameVolume(volume, readVolume(file));
}

TEST(ReadLater, behindHeaders) {
    const TempFolder folder;
    const std::string bytes = bytesOf(makeValues<std::int16_t>());
    writeBytes("v_203x45x35_int16.raw", std::string(37, 'h') + bytes);
    ReadOptions options = later();
    options.raw.skipBytes = 37;
    const Volume volume = readVolume("v_203x45x35_int16.raw", options);
    EXPECT_TRUE(volume.codes()->lacksLeaves());
    writeBytes("v_203x45x35_int16.raw", bytes);
    expectError(ErrorCode::kInput,
                "v_203x45x35_int16.raw: got a file that was written to while it was read; "
                "expected one that stays as it is",
                [&] { volume.codes()->tree(); });
    expectSameVolume(readVolume("v_203x45x35_int16.raw", later()),
                     readVolume("v_203x45x35_int16.raw"));
}

TEST(ReadLater, othersAreReadAtOnce) {
    const TempFolder folder;
    std::vector<float> values(16 * 16 * 16);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i) / 7;
    writeBytes("v_16x16x16_float32.raw", bytesOf(values));
    EXPECT_FALSE(readVolume("v_16x16x16_float32.raw", later()).codes()->lacksLeaves());
    const std::string file = writeValues<std::uint8_t>("uint8");
    testing::writeGzip(file + ".gz", bytesOf(makeValues<std::uint8_t>()));
    const Volume zipped = readVolume(file + ".gz", later());
    EXPECT_FALSE(zipped.codes()->lacksLeaves());
    ReadOptions keeping = later();
    keeping.keepSource = true;
    EXPECT_FALSE(readVolume(file, keeping).codes()->lacksLeaves());
    expectSameVolume(readVolume(file, later()), readVolume(file));
}

// Packed deltas say which codes their columns have, and are unpacked when these are asked for.

constexpr const char* kPacked = "packed.vdb";

Volume packedLater(const std::string& source, int sliceAxis, int keyInterval = 8) {
    DeltaFileOptions options;
    options.sliceAxis = sliceAxis;
    options.keyInterval = keyInterval;
    options.pack = true;
    DeltaFile file;
    file.add(readVolume(source), options);
    file.write(kPacked);
    return readVolume(kPacked, later());
}

// A volume whose columns are many, so that it may say of itself what they have.
std::string writeLarge(bool isSparse = false) {
    constexpr glm::ivec3 kLarge{120, 88, 100};
    std::vector<std::uint8_t> values(std::size_t(kLarge.x * kLarge.y * kLarge.z), 0);
    std::mt19937 random(3);
    std::size_t i = 0;
    for (int z = 0; z < kLarge.z; ++z) {
        for (int y = 0; y < kLarge.y; ++y) {
            for (int x = 0; x < kLarge.x; ++x, ++i) {
                const double radius = std::hypot(x - 50, y - 40, z - 50);
                if (radius < 30) values[i] = std::uint8_t(200 - 3 * radius + double(random() % 32));
                if (!isSparse && radius >= 30) values[i] = std::uint8_t(random() % 16);
            }
        }
    }
    const std::string file = "v_120x88x100_uint8.raw";
    writeBytes(file, bytesOf(values));
    if (!isSparse) return file;
    WriteOptions options;
    options.dropBackground = true;
    options.background = 0;
    writeVolumes("sparse.vdb", {readVolume(file)}, options);
    return "sparse.vdb";
}

const SlotBlocks& blocksOf(const Volume& volume) {
    return *volume.codes()->blocksAlong(volume.origin()->sliceAxis);
}

std::size_t countMade(const Volume& volume) {
    return blocksOf(volume).blocksWith(SeenCodes([](int) { return false; }))->size();
}

void expectSameBlocks(const Volume& a, const Volume& b, int least) {
    const int axis = a.origin()->sliceAxis;
    const std::vector<CodeBlock> blocks = listBlocks(*a.codes(), axis, codesFrom(least));
    const std::vector<CodeBlock> expected = listBlocks(*b.codes(), axis, codesFrom(least));
    ASSERT_EQ(blocks.size(), expected.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        ASSERT_EQ(blocks[i].position, expected[i].position);
        ASSERT_EQ(blocks[i].tileSlot, expected[i].tileSlot);
        ASSERT_EQ(blocks[i].lowest, expected[i].lowest);
        ASSERT_EQ(blocks[i].highest, expected[i].highest);
        ASSERT_EQ(bool(blocks[i].slots), bool(expected[i].slots));
        if (blocks[i].slots) {
            ASSERT_TRUE(std::equal(blocks[i].slots, blocks[i].slots + 512, expected[i].slots));
        }
    }
}

TEST(ReadLater, columnsOfPackedDeltasAreUnpackedWhenTheirCodesAreAskedFor) {
    const TempFolder folder;
    for (const bool isSparse : {false, true}) {
        const std::string source = writeLarge(isSparse);
        for (const int axis : {0, 1, 2}) {
            for (const int keyInterval : {8, 32, 128}) {
                SCOPED_TRACE(std::to_string(axis) + " " + std::to_string(keyInterval));
                const Volume volume = packedLater(source, axis, keyInterval);
                const Volume whole = readVolume(kPacked);
                test::expectSameFacts(volume, whole);
                EXPECT_EQ(countMade(volume), 0u);
                expectSameBlocks(volume, whole, volume.codeBook().codeOf(200));
                const std::size_t few = countMade(volume);
                EXPECT_GT(few, 0u);
                // Of their columns no others are kept.
                const auto seen =
                    listBlocks(*whole.codes(), axis, codesFrom(volume.codeBook().codeOf(200)));
                EXPECT_EQ(few, seen.size());
                expectSameBlocks(volume, whole, volume.codeBook().codeOf(170));
                EXPECT_GT(countMade(volume), few);
                EXPECT_LT(countMade(volume), blocksOf(whole).blocks().size());
                expectSameBlocks(volume, whole, 0);
                EXPECT_EQ(countMade(volume), blocksOf(whole).blocks().size());
                expectSameVolume(volume, whole);
                expectSameVolume(volume, readVolume(kPacked, later()));
            }
        }
    }
}

TEST(ReadLater, packedDeltasOfAllTypesAreTheSameVolume) {
    const TempFolder folder;
    const auto isSame = [](const std::string& source) {
        const Volume volume = packedLater(source, 0, 128);
        expectSameVolume(volume, readVolume(kPacked));
    };
    isSame(writeValues<std::uint8_t>("uint8"));
    isSame(writeValues<std::int8_t>("int8"));
    isSame(writeValues<std::uint16_t>("uint16"));
    isSame(writeValues<std::int16_t>("int16"));
}

TEST(ReadLater, packedDeltasShowTheSamePictures) {
    const TempFolder folder;
    RenderOptions options;
    options.camera.direction = {-0.3, 0.4, -0.8};
    options.camera.sizePixels = {40, 40};
    options.optics = test::someOptics(test::Colors::kSeveral);
    std::vector<RenderOptions> some(6, options);
    some[1].camera.projection = Projection::kPerspective;
    some[2].mode = Mode::kXray;
    some[3].optics = test::someOptics(test::Colors::kLit);
    some[4].optics = test::someOptics(test::Colors::kFog);
    some[5].camera.sizePixels = {500, 400};  // voxels are divided
    const std::string source = writeLarge();
    packedLater(source, 2);
    const Volume whole = readVolume(kPacked);
    for (const RenderOptions& one : some) {
        EXPECT_EQ(render(readVolume(kPacked, later()), one).image.rgba,
                  render(whole, one).image.rgba);
    }
}

TEST(ReadLater, manyThreadsAskForColumnsAtOnce) {
    const TempFolder folder;
    const Volume volume = packedLater(writeLarge(), 2);
    const Volume whole = readVolume(kPacked);
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&, i] {
            if (i % 4 == 3) return void(volume.codes()->tree());
            expectSameBlocks(volume, whole, 190 - 20 * i);
        });
    }
    for (std::thread& thread : threads) thread.join();
    expectSameVolume(volume, whole);
}

// Damage is found where it is read: the last column has none of the ball's codes.
TEST(ReadLater, damagedColumnsAreRefusedWhenTheyAreAskedFor) {
    const TempFolder folder;
    packedLater(writeLarge(), 2);
    openvdb::initialize();
    openvdb::io::File input(kPacked);
    input.open();
    const auto grid =
        openvdb::gridPtrCast<openvdb::Int64Grid>(input.readGrid(input.beginName().gridName()));
    std::vector<std::uint64_t> words = wordsOfTree(grid->tree(), 0, "words");
    words[words.size() - 3] ^= 0x123456789abcdef;
    const auto damaged = openvdb::Int64Grid::create(treeOfWords(words));
    damaged->insertMeta(*grid);
    damaged->setTransform(grid->transform().copy());
    openvdb::io::File("damaged.vdb").write({damaged});
    const auto codeOf = [](const auto& read) {
        try {
            read();
        } catch (const Error& error) {
            return error.code();
        }
        ADD_FAILURE() << "no error";
        return ErrorCode::kUsage;
    };
    EXPECT_EQ(codeOf([] { readVolume("damaged.vdb"); }), ErrorCode::kInput);
    const Volume volume = readVolume("damaged.vdb", later());
    const Volume whole = readVolume(kPacked);
    expectSameBlocks(volume, whole, 100);
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(codeOf([&] { listBlocks(*volume.codes(), 2, codesFrom(0)); }), ErrorCode::kInput);
        EXPECT_EQ(codeOf([&] { volume.codes()->tree(); }), ErrorCode::kInput);
    }
    expectSameBlocks(volume, whole, 100);
}

TEST(ReadLater, memoryForColumnsIsAskedForBeforeItIsTaken) {
    const TempFolder folder;
    const Volume volume = packedLater(writeLarge(), 2);
    setMemoryLimit(1);
    try {
        volume.codes()->tree();
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kFailed);
    }
    setMemoryLimit(0);
    expectSameVolume(volume, readVolume(kPacked));
}

}  // namespace
}  // namespace deltasplat
