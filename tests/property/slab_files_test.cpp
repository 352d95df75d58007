// SPDX-License-Identifier: Apache-2.0
// Parts of a picture that are written to files make the picture that is rendered at once, and what
// is no part of it is refused.
#include "deltasplat/slabs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "picture/parts/layout_json.h"
#include "support/error_of.h"
#include "support/small_joined.h"
#include "support/some_scene.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::cameraOf;
using test::Colors;
using test::errorOf;
using test::smallCamerasToo;
using test::someCameras;
using test::someOptics;
using test::someVolume;

using Paths = std::vector<std::filesystem::path>;

PreparedScene sceneOf(Colors colors, double tolerance = 0) {
    SplatOptions options;
    options.tolerance.relative = tolerance;
    return PreparedScene({someVolume(), someOptics(colors)}, options);
}

Camera cameraIn(const PreparedScene& scene, const CameraOptions& options) {
    return cameraOf(*scene.scene().volume, options);
}

void write(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

// Each share by a scene of its own and another number of threads, as other processes would.
Paths writeParts(const test::TempFolder& folder, Colors colors, double tolerance,
                 const CameraOptions& options, int count) {
    Paths parts;
    for (int i = 1; i <= count; ++i) {
        const ThreadLimit limit(i);
        const PreparedScene scene = sceneOf(colors, tolerance);
        const SlabPicture picture(scene, cameraIn(scene, options));
        parts.push_back(folder / ("part" + std::to_string(i)));
        writeSlabs(picture, {i, i, count}, {{{"name", "a"}}, {{"own", std::to_string(i)}}},
                   parts.back());
    }
    return parts;
}

std::string messageOf(const Paths& parts) {
    return errorOf([&] { SlabFiles(parts).fold(); });
}

TEST(SlabFiles, foldsToThePixelsOfThePictureAtOnce) {
    const test::SmallJoined joined;
    const test::TempFolder folder;
    for (const Colors colors : {Colors::kOne, Colors::kSeveral, Colors::kOwn, Colors::kLit,
                                Colors::kFog, Colors::kFire}) {
        for (const double tolerance : {0.0, 0.1}) {
            const PreparedScene scene = sceneOf(colors, tolerance);
            for (const CameraOptions& options : smallCamerasToo()) {
                const Image expected = test::pictureOf(scene, options);
                Paths parts = writeParts(folder, colors, tolerance, options, 3);
                std::rotate(parts.begin(), parts.begin() + 1, parts.end());
                SlabFiles files(parts);
                Picture folded = files.fold();
                EXPECT_EQ(files.notes().part, (Notes{{"own", "1"}}));
                Image image(options.sizePixels);
                folded.show({{0, 0}, image.size}, image);
                EXPECT_EQ(image.rgba, expected.rgba);
                Image row({image.size.x, 1});
                const int y = image.size.y / 3;
                folded.show({{0, y}, {image.size.x, y + 1}}, row);
                EXPECT_TRUE(std::equal(row.rgba.begin(), row.rgba.end(), expected.pixel(0, y)));
            }
        }
    }
}

// Also parts of scenes that have shown the volume from elsewhere, its other end above all.
TEST(SlabFiles, foldsPartsOfScenesThatShowedMore) {
    const test::TempFolder folder;
    const std::vector<CameraOptions> cameras = someCameras();
    for (const CameraOptions& options : cameras) {
        Paths parts;
        for (int i = 1; i <= 2; ++i) {
            const PreparedScene scene = sceneOf(Colors::kSeveral);
            for (std::size_t other = 0; i == 2 && other < cameras.size(); ++other)
                test::pictureOf(scene, cameras[cameras.size() - 1 - other]);
            parts.push_back(folder / ("seen" + std::to_string(i)));
            writeSlabs(SlabPicture(scene, cameraIn(scene, options)), {i, i, 2}, {}, parts.back());
        }
        EXPECT_EQ(messageOf(parts), "no error");
    }
}

TEST(SlabFiles, knowsHowFarAPictureMayBeOff) {
    const test::TempFolder folder;
    const CameraOptions options = someCameras()[1];
    const PreparedScene scene = sceneOf(Colors::kSeveral, 0.1);
    Image image(options.sizePixels);
    const RenderStats stats = scene.render(cameraIn(scene, options), image);
    Picture folded = SlabFiles(writeParts(folder, Colors::kSeveral, 0.1, options, 2)).fold();
    folded.show({{0, 0}, image.size}, image);
    EXPECT_GT(stats.errorBoundColor, 0);
    EXPECT_EQ(folded.stats().errorBoundColor, stats.errorBoundColor);
    EXPECT_EQ(folded.stats().errorBoundAlpha, stats.errorBoundAlpha);
    EXPECT_EQ(folded.stats().tolerance.relative, 0.1);
}

TEST(SlabFiles, sharesAreOfAllSlabs) {
    const test::TempFolder folder;
    const CameraOptions options = someCameras()[2];
    const PreparedScene scene = sceneOf(Colors::kOne);
    const SlabPicture picture(scene, cameraIn(scene, options));
    const Image expected = test::pictureOf(scene, options);
    // More than there are slabs; several at once.
    for (const std::vector<SlabShare>& shares :
         {std::vector<SlabShare>{{1, 40, 40}}, {{1, 3, 40}, {4, 4, 40}, {5, 40, 40}}}) {
        Paths parts;
        for (const SlabShare& share : shares) {
            parts.push_back(folder / ("of" + std::to_string(share.first)));
            writeSlabs(picture, share, {}, parts.back());
        }
        Picture folded = SlabFiles(parts).fold();
        Image image(options.sizePixels);
        folded.show({{0, 0}, image.size}, image);
        EXPECT_EQ(image.rgba, expected.rgba);
    }
    EXPECT_EQ(errorOf([&] {
                  writeSlabs(picture, {2, 1, 3}, {}, folder / "x");
              }),
              "usage: `share`: got 2-1/3; expected some of at most 10000, counted from 1");
    EXPECT_FALSE(exists(folder / "x"));
}

TEST(SlabFiles, ofAnEmptyVolumeIsTransparent) {
    const test::TempFolder folder;
    const auto nothing = std::make_shared<const Volume>(
        test::makeVolume({}, [](int, int, int) { return test::kInactive; }));
    const PreparedScene scene({nothing, someOptics(Colors::kOne)}, SplatOptions());
    CameraOptions options;
    options.sizePixels = {10, 10};
    writeSlabs(SlabPicture(scene, cameraOf(*nothing, options)), {}, {}, folder / "empty");
    Picture folded = SlabFiles(Paths{folder / "empty"}).fold();
    Image image(options.sizePixels);
    image.rgba[7] = 1;
    folded.show({{0, 0}, image.size}, image);
    EXPECT_EQ(image.rgba, Image(options.sizePixels).rgba);
}

TEST(SlabFiles, refusesPartsOfAnotherPicture) {
    const test::TempFolder folder;
    const CameraOptions options = someCameras()[1];
    const Paths parts = writeParts(folder, Colors::kSeveral, 0, options, 3);
    EXPECT_EQ(messageOf(parts), "no error");
    const auto pathOf = [&](int i) { return parts[std::size_t(i)].string(); };
    EXPECT_EQ(messageOf({parts[0], parts[2]}),
              "input: parts: got none with 2/3; expected all 3 of a picture");
    EXPECT_EQ(messageOf({parts[1]}),
              "input: parts: got none with 1/3; expected all 3 of a picture");
    EXPECT_EQ(messageOf({parts[0]}),
              "input: parts: got none with 2-3/3; expected all 3 of a picture");
    EXPECT_EQ(messageOf({parts[0], parts[1], parts[1], parts[2]}),
              "input: " + pathOf(1) + ": got part 2/3; expected each once, and " + pathOf(1) +
                  " is part 2/3");
    // In place of the second part one of something else.
    const auto messageWith = [&](const PreparedScene& scene, const CameraOptions& camera,
                                 const Notes& notes, const SlabShare& share) {
        const std::filesystem::path other = folder / "other";
        writeSlabs(SlabPicture(scene, cameraIn(scene, camera)), share, {notes, {}}, other);
        const std::string message = messageOf({parts[0], other, parts[2]});
        const std::string begin = "input: " + other.string() + ": got ";
        EXPECT_EQ(message.substr(0, begin.size()), begin) << message;
        return message.substr(std::min(begin.size(), message.size()));
    };
    const std::string end = ", as in " + pathOf(0);
    const Notes notes{{"name", "a"}};
    EXPECT_EQ(messageWith(sceneOf(Colors::kSeveral), options, {{"name", "b"}}, {2, 2, 3}),
              "name b; expected name a" + end);
    EXPECT_EQ(messageWith(sceneOf(Colors::kSeveral), options, {}, {2, 2, 3}),
              "no name; expected name a" + end);
    EXPECT_EQ(messageWith(sceneOf(Colors::kSeveral), options, notes, {2, 2, 4}),
              "part 2/4; expected one of 3" + end);
    EXPECT_EQ(messageWith(sceneOf(Colors::kSeveral), someCameras()[2], notes, {2, 2, 3}),
              "a picture of another camera or size; expected the same" + end);
    Optics brighter = someOptics(Colors::kSeveral);
    brighter.extinctionScale = 1.5;
    EXPECT_EQ(messageWith(PreparedScene({someVolume(), brighter}, {}), options, notes, {2, 2, 3}),
              "a picture of other voxels or colours; expected the same" + end);
    const auto elsewhere = std::make_shared<const Volume>(
        test::randomVolume({{0, 0, 0}, {33, 26, 28}}, 12, 0.5, {1, 1.2, 0.8}));
    EXPECT_EQ(messageWith(PreparedScene({elsewhere, someOptics(Colors::kSeveral)}, {}), options,
                          notes, {2, 2, 3}),
              "a picture of other voxels or colours; expected the same" + end);
}

TEST(SlabFiles, refusesWhatIsNotWhole) {
    const test::TempFolder folder;
    const Paths parts = writeParts(folder, Colors::kOne, 0, someCameras()[1], 2);
    const std::string whole = test::readBytes(parts[1]);
    const std::filesystem::path changed = folder / "changed";
    const auto messageFor = [&](const std::string& bytes) {
        write(changed, bytes);
        return messageOf({parts[0], changed});
    };
    const std::string begin = "input: " + changed.string() + ": got ";
    const std::string end = "; expected a whole part of a picture's slabs";
    EXPECT_EQ(messageFor(whole), "no error");
    EXPECT_EQ(messageFor(""), begin + "another kind of file" + end);
    EXPECT_EQ(messageFor("deltasplat slabs 1\n"),
              begin + "a part that another version has written; expected one of this version");
    EXPECT_EQ(messageFor(whole + "x"), begin + "more than its layers" + end);
    EXPECT_EQ(messageFor(whole.substr(0, whole.size() - 1)), begin + "a file cut short" + end);
    // Wherever it ends or is damaged.
    for (std::size_t place = 0; place < whole.size(); place += 1 + place / 40) {
        const std::string cut = messageFor(whole.substr(0, place));
        EXPECT_EQ(cut.substr(0, begin.size()), begin) << place << ": " << cut;
        std::string damaged = whole;
        damaged[place] = char(damaged[place] ^ 4);
        const std::string message = messageFor(damaged);
        EXPECT_EQ(message.substr(0, begin.size()), begin) << place << ": " << message;
    }
}

// Whoever has written it, and made a checksum for it.
TEST(SlabFiles, refusesCamerasThatNoneIs) {
    const nlohmann::ordered_json sound = layoutJson({});
    EXPECT_NO_THROW(layoutOf(sound));
    const std::pair<const char*, const char*> changes[] = {
        {"/camera/projection", "\"fisheye\""}, {"/camera/direction", "[null, 0, 1]"},
        {"/camera/frame_width", "null"},       {"/camera/frame_width", "0"},
        {"/camera/pixel_aspect", "-1"},        {"/camera/size", "[0, 10]"},
        {"/camera/size", "[2000000000, 10]"},  {"/camera/overscan", "[1073741824, 0]"},
        {"/camera/overscan", "[-1, 0]"},       {"/camera/overscan", "[0, 256]"}};
    for (const auto& [place, value] : changes) {
        nlohmann::ordered_json changed = sound;
        changed[nlohmann::ordered_json::json_pointer(place)] = nlohmann::ordered_json::parse(value);
        EXPECT_THROW(layoutOf(changed), Error) << place << ' ' << value;
    }
}

}  // namespace
}  // namespace deltasplat
