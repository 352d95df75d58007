// SPDX-License-Identifier: Apache-2.0
// Parts of a picture of a delta grid that read no more of its file than they show make the picture
// that is rendered at once.
#include "deltasplat/slab_facts.h"
#include "ingest/grids/tree_types.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "deltasplat/delta/delta_file.h"
#include "deltasplat/error.h"
#include "file_mark.h"
#include "ingest/vdb/leaf_sizes.h"
#include "ingest/vdb/vdb_bytes.h"
#include "ingest/vdb/vdb_file.h"
#include "support/small_joined.h"
#include "support/some_scene.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

using testing::TempFolder;

const std::string kDeltas = "deltas.vdb";
const std::string kFacts = "facts.json";
const Notes kOptions = {{"--view", "front"}};

// Writes the deltas of a ball of noise, or of noise everywhere.
void writeDeltas(int sliceAxis, int keyInterval, bool isBall = true, bool pack = false) {
    const glm::ivec3 dims(48, 40, 128);
    std::mt19937 random(5);
    std::string voxels;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const bool isIn = std::hypot(x - 24.0, y - 20.0, (z - 64.0) / 3) < 19;
                const int noise = int(random() % 200);
                voxels += char(!isBall ? noise : isIn ? x + y + noise / 5 : 0);
            }
        }
    }
    const std::string name = "noise_48x40x128_uint8.raw";
    testing::writeBytes(name, voxels);
    ReadOptions reading;
    reading.keepSource = true;
    DeltaFileOptions options;
    options.sliceAxis = sliceAxis;
    options.keyInterval = keyInterval;
    options.pack = pack;
    DeltaFile file;
    file.add(readVolume(name, reading), options);
    file.write(kDeltas);
}

Optics optics() {
    Optics optics;
    optics.transferFunction.colors = {{0, {1, 0.2, 0}}, {90, {0, 0.4, 1}}};
    optics.transferFunction.opacities = {{5, 0, 0.5, 0}, {60, 0.3, 0.5, 0}};
    return optics;
}

PreparedScene sceneOf(Volume volume, const SplatOptions& options) {
    return PreparedScene({std::make_shared<const Volume>(std::move(volume)), optics()}, options);
}

LayeredPicture pictureOf(const PreparedScene& scene, const CameraOptions& camera) {
    return LayeredPicture(scene, test::cameraOf(*scene.scene().volume, camera));
}

Image wholePicture(const SplatOptions& options, const CameraOptions& camera) {
    return test::pictureOf(sceneOf(readVolume(kDeltas), options), camera);
}

void writeFacts(const SplatOptions& options, const CameraOptions& camera) {
    const PreparedScene scene = sceneOf(readVolume(kDeltas), options);
    writeSlabFacts(pictureOf(scene, camera), kOptions, kDeltas, kFacts);
}

std::optional<Volume> readPart(const SlabShare& share) {
    return readSlabVolume(kDeltas, {}, kFacts, kOptions, share);
}

Image foldedPicture(const SplatOptions& options, const CameraOptions& camera, int count) {
    std::vector<std::filesystem::path> parts;
    for (int i = 1; i <= count; ++i) {
        std::optional<Volume> volume = readPart({i, i, count});
        EXPECT_TRUE(volume);
        if (!volume) return {};
        const PreparedScene scene = sceneOf(std::move(*volume), options);
        parts.emplace_back(std::to_string(i) + ".slabs");
        writeSlabPart(pictureOf(scene, camera), {i, i, count}, {}, parts.back());
    }
    FoldedPicture folded(parts);
    folded.fold();
    Image image(camera.sizePixels);
    folded.show({{0, 0}, camera.sizePixels}, image);
    return image;
}

CameraOptions cameraOf(const char* view, double azimuth = 0) {
    CameraOptions camera;
    camera.sizePixels = {70, 60};
    camera.view = view;
    camera.azimuthDegrees = azimuth;
    return camera;
}

TEST(SlabFacts, PartsMakeThePicture) {
    for (const int keyInterval : {8, 24, 128}) {
        const TempFolder folder;
        writeDeltas(2, keyInterval);
        for (const char* view : {"front", "back"}) {
            for (const int between : {0, 1, 2}) {
                SCOPED_TRACE(view + std::string(" ") + std::to_string(between));
                SplatOptions options;
                options.between = between;
                options.method = between == 2 ? Method::kSparse : Method::kAuto;
                const CameraOptions camera = cameraOf(view, 13.0 * between);
                const Image expected = wholePicture(options, camera);
                writeFacts(options, camera);
                for (const int count : {1, 3, 11})
                    EXPECT_TRUE(foldedPicture(options, camera, count).rgba == expected.rgba);
            }
        }
    }
}

// Of slices that are joined, which have half as many blocks, straight and slanted.
TEST(SlabFacts, PartsOfJoinedSlicesMakeThePicture) {
    const test::SmallJoined joined;
    for (const int keyInterval : {8, 24}) {
        const TempFolder folder;
        writeDeltas(2, keyInterval);
        for (const char* view : {"front", "back"}) {
            for (const double degrees : {0, 36, -36}) {
                CameraOptions camera = cameraOf(view, degrees);
                camera.elevationDegrees = 0.8 * degrees;
                camera.sizePixels = {20, 17};
                const PreparedScene scene = sceneOf(readVolume(kDeltas), {});
                const Camera placed = test::cameraOf(*scene.scene().volume, camera);
                const Factorization seen = factorize(placed, scene.scene().volume->worldFromIndex);
                EXPECT_EQ(seen.sliceAxis, 2);
                EXPECT_EQ(std::abs(seen.shiftPerSlice.x) > 0.5, degrees != 0);
                EXPECT_EQ(std::abs(seen.shiftPerSlice.y) > 0.5, degrees != 0);
                Image expected(camera.sizePixels);
                EXPECT_EQ(renderComposite(scene, placed, expected).joined, 2);
                writeFacts({}, camera);
                for (const int count : {1, 3, 11})
                    EXPECT_TRUE(foldedPicture({}, camera, count).rgba == expected.rgba);
            }
        }
    }
}

// How many bytes this process has read so far, by whatever call.
std::uint64_t bytesRead() {
    std::ifstream io("/proc/self/io");
    std::string name;
    std::uint64_t count = 0;
    io >> name >> count;
    EXPECT_EQ(name, "rchar:");
    return count;
}

TEST(SlabFacts, PartsReadNoMoreThanTheyShow) {
    if (!std::filesystem::exists("/proc/self/io")) GTEST_SKIP() << "not told by this system";
    for (const bool pack : {false, true}) {
        const TempFolder folder;
        writeDeltas(2, 16, false, pack);
        const double size = double(std::filesystem::file_size(kDeltas));
        SplatOptions options;
        options.between = 0;
        writeFacts(options, cameraOf("front"));
        std::uint64_t before = bytesRead();
        readVolume(kDeltas);
        EXPECT_GT(double(bytesRead() - before), size);
        for (int i = 1; i <= 8; ++i) {
            before = bytesRead();
            ASSERT_TRUE(readPart({i, i, 8}));
            EXPECT_LT(double(bytesRead() - before), 0.6 * size) << i;
        }
    }
}

// Likewise of deltas that are packed to a stream.
TEST(SlabFacts, PartsOfPackedDeltasMakeThePicture) {
    for (const int keyInterval : {8, 24, 128}) {
        const TempFolder folder;
        writeDeltas(2, keyInterval, true, true);
        const CameraOptions camera = cameraOf("front", 13);
        const Image expected = wholePicture({}, camera);
        writeFacts({}, camera);
        for (const int count : {1, 3, 11})
            EXPECT_TRUE(foldedPicture({}, camera, count).rgba == expected.rgba);
    }
}

// A list in a list in a list would be followed down to where the stack ends.
TEST(SlabFacts, NestedFactsAreRefused) {
    const TempFolder folder;
    writeDeltas(2, 16);
    const std::string deep = std::string(200000, '[') + std::string(200000, ']');
    testing::writeBytes(kFacts, "{\"deltasplat_slab_facts\":" + deep + ",\"sum\":1}");
    try {
        readPart({1, 1, 2});
        FAIL() << "facts of nothing are taken";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput);
        EXPECT_EQ(
            std::string(error.what()),
            "facts.json: got JSON of more than 32 levels; expected facts of a picture's slabs");
    }
}

TEST(SlabFacts, OtherPicturesNeedTheWholeVolume) {
    const TempFolder folder;
    writeDeltas(2, 16);
    const auto needsAll = [&](const SplatOptions& options, const CameraOptions& camera) {
        writeFacts(options, camera);
        return !readPart({1, 1, 2}).has_value();
    };
    CameraOptions eye = cameraOf("front");
    eye.projection = Projection::kPerspective;
    SplatOptions held;
    held.tolerance.relative = 0.1;
    EXPECT_FALSE(needsAll({}, cameraOf("front")));
    EXPECT_TRUE(needsAll({}, cameraOf("left")));
    EXPECT_TRUE(needsAll({}, eye));
    EXPECT_TRUE(needsAll(held, cameraOf("front")));
}

TEST(SlabFacts, WhatIsOfAnotherPictureIsRefused) {
    const TempFolder folder;
    writeDeltas(2, 16);
    writeFacts({}, cameraOf("front"));
    testing::expectError(ErrorCode::kInput,
                         "facts.json: got facts for --view front; expected those for --view left",
                         [] {
                             readSlabVolume(kDeltas, {}, kFacts, {{"--view", "left"}}, {1, 1, 2});
                         });
    writeDeltas(2, 24);
    testing::expectError(ErrorCode::kInput,
                         "facts.json: got facts of another volume; expected those of deltas.vdb",
                         [] {
                             readPart({1, 1, 2});
                         });
    // What is not as it was written is no file of facts, though it may look like one.
    const std::string facts = testing::readBytes(kFacts);
    const std::size_t digit = facts.find_first_of("123456789", facts.find("histogram"));
    std::string damaged = facts;
    damaged[digit] = char(damaged[digit] == '9' ? '1' : damaged[digit] + 1);
    testing::writeBytes(kFacts, damaged);
    testing::expectError(ErrorCode::kInput,
                         "facts.json: got something else; expected facts of a picture's slabs", [] {
                             readPart({1, 1, 2});
                         });
    testing::writeBytes(kFacts, "{}");
    testing::expectError(ErrorCode::kInput,
                         "facts.json: got something else; expected facts of a picture's slabs", [] {
                             readPart({1, 1, 2});
                         });
    testing::expectError(ErrorCode::kInput, "none.json: got no such file; expected a readable file",
                         [] {
                             readSlabVolume(kDeltas, {}, "none.json", kOptions, {1, 1, 2});
                         });
}

// Facts of a file as it is, whatever it was when they were written.
void claimFactsOf(const std::string& file) {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(std::ifstream(kFacts));
    json.front()["input"] = markOf(file);
    json["sum"] = hashOf(json.front().dump());
    testing::writeBytes(kFacts, json.dump());
}

// Parts join two slices or none, whatever a file says.
TEST(SlabFacts, ClaimedNumbersOfJoinedSlicesDoNoHarm) {
    const TempFolder folder;
    writeDeltas(2, 16);
    writeFacts({}, cameraOf("front"));
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(std::ifstream(kFacts));
    for (const int joined : {-1, 0, 3, 4, 64}) {
        json.front()["facts"]["joined"] = joined;
        json["sum"] = hashOf(json.front().dump());
        testing::writeBytes(kFacts, json.dump());
        testing::expectError(ErrorCode::kInput,
                             "facts.json: got something else; expected facts of a picture's slabs",
                             [] {
                                 readPart({1, 1, 2});
                             });
    }
}

// OpenVDB's note of how long leaves are comes from the file as everything else: it may be wrong,
// and is packed by Blosc, which believes what it says of itself.
TEST(SlabFacts, DamagedNotesOfLeavesDoNoHarm) {
    const TempFolder folder;
    writeDeltas(2, 16);
    writeFacts({}, cameraOf("front"));
    const std::string sound = testing::readBytes(kDeltas);
    const std::string type = "__delayedload";
    const std::size_t begin = sound.find(type) + type.size();
    ASSERT_GT(begin, type.size());
    std::uint32_t size = 0;
    std::memcpy(&size, sound.data() + begin, sizeof size);
    const std::size_t end = begin + sizeof size + size;
    const std::uint32_t odd[] = {0, 1, 15, 17, 0x60000000, 0x7ffffff0, 0xffffffff};
    std::mt19937 random(3);
    int refused = 0, parted = 0;
    for (int i = 0; i < 400; ++i) {
        std::string damaged = sound;
        // Words at first, of which the first say most; then any byte of it.
        const std::size_t word = begin + std::size_t(i / 7) * 4;
        if (i < 140) {
            std::memcpy(damaged.data() + word, &odd[i % 7], sizeof *odd);
        } else {
            const std::size_t at = begin + random() % (end - begin);
            damaged[at] = char(random());
        }
        testing::writeBytes(kDeltas, damaged);
        claimFactsOf(kDeltas);
        try {
            std::optional<Volume> volume = readPart({2, 2, 4});
            volume ? ++parted : ++refused;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kInput) << error.what();
            ++refused;
        }
    }
    EXPECT_GT(refused, 20);
    EXPECT_GT(parted, 5);
}

// A part reads no note that is longer than one can be.
TEST(SlabFacts, NotesOfLeavesAreNoLongerThanTheirLeavesAllow) {
    openvdb::initialize();
    EXPECT_FALSE(leafSizesOf(std::string(mostLeafSizesBytes(3), '\0'), 3, {}));
    std::string raw;
    appendU32(raw, 2);
    appendU32(raw, 0);
    raw += std::string(2, '\0');
    appendU32(raw, 0);
    for (const char packed : {5, 7}) raw += packed + std::string(7, '\0');
    const auto sizes = leafSizesOf(raw, 2, {});
    ASSERT_TRUE(sizes);
    EXPECT_EQ(*sizes, (std::vector<std::uint64_t>{6, 8}));
    EXPECT_FALSE(leafSizesOf(raw, 3, {}));
    EXPECT_FALSE(leafSizesOf(raw.substr(0, raw.size() - 1), 2, {}));
    // One byte that says to be a chunk of Blosc's.
    raw[4] = 1;
    EXPECT_FALSE(leafSizesOf(raw, 2, {}));
}

// OpenVDB packs arrays of 48 to 127 bytes as if they had 128.
TEST(SlabFacts, NotesOfAnyNumberOfLeavesAreRead) {
    const TempFolder folder;
    openvdb::initialize();
    for (const int leaves : {1, 2, 6, 15, 16, 47, 48, 49, 66, 127, 128, 129, 300}) {
        SCOPED_TRACE(leaves);
        const auto grid = openvdb::Int32Grid::create(0);
        for (int i = 0; i < leaves; ++i) {
            for (int n = 0; n <= i % 40; ++n)
                grid->tree().setValueOn(openvdb::Coord(8 * i, n % 8, n / 8), n * i);
        }
        openvdb::io::File("leaves.vdb").write({grid});
        const VdbFile file("leaves.vdb");
        const auto found = file.readLeaves(file.grids().front(), VdbFile::Find::kByNotesAlone);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->leaves().size(), std::size_t(leaves));
        std::size_t sound = 0;
        for (const VdbLeaf& leaf : found->leaves()) {
            VdbLeaves::Mask mask;
            VdbLeaves::BytesRoom room;
            std::array<std::int32_t, VdbLeaves::kVoxels> values;
            sound += found->allValues(leaf, 0, found->leaves().size(), mask, room, values.data());
        }
        EXPECT_EQ(sound, std::size_t(leaves));
    }
}

// Nothing but the parts can be made of some slices.
TEST(SlabFacts, PartsAreNoVolumeToBeSeenFromElsewhere) {
    const TempFolder folder;
    writeDeltas(2, 16);
    writeFacts({}, cameraOf("front"));
    const PreparedScene scene = sceneOf(*readPart({1, 1, 2}), {});
    EXPECT_THROW(pictureOf(scene, cameraOf("left")), Error);
}

}  // namespace
}  // namespace deltasplat
