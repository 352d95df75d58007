// SPDX-License-Identifier: Apache-2.0
// Parts of a picture of a delta grid that read no more of its file than they show make the picture
// that is rendered at once.
#include "deltasplat/slab_facts.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "deltasplat/delta/delta_file.h"
#include "deltasplat/error.h"
#include "support/some_scene.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

using testing::TempFolder;

const std::string kDeltas = "deltas.vdb";
const std::string kFacts = "facts.json";
const Notes kOptions = {{"--view", "front"}};

// Writes the deltas of a ball of noise, or of noise everywhere.
void writeDeltas(int sliceAxis, int keyInterval, bool isBall = true) {
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
    writeSlabFacts(pictureOf(scene, camera), kOptions, kFacts);
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
    const TempFolder folder;
    writeDeltas(2, 16, false);
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
                         "facts.json: got facts for other options; expected the same", [] {
                             readSlabVolume(kDeltas, {}, kFacts, {{"--view", "left"}}, {1, 1, 2});
                         });
    writeDeltas(2, 24);
    testing::expectError(ErrorCode::kInput,
                         "facts.json: got facts of another volume; expected those of deltas.vdb",
                         [] {
                             readPart({1, 1, 2});
                         });
    testing::writeBytes(kFacts, "{}");
    testing::expectError(ErrorCode::kInput,
                         "facts.json: got something else; expected facts of a picture's slabs", [] {
                             readPart({1, 1, 2});
                         });
    testing::expectError(ErrorCode::kInput,
                         "none.json: got a file that cannot be opened; expected a readable file",
                         [] {
                             readSlabVolume(kDeltas, {}, "none.json", kOptions, {1, 1, 2});
                         });
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
