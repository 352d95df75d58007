// SPDX-License-Identifier: Apache-2.0
// A raw volume whose voxels are read when they are asked for is the volume that is read at once,
// shows the same pictures, and says so if its file is not what it was.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "delta/code_blocks.h"
#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/memory_limit.h"
#include "deltasplat/render.h"
#include "ingest/codes/code_tree.h"
#include "support/same_volume.h"
#include "support/some_scene.h"
#include "unit/ingest_helpers.h"

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
    for (const CodeLeaf& one : *volume.codes->leaves())
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
        EXPECT_TRUE(volume.codes->lacksLeaves());
        expectSameVolume(volume, readVolume(file));
        EXPECT_FALSE(volume.codes->lacksLeaves());
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
    const std::size_t all = volume.codes->leaves()->size();
    // Rows with few leaves are read while they are at hand.
    const std::size_t unread = countUnread(volume);
    EXPECT_GT(unread, all / 2);
    EXPECT_LT(unread, all);
    for (const int axis : {0, 1, 2}) {
        const std::vector<Slot> map = codesFrom(axis == 1 ? 80 : 100);
        const std::vector<CodeBlock> blocks = listBlocks(*volume.codes, axis, map);
        const std::vector<CodeBlock> expected = listBlocks(*whole.codes, axis, map);
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
    const Code least = volume.codeBook.codeOf(85);
    std::size_t wanted = 0;
    for (const CodeLeaf& one : *volume.codes->leaves()) {
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
            if (i % 4 == 3) return void(volume.codes->tree());
            for (const CodeBlock& block : listBlocks(*volume.codes, i % 3, codesFrom(130 - 15 * i)))
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
        expectError(ErrorCode::kInput, message, [&] { volume.codes->tree(); });
        EXPECT_EQ(countUnread(volume), unread);
    }
    const Volume shorter = readVolume(file, later());
    std::filesystem::resize_file(file, 1000);
    expectError(ErrorCode::kInput, message, [&] { listBlocks(*shorter.codes, 2, codesFrom(100)); });
}

TEST(ReadLater, memoryIsAskedForBeforeItIsTaken) {
    const TempFolder folder;
    const std::string file = writeValues<std::uint16_t>("uint16");
    const Volume volume = readVolume(file, later());
    setMemoryLimit(1);
    try {
        volume.codes->tree();
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
    EXPECT_TRUE(volume.codes->lacksLeaves());
    writeBytes("v_203x45x35_int16.raw", bytes);
    expectError(ErrorCode::kInput,
                "v_203x45x35_int16.raw: got a file that was written to while it was read; "
                "expected one that stays as it is",
                [&] { volume.codes->tree(); });
    expectSameVolume(readVolume("v_203x45x35_int16.raw", later()),
                     readVolume("v_203x45x35_int16.raw"));
}

TEST(ReadLater, othersAreReadAtOnce) {
    const TempFolder folder;
    std::vector<float> values(16 * 16 * 16);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i) / 7;
    writeBytes("v_16x16x16_float32.raw", bytesOf(values));
    EXPECT_FALSE(readVolume("v_16x16x16_float32.raw", later()).codes->lacksLeaves());
    const std::string file = writeValues<std::uint8_t>("uint8");
    testing::writeGzip(file + ".gz", bytesOf(makeValues<std::uint8_t>()));
    const Volume zipped = readVolume(file + ".gz", later());
    EXPECT_FALSE(zipped.codes->lacksLeaves());
    ReadOptions keeping = later();
    keeping.keepSource = true;
    EXPECT_FALSE(readVolume(file, keeping).codes->lacksLeaves());
    expectSameVolume(readVolume(file, later()), readVolume(file));
}

}  // namespace
}  // namespace deltasplat
