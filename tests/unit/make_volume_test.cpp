// SPDX-License-Identifier: Apache-2.0
// Volumes from memory are what readers make of files of the same values; voxels come back.
#include "deltasplat/ingest/make_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>

#include "deltasplat/error.h"
#include "deltasplat/openvdb_grid.h"
#include "deltasplat/render.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::errorOf;

constexpr glm::i64vec3 kDims(11, 9, 20);

template <typename T>
std::vector<T> someValues() {
    std::vector<T> values(std::size_t(kDims.x * kDims.y * kDims.z));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double value = double(i * 37 % 101) * (i % 7 == 0 ? 0 : 1);
        values[i] = T(std::is_floating_point_v<T> ? value / 3 : value);
    }
    return values;
}

template <typename T>
std::span<const T> view(const std::vector<T>& values) {
    return values;
}

Image pictureOf(const Volume& volume) {
    RenderOptions options;
    options.camera.sizePixels = {40, 40};
    options.camera.azimuthDegrees = 20;
    // Levels between values differ from one code book to another.
    options.splat.between = 0;
    options.optics.transferFunction.colors = {{0, {1, 0, 0}}, {30, {0, 1, 0.5}}};
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {30, 0.5, 0.5, 0}};
    return render(volume, options).image;
}

template <typename T>
class MakeVolume : public testing::Test {};
using VoxelTypes =
    testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                   std::int32_t, std::uint64_t, std::int64_t, float, double>;
TYPED_TEST_SUITE(MakeVolume, VoxelTypes);

TYPED_TEST(MakeVolume, voxelsComeBack) {
    const std::vector<TypeParam> values = someValues<TypeParam>();
    const Volume volume = makeVolume(view(values), {kDims});
    EXPECT_EQ(volume.activeCount(), values.size());
    EXPECT_FALSE(volume.hasBackground());
    EXPECT_EQ(volume.box(), (IndexBox{{0, 0, 0}, glm::ivec3(kDims) - 1}));
    std::vector<double> back(values.size());
    std::vector<std::uint8_t> active(values.size());
    readVoxels(volume, volume.box(), back, active);
    for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(back[i], double(values[i])) << i;
        ASSERT_EQ(active[i], 1);
    }
}

TYPED_TEST(MakeVolume, whatIsBackgroundIsEmpty) {
    const std::vector<TypeParam> values = someValues<TypeParam>();
    MemoryLayout layout{kDims};
    layout.background = 0;
    const Volume volume = makeVolume(view(values), layout);
    const auto there = std::size_t(
        std::count_if(values.begin(), values.end(), [](TypeParam v) { return v != TypeParam{}; }));
    EXPECT_EQ(volume.activeCount(), there);
    EXPECT_TRUE(volume.hasBackground());
    EXPECT_EQ(volume.background(), 0);
    // Also beyond what is there.
    const IndexBox box{{-2, -1, -3}, glm::ivec3(kDims) + 2};
    std::vector<double> back(std::size_t(box.voxels()));
    std::vector<std::uint8_t> active(back.size());
    readVoxels(volume, box, back, active);
    std::size_t place = 0;
    for (int z = box.min.z; z <= box.max.z; ++z) {
        for (int y = box.min.y; y <= box.max.y; ++y) {
            for (int x = box.min.x; x <= box.max.x; ++x, ++place) {
                const bool inside =
                    x >= 0 && y >= 0 && z >= 0 && x < kDims.x && y < kDims.y && z < kDims.z;
                const double expected =
                    inside ? double(values[std::size_t((z * kDims.y + y) * kDims.x + x)]) : 0;
                ASSERT_EQ(back[place], expected);
                ASSERT_EQ(active[place], expected != 0 ? 1 : 0);
            }
        }
    }
    // A grid of it and back again.
    const Volume again = makeVolume(makeGrid(volume));
    EXPECT_EQ(again.activeCount(), there);
    EXPECT_EQ(pictureOf(again).rgba, pictureOf(volume).rgba);
}

TYPED_TEST(MakeVolume, strideSaysWhereNeighboursAre) {
    const std::vector<TypeParam> values = someValues<TypeParam>();
    // z the fastest, with a gap behind each row.
    MemoryLayout layout{kDims};
    layout.strides = glm::i64vec3((kDims.z + 3) * kDims.y, kDims.z + 3, 1);
    std::vector<TypeParam> turned(std::size_t(layout.strides->x * kDims.x));
    for (int z = 0; z < kDims.z; ++z) {
        for (int y = 0; y < kDims.y; ++y) {
            for (int x = 0; x < kDims.x; ++x) {
                turned[std::size_t(x * layout.strides->x + y * layout.strides->y + z)] =
                    values[std::size_t((z * kDims.y + y) * kDims.x + x)];
            }
        }
    }
    // The last gap need not be there.
    turned.resize(turned.size() - 3);
    EXPECT_EQ(pictureOf(makeVolume(view(turned), layout)).rgba,
              pictureOf(makeVolume(view(values), {kDims})).rgba);
}

TEST(MakeVolumeOfFile, isWhatTheReaderMakes) {
    const test::TempFolder folder;
    const std::filesystem::path file = folder.path() / "v_11x9x20_float32.raw";
    const std::vector<float> values = someValues<float>();
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               std::streamsize(values.size() * sizeof(float)));
    const Volume read = readVolume(file);
    const Volume made = makeVolume(view(values), {kDims});
    EXPECT_EQ(made.histogram(), read.histogram());
    EXPECT_EQ(made.type(), read.type());
    EXPECT_EQ(pictureOf(made).rgba, pictureOf(read).rgba);
}

// What is not exact as codes comes back from the source.
TEST(MakeVolumeOfReals, comesBackExactlyWhereTheSourceIsKept) {
    std::vector<double> values(std::size_t(64 * 64 * 32));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(double(i)) + double(i);
    MemoryLayout layout{{64, 64, 32}};
    for (const bool sparse : {false, true}) {
        if (sparse) layout.background = -5;
        ReadOptions options;
        options.keepSource = true;
        const Volume kept = makeVolume(view(values), layout, options);
        EXPECT_FALSE(kept.codeBook().isExact());
        std::vector<double> back(values.size());
        readVoxels(kept, kept.box(), back);
        EXPECT_EQ(back, values);
        const Volume coded = makeVolume(view(values), layout);
        readVoxels(coded, coded.box(), back);
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_LE(std::abs(back[i] - values[i]), coded.codeError().absolute * (1 + 1e-12));
    }
}

TEST(MakeVolumeOfReals, takesNaNAsItIsAsked) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> values = someValues<float>();
    values[5] = values[100] = kNaN;
    MemoryLayout layout{kDims};
    EXPECT_THROW(makeVolume(view(values), layout), Error);
    ReadOptions options;
    options.nanValue = 7;
    EXPECT_EQ(makeVolume(view(values), layout, options).replaced(), 2u);
    // As the background NaN is what is not there.
    layout.background = kNaN;
    const Volume holes = makeVolume(view(values), layout);
    EXPECT_EQ(holes.activeCount(), values.size() - 2);
    EXPECT_EQ(holes.background(), 0);
    // But not infinity, or what is no number beside another background.
    values[7] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(makeVolume(view(values), layout), Error);
    values[7] = 1;
    layout.background = 0;
    EXPECT_THROW(makeVolume(view(values), layout), Error);
    EXPECT_EQ(makeVolume(view(values), layout, options).replaced(), 2u);
}

TEST(MakeVolumeErrors, sayWhatWasGotAndExpected) {
    const std::vector<float> values(24);
    const auto messageFor = [&](const MemoryLayout& layout) {
        return errorOf([&] { makeVolume(view(values), layout); });
    };
    MemoryLayout layout{{2, 3, 5}};
    EXPECT_EQ(messageFor(layout), "usage: volume in memory: values: got 24; expected 30 (2x3x5)");
    layout.dims = {2, 3, 3};
    EXPECT_EQ(messageFor(layout), "usage: volume in memory: values: got 24; expected 18 (2x3x3)");
    layout.dims = {0, 3, 3};
    EXPECT_EQ(
        messageFor(layout),
        "usage: volume in memory: dims: got 0x3x3; expected each from 1 to 2^30, fewer than 2^60 "
        "voxels together");
    layout.dims = {2, 3, 4};
    layout.strides = {1, 2, 7};
    EXPECT_EQ(
        messageFor(layout),
        "usage: volume in memory: values: got 24; expected at least 27 (2x3x4 with strides 1,2,7)");
    layout.strides = {1, 0, 6};
    EXPECT_EQ(messageFor(layout),
              "usage: volume in memory: strides: got 1,0,6; expected each at least 1");
    layout.strides.reset();
    layout.worldFromIndex[1] = glm::dvec4(0);
    EXPECT_NE(messageFor(layout).find("worldFromIndex: got a matrix that gives no place"),
              std::string::npos);
    layout.worldFromIndex = glm::dmat4(std::nan(""));
    EXPECT_NE(messageFor(layout).find("worldFromIndex"), std::string::npos);
    layout.worldFromIndex = glm::dmat4(1);
    layout.background = std::numeric_limits<double>::infinity();
    EXPECT_EQ(messageFor(layout),
              "usage: volume in memory: background: got inf; expected a finite number or NaN");
    const std::vector<std::uint8_t> bytes(24);
    layout.background = -1;
    EXPECT_EQ(errorOf([&] { makeVolume(view(bytes), layout); }),
              "usage: volume in memory: background: got -1; expected a value of type uint8");
    layout.background.reset();
    // Slices that lie upon each other, in more memory than there is.
    const std::vector<float> few2(3 << 20);
    MemoryLayout wide{{1 << 20, 1 << 20, 1}};
    wide.strides = {1, 1, 1};
    EXPECT_THROW(makeVolume(view(few2), wide), Error);
    layout.space = "XYZ";
    EXPECT_EQ(messageFor(layout),
              "usage: volume in memory: space: got \"XYZ\"; expected RAS, LPS or nothing");
    layout.space.clear();
    const Volume volume = makeVolume(view(values), layout);
    EXPECT_NE(errorOf([&] {
                  readVoxels(volume, {{0, 0, 0}, {std::numeric_limits<int>::max(), 0, 0}}, {});
              }).find("expected indices within 2^30 of 0"),
              std::string::npos);
    std::vector<double> few(23);
    EXPECT_EQ(errorOf([&] { readVoxels(volume, volume.box(), few); }),
              "usage: voxels to read: values: got 23 values; expected 24");
}

TEST(MakeVolumeOfGrid, leavesTheGridAsItIs) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(3);
    grid->setName("surface");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    for (int x = -3; x <= 3; ++x) grid->tree().setValueOn({x, 1, 2}, float(x));
    const auto before = grid->deepCopy();
    const Volume fog = makeVolume(openvdb::GridBase::ConstPtr(grid));
    EXPECT_EQ(fog.name(), "surface");
    EXPECT_EQ(grid->background(), 3);
    for (auto voxel = before->cbeginValueOn(); voxel; ++voxel)
        EXPECT_EQ(grid->tree().getValue(voxel.getCoord()), *voxel);
    EXPECT_EQ(grid->activeVoxelCount(), before->activeVoxelCount());
    ReadOptions options;
    options.levelSetToFog = false;
    options.keepSource = true;
    const Volume kept = makeVolume(openvdb::GridBase::ConstPtr(grid), options);
    EXPECT_EQ(kept.activeCount(), 7u);
    EXPECT_EQ(makeGrid(kept).get(), static_cast<openvdb::GridBase*>(grid.get()));
}

TEST(MakeVolumeOfGrid, keepsThePatientsSpace) {
    const std::vector<float> values = someValues<float>();
    MemoryLayout layout{kDims};
    layout.background = 0;
    layout.space = "RAS";
    for (const bool keep : {false, true}) {
        ReadOptions options;
        options.keepSource = keep;
        const Volume volume = makeVolume(view(values), layout, options);
        EXPECT_EQ(volume.space(), "RAS");
        EXPECT_EQ(makeVolume(makeGrid(volume)).space(), "RAS");
    }
}

TEST(MakeVolumeOfGrid, refusesWhatIsNoVolume) {
    EXPECT_EQ(
        errorOf([] { makeGrid(Volume()); }),
        "usage: OpenVDB grid to make: got a volume without voxels; expected one that was read or "
        "made");
    EXPECT_EQ(errorOf([] { makeVolume(openvdb::GridBase::ConstPtr()); }),
              "usage: OpenVDB grid: got none; expected a grid");
    const openvdb::GridBase::ConstPtr vectors = openvdb::Vec3SGrid::create();
    EXPECT_NE(errorOf([&] { makeVolume(vectors); }).find("expected a scalar grid"),
              std::string::npos);
}

}  // namespace
}  // namespace deltasplat
