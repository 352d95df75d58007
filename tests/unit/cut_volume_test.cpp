// SPDX-License-Identifier: Apache-2.0
// What is left of volumes that are cut, voxel by voxel against plain loops.
#include "deltasplat/cut/cut_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "deltasplat/ingest/make_volume.h"
#include "deltasplat/optics/default_ramp.h"
#include "support/error_of.h"
#include "support/make_volume.h"
#include "volume/cut_region.h"

namespace deltasplat {
namespace {

using test::errorOf;
using Keeps = std::function<bool(const glm::ivec3& voxel)>;

const IndexBox kBox{{-5, 3, -11}, {17, 22, 6}};

glm::dmat4 obliqueMatrix() {
    glm::dmat4 matrix(1);
    matrix[0] = {1.1, 0.2, -0.3, 0};
    matrix[1] = {-0.4, 0.8, 0.1, 0};
    matrix[2] = {0.25, -0.1, 1.7, 0};
    matrix[3] = {12, -7, 3.5, 1};
    return matrix;
}

glm::dvec3 worldOf(const glm::dmat4& matrix, const glm::dvec3& at) {
    return glm::dvec3(matrix[0]) * at.x + glm::dvec3(matrix[1]) * at.y +
           glm::dvec3(matrix[2]) * at.z + glm::dvec3(matrix[3]);
}

template <typename Use>
void forVoxels(const IndexBox& box, const Use& use) {
    for (int x = box.min.x; x <= box.max.x; ++x) {
        for (int y = box.min.y; y <= box.max.y; ++y) {
            for (int z = box.min.z; z <= box.max.z; ++z) use(glm::ivec3(x, y, z));
        }
    }
}

int codeIn(const Volume& volume, const glm::ivec3& at) {
    Code code = 0;
    return volume.codes()->tree().probeValue({at.x, at.y, at.z}, code) ? code : test::kInactive;
}

IndexBox grown(const IndexBox& box, int by) {
    return {box.min - by, box.max + by};
}

// Compares all that there is to say of the voxels that are left.
void expectCut(const Volume& whole, const Volume& cut, const Keeps& keeps) {
    std::map<int, std::uint64_t> counts;
    std::uint64_t active = 0;
    int wrong = 0;
    forVoxels(grown(whole.box(), 2), [&](const glm::ivec3& at) {
        const int before = codeIn(whole, at);
        const int expected = before >= 0 && keeps(at) ? before : test::kInactive;
        if (codeIn(cut, at) != expected) ++wrong;
        if (expected < 0) return;
        ++counts[expected];
        ++active;
    });
    EXPECT_EQ(wrong, 0);
    ASSERT_GT(active, 0u) << "a test of nothing";
    EXPECT_LT(active, whole.activeCount()) << "a test of nothing";
    EXPECT_EQ(cut.activeCount(), active);
    EXPECT_EQ(cut.codes()->tree().activeVoxelCount(), active);
    ASSERT_EQ(cut.histogram().size(), std::size_t(kCodeCount));
    std::uint64_t sum = 0;
    for (const std::uint64_t count : cut.histogram()) sum += count;
    EXPECT_EQ(sum, active);
    std::pair<int, std::uint64_t> most{0, 0};
    for (const auto& [code, count] : counts) {
        EXPECT_EQ(cut.histogram()[std::size_t(code)], count) << code;
        if (count > most.second) most = {code, count};
    }
    EXPECT_EQ(cut.valueMin(), counts.begin()->first);
    EXPECT_EQ(cut.valueMax(), counts.rbegin()->first);
    ASSERT_TRUE(cut.mostFrequent());
    EXPECT_EQ(cut.mostFrequent()->value, most.first);
    EXPECT_EQ(cut.mostFrequent()->count, most.second);
    EXPECT_EQ(cut.uncut(), whole.codes());
    EXPECT_EQ(cut.worldFromIndex(), whole.worldFromIndex());
}

// By the formula of the documentation, which shares nothing with the code.
bool isBeyond(const Volume& volume, const ClipPlane& plane, const glm::ivec3& at) {
    const glm::dvec3 way = worldOf(volume.worldFromIndex(), at) - plane.pointWorld;
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis)
        extent += std::abs(glm::dot(plane.normalWorld, glm::dvec3(volume.worldFromIndex()[axis])));
    return glm::dot(way, plane.normalWorld) >= -1e-6 * extent;
}

bool isIn(const IndexBox& box, const glm::ivec3& at) {
    for (int axis = 0; axis < 3; ++axis) {
        if (at[axis] < box.min[axis] || at[axis] > box.max[axis]) return false;
    }
    return true;
}

// The box of what is active by a plain loop.
IndexBox tightBox(const Volume& volume) {
    IndexBox box;
    bool any = false;
    forVoxels(volume.box(), [&](const glm::ivec3& at) {
        if (codeIn(volume, at) < 0) return;
        box = any ? IndexBox{glm::min(box.min, at), glm::max(box.max, at)} : IndexBox{at, at};
        any = true;
    });
    return box;
}

Volume denseVolume(int seed = 1) {
    return test::randomVolume(kBox, std::uint32_t(seed), 0);
}

Volume sparseVolume() {
    Volume volume = test::randomVolume(kBox, 7, 0.9);
    test::changed(volume)->hasBackground = true;
    return volume;
}

// A tile of 128x128x128 voxels, and some of 8x8x8.
Volume tiledVolume() {
    VolumeData volume;
    volume.name = "tiles";
    volume.codeBook = CodeBook::integer();
    volume.box = {glm::ivec3(-16), glm::ivec3(143)};
    auto codes = std::make_shared<CodeTree>();
    codes->tree().fill(openvdb::CoordBBox(openvdb::Coord(-16), openvdb::Coord(143)), 40);
    codes->tree().fill(openvdb::CoordBBox(openvdb::Coord(-16), openvdb::Coord(-9)), 41);
    volume.activeCount = std::uint64_t(volume.box.voxels());
    volume.codes = codes;
    EXPECT_EQ(codes->tree().leafCount(), 0u);
    return Volume(std::move(volume));
}

glm::dvec3 randomVector(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double x = uniform(random);
    const double y = uniform(random);
    return {x, y, uniform(random)};
}

TEST(CutVolume, boxesOfIndices) {
    const Volume volume = denseVolume();
    std::mt19937 random(3);
    for (int round = 0; round < 40; ++round) {
        Cut cut;
        IndexBox box;
        for (int axis = 0; axis < 3; ++axis) {
            const int width = kBox.max[axis] - kBox.min[axis] + 1;
            box.min[axis] = kBox.min[axis] - 2 + int(random() % unsigned(width));
            box.max[axis] = std::max(box.min[axis], kBox.min[axis]) + int(random() % 9);
        }
        cut.cropIndex = box;
        const Volume left = cutVolume(volume, cut);
        expectCut(volume, left, [&](const glm::ivec3& at) { return isIn(box, at); });
        EXPECT_EQ(left.box().min, glm::max(box.min, kBox.min));
        EXPECT_EQ(left.box().max, glm::min(box.max, kBox.max));
    }
}

TEST(CutVolume, slices) {
    const Volume volume = denseVolume();
    for (int axis = 0; axis < 3; ++axis) {
        Cut cut;
        const glm::ivec2 slices(kBox.min[axis] + 3, kBox.min[axis] + 10);
        cut.slices[std::size_t(axis)] = slices;
        const Volume left = cutVolume(volume, cut);
        expectCut(volume, left, [&](const glm::ivec3& at) {
            return at[axis] >= slices.x && at[axis] <= slices.y;
        });
        EXPECT_EQ(left.box().dims()[axis], 8);
        EXPECT_EQ(left.box().dims()[(axis + 1) % 3], kBox.dims()[(axis + 1) % 3]);
    }
}

TEST(CutVolume, boxesInTheWorld) {
    Volume volume = denseVolume();
    test::changed(volume)->worldFromIndex = obliqueMatrix();
    std::mt19937 random(4);
    for (int round = 0; round < 20; ++round) {
        const glm::dvec3 middle = worldOf(volume.worldFromIndex(), glm::dvec3(6, 12, -3));
        const glm::dvec3 half = 4.0 + 5.0 * glm::abs(randomVector(random));
        Cut cut;
        cut.cropWorld = WorldBox{middle - half, middle + half};
        const Volume left = cutVolume(volume, cut);
        expectCut(volume, left, [&](const glm::ivec3& at) {
            const glm::dvec3 off = glm::abs(worldOf(volume.worldFromIndex(), at) - middle);
            return off.x <= half.x && off.y <= half.y && off.z <= half.z;
        });
        EXPECT_EQ(left.box(), tightBox(left));
    }
}

// Sides that voxel centres lie on keep them, whatever 3 * 0.1 is in binary.
TEST(CutVolume, sidesOfAWorldBoxAreInside) {
    Volume volume = denseVolume();
    test::changed(volume)->worldFromIndex = glm::dmat4(1);
    for (int axis = 0; axis < 3; ++axis) test::changed(volume)->worldFromIndex[axis][axis] = 0.1;
    Cut cut;
    cut.cropWorld = WorldBox{{-0.3, 0.3, -1.1}, {0.3, 1.2, 0.6}};
    EXPECT_EQ(cutVolume(volume, cut).box(), (IndexBox{{-3, 3, -11}, {3, 12, 6}}));
}

TEST(CutVolume, planes) {
    Volume volume = denseVolume();
    std::mt19937 random(5);
    for (int round = 0; round < 30; ++round) {
        test::changed(volume)->worldFromIndex = round % 2 ? obliqueMatrix() : glm::dmat4(1);
        Cut cut;
        const glm::dvec3 middle = worldOf(volume.worldFromIndex(), glm::dvec3(6, 12, -3));
        for (int plane = 0; plane <= round % 3; ++plane) {
            // The middle is left by all of them.
            const glm::dvec3 way = 4.0 * randomVector(random);
            glm::dvec3 normal = 3.0 * randomVector(random);
            if (glm::dot(way, normal) > 0) normal = -normal;
            cut.clipPlanes.push_back({middle + way, normal});
        }
        const Volume left = cutVolume(volume, cut);
        expectCut(volume, left, [&](const glm::ivec3& at) {
            for (const ClipPlane& plane : cut.clipPlanes) {
                if (!isBeyond(volume, plane, at)) return false;
            }
            return true;
        });
        EXPECT_EQ(left.box(), volume.box()) << "the camera stays";
    }
}

TEST(CutVolume, aPlaneThroughCentersKeepsThem) {
    const Volume volume = denseVolume();
    Cut cut;
    cut.clipPlanes = {{{3, 0, 0}, {1, 0, 0}}};
    expectCut(volume, cutVolume(volume, cut), [](const glm::ivec3& at) { return at.x >= 3; });
    cut.clipPlanes = {{{3, 0, 0}, {-1e30, 0, 0}}};
    expectCut(volume, cutVolume(volume, cut), [](const glm::ivec3& at) { return at.x <= 3; });
}

TEST(CutVolume, tilesAreSplit) {
    const Volume volume = tiledVolume();
    Cut cut;
    cut.clipPlanes = {{{50, 60, 70}, {1, 0.7, -0.4}}};
    const Volume left = cutVolume(volume, cut);
    expectCut(volume, left,
              [&](const glm::ivec3& at) { return isBeyond(volume, cut.clipPlanes[0], at); });
    EXPECT_GT(left.codes()->tree().activeTileCount(), 1000u) << "what is uniform stays tiles";

    cut = {};
    cut.cropIndex = IndexBox{glm::ivec3(-13), glm::ivec3(100)};
    expectCut(volume, cutVolume(volume, cut),
              [&](const glm::ivec3& at) { return isIn(*cut.cropIndex, at); });
}

TEST(CutVolume, ofSparseOnesTheBoxIsTight) {
    const Volume volume = sparseVolume();
    Cut cut;
    cut.cropIndex = IndexBox{{-4, 4, -10}, {5, 12, -1}};
    const Volume left = cutVolume(volume, cut);
    expectCut(volume, left, [&](const glm::ivec3& at) { return isIn(*cut.cropIndex, at); });
    EXPECT_EQ(left.box(), tightBox(left));
    cut.clipPlanes = {{{0, 6, 0}, {0.1, 1, 0}}};
    EXPECT_EQ(cutVolume(volume, cut).box(), left.box());
}

bool isKept(const Volume& mask, const glm::dvec3& at) {
    const glm::ivec3 nearest(std::floor(at.x + 0.5), std::floor(at.y + 0.5),
                             std::floor(at.z + 0.5));
    return codeIn(mask, nearest) > 0;
}

Volume someMask(const IndexBox& box) {
    return test::makeVolume(box, [](int x, int y, int z) {
        const int choice = (x * 7 + y * 13 + z * 29 + 10000) % 5;
        return choice < 2 ? choice - 1 : choice;  // inactive, 0 and others
    });
}

class Warnings {
  public:
    Listener listener() {
        return {{}, [this](const std::string& line) { text += line + "\n"; }};
    }
    std::string text;
};

TEST(CutVolume, masksByIndex) {
    Volume volume = denseVolume();
    test::changed(volume)->worldFromIndex = obliqueMatrix();
    auto mask = std::make_shared<Volume>(someMask(kBox));
    test::changed(*mask)->worldFromIndex = volume.worldFromIndex();
    Cut cut;
    cut.mask = mask;
    Warnings warnings;
    const Volume left = cutVolume(volume, cut, warnings.listener());
    expectCut(volume, left, [&](const glm::ivec3& at) { return isKept(*mask, at); });
    EXPECT_EQ(left.box(), volume.box());

    // By whole voxels, and as exactly as a file of floats states it.
    test::changed(*mask)->worldFromIndex[3] +=
        3.0 * mask->worldFromIndex()[1] + glm::dvec4(1e-5, 0, 0, 0);
    expectCut(volume, cutVolume(volume, cut, warnings.listener()),
              [&](const glm::ivec3& at) { return isKept(*mask, at - glm::ivec3(0, 3, 0)); });
    EXPECT_EQ(warnings.text, "");
}

// Each in its own unit of length.
TEST(CutVolume, masksInOtherUnits) {
    Volume volume = denseVolume();
    test::changed(volume)->worldFromIndex = obliqueMatrix();
    test::changed(volume)->lengthUnit = "mm";
    auto mask = std::make_shared<Volume>(someMask(kBox));
    test::changed(*mask)->worldFromIndex = volume.worldFromIndex();
    for (int column = 0; column < 4; ++column)
        test::changed(*mask)->worldFromIndex[column] *= glm::dvec4(0.1, 0.1, 0.1, 1);
    test::changed(*mask)->lengthUnit = "cm";
    Cut cut;
    cut.mask = mask;
    Warnings warnings;
    const Volume left = cutVolume(volume, cut, warnings.listener());
    expectCut(volume, left, [&](const glm::ivec3& at) { return isKept(*mask, at); });
    EXPECT_EQ(warnings.text, "");
}

TEST(CutVolume, masksByPlace) {
    Volume volume = denseVolume();
    test::changed(volume)->worldFromIndex = obliqueMatrix();
    auto mask = std::make_shared<Volume>(someMask({{-40, -40, -40}, {40, 40, 40}}));
    test::changed(*mask)->worldFromIndex = glm::dmat4(1);
    for (int axis = 0; axis < 3; ++axis)
        test::changed(*mask)->worldFromIndex[axis][axis] = 2.2 - 0.5 * axis;
    // No voxel lies half way between two of the mask.
    test::changed(*mask)->worldFromIndex[3] = {7.1317, -3.3171, 4.7713, 1};
    Cut cut;
    cut.mask = mask;
    Warnings warnings;
    expectCut(volume, cutVolume(volume, cut, warnings.listener()), [&](const glm::ivec3& at) {
        const glm::dvec3 place =
            worldOf(volume.worldFromIndex(), at) - glm::dvec3(mask->worldFromIndex()[3]);
        return isKept(*mask, place / glm::dvec3(2.2, 1.7, 1.2));
    });
    EXPECT_EQ(warnings.text,
              "`mask`: its voxels lie elsewhere than the volume's; each of these takes the nearest "
              "of those\n");
}

TEST(CutVolume, masksOfTiles) {
    const Volume volume = tiledVolume();
    auto mask = std::make_shared<Volume>(someMask({{3, 5, 9}, {30, 33, 40}}));
    Cut cut;
    cut.mask = mask;
    expectCut(volume, cutVolume(volume, cut),
              [&](const glm::ivec3& at) { return isKept(*mask, at); });
}

TEST(CutVolume, allTogetherAndOneAfterTheOther) {
    const Volume volume = denseVolume();
    Cut cut;
    cut.cropIndex = IndexBox{{-3, 5, -9}, {12, 20, 3}};
    cut.slices[2] = glm::ivec2(-6, 30);
    cut.cropWorld = WorldBox{{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {9.5, HUGE_VAL, HUGE_VAL}};
    cut.clipPlanes = {{{4, 9, -2}, {1, 1, 1}}};
    cut.mask = std::make_shared<Volume>(someMask(kBox));
    const Volume left = cutVolume(volume, cut);
    expectCut(volume, left, [&](const glm::ivec3& at) {
        return isIn(*cut.cropIndex, at) && at.z >= -6 && at.x <= 9 &&
               isBeyond(volume, cut.clipPlanes[0], at) && isKept(*cut.mask, at);
    });
    EXPECT_EQ(left.box(), (IndexBox{{-3, 5, -6}, {9, 20, 3}}));

    Volume twice = volume;
    Cut parts[3];
    parts[0].cropIndex = cut.cropIndex;
    parts[0].slices = cut.slices;
    parts[1].cropWorld = cut.cropWorld;
    parts[1].clipPlanes = cut.clipPlanes;
    parts[2].mask = cut.mask;
    for (const Cut& part : parts) twice = cutVolume(twice, part);
    EXPECT_EQ(twice.histogram(), left.histogram());
    EXPECT_EQ(twice.box(), left.box());
    EXPECT_EQ(twice.uncut(), volume.codes());
}

TEST(CutVolume, colorsStay) {
    Volume volume = denseVolume();
    test::changed(volume)->valueMax = 255;
    Cut cut;
    cut.cropIndex = IndexBox{kBox.min, kBox.min};
    const Volume left = cutVolume(volume, cut);
    EXPECT_EQ(left.activeCount(), 1u);
    EXPECT_EQ(bulkRange(left), bulkRange(volume));
}

// Values that codes do not hold exactly are the source's.
TEST(CutVolume, theSourceIsCutAsWell) {
    const glm::i64vec3 dims(19, 14, 23);
    std::vector<double> values;
    std::mt19937 random(9);
    for (std::int64_t i = 0; i < dims.x * dims.y * dims.z; ++i)
        values.push_back(std::uniform_real_distribution<double>(-3, 5)(random));
    MemoryLayout layout;
    layout.dims = dims;
    ReadOptions options;
    options.bits = 8;
    options.keepSource = true;
    const Volume volume = makeVolume(std::span<const double>(values), layout, options);
    ASSERT_FALSE(volume.codeBook().isExact());
    Cut cut;
    cut.clipPlanes = {{{8, 6, 10}, {0.3, -1, 0.6}}};
    const Volume left = cutVolume(volume, cut);
    std::vector<double> found(values.size());
    std::vector<std::uint8_t> active(values.size());
    readVoxels(left, left.box(), found, active);
    double low = 1e300;
    double high = -1e300;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const glm::ivec3 at(std::int64_t(i) % dims.x, std::int64_t(i) / dims.x % dims.y,
                            std::int64_t(i) / (dims.x * dims.y));
        const bool kept = isBeyond(volume, cut.clipPlanes[0], at);
        ASSERT_EQ(active[i], kept ? 1 : 0) << i;
        ASSERT_EQ(found[i], kept ? values[i] : 0) << i;
        if (!kept) continue;
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
    }
    EXPECT_EQ(left.valueMin(), low);
    EXPECT_EQ(left.valueMax(), high);
    EXPECT_GT(low, volume.valueMin()) << "a test of nothing";
}

TEST(CutVolume, sharesOfVoxels) {
    // Along an axis the share is that of the box, obliquely it is 0 and 1 where the box ends.
    glm::dmat4 matrix(1);
    matrix[0][0] = 2;
    const IndexPlane along = indexPlane({{7, 0, 0}, {5, 0, 0}}, matrix);
    EXPECT_DOUBLE_EQ(along.keptShare({3, 0, 0}), 0);
    EXPECT_DOUBLE_EQ(along.keptShare({3.25, 0, 0}), 0.25);
    EXPECT_DOUBLE_EQ(along.keptShare({3.5, 9, -9}), 0.5);
    EXPECT_DOUBLE_EQ(along.keptShare({4, 0, 0}), 1);
    const IndexPlane oblique = indexPlane({{1, 2, 3}, {1, 1, -1}}, obliqueMatrix());
    std::mt19937 random(2);
    for (int round = 0; round < 100; ++round) {
        const glm::dvec3 at = 9.0 * randomVector(random);
        int beyond = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 end = at + glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 0.5;
            const glm::dvec3 way = worldOf(obliqueMatrix(), end) - glm::dvec3(1, 2, 3);
            beyond += way.x + way.y - way.z > 0 ? 1 : 0;
        }
        const double share = oblique.keptShare(at);
        EXPECT_EQ(share <= 0, beyond == 0);
        EXPECT_EQ(share >= 1, beyond == 8);
    }
}

TEST(CutVolume, nothingToCut) {
    const Volume volume = denseVolume();
    EXPECT_EQ(cutVolume(volume, {}).codes(), volume.codes());
    Cut cut;
    cut.cropIndex = IndexBox{glm::ivec3(100), glm::ivec3(110)};
    Volume empty = test::makeVolume({}, [](int, int, int) { return 0; });
    EXPECT_TRUE(cutVolume(empty, cut).empty());
}

TEST(CutVolume, refusals) {
    const Volume volume = denseVolume();
    const Volume sparse =
        test::makeVolume(kBox, [](int x, int, int) { return x < 0 ? 1 : test::kInactive; });
    Cut cut;
    const auto said = [&](const Volume& of) { return errorOf([&] { cutVolume(of, cut); }); };
    cut.cropIndex = IndexBox{{20, 0, 0}, {30, 9, 9}};
    EXPECT_EQ(said(volume),
              "usage: `cropIndex`: got 20:30,0:9,0:9; expected a box that overlaps the volume's, "
              "-5:17,3:22,-11:6");
    cut.cropIndex = IndexBox{{4, 3, -11}, {30, 9, 9}};
    EXPECT_EQ(said(sparse),
              "usage: `cropIndex`: got 4:17,3:9,-11:6; expected a box with active voxels of those "
              "in -5:17,3:22,-11:6");
    cut = {};
    cut.slices[2] = glm::ivec2(7, std::numeric_limits<int>::max());
    EXPECT_EQ(said(volume),
              "usage: `slices`: got z:7:; expected slices of those that there are, z:-11:6");
    cut = {};
    cut.cropWorld = WorldBox{{40, 0, 0}, {50, 9, HUGE_VAL}};
    EXPECT_EQ(said(volume),
              "usage: `cropWorld`: got the world box 40:50,0:9,0:; expected a box with active "
              "voxels of those in -5:17,3:22,-11:6");
    cut.cropWorld = WorldBox{{4, 0, 0}, {3, 9, 9}};
    EXPECT_EQ(said(volume).substr(0, 18), "usage: `cropWorld`");
    cut = {};
    cut.clipPlanes = {{{40, 0, 0}, {1, 0, 0}}};
    EXPECT_EQ(said(volume),
              "usage: `clipPlanes`: got planes that leave nothing; expected some voxel beyond all "
              "of them, of those in the world box -5:17,3:22,-11:6");
    cut.clipPlanes = {{{0, 0, 0}, {0, 0, 0}}};
    EXPECT_EQ(said(volume),
              "usage: `clipPlanes`: got point 0,0,0 and normal 0,0,0; expected finite numbers, and "
              "a normal other than 0,0,0");
    cut.clipPlanes = {{{0, 0, 0}, {0, NAN, 0}}};
    EXPECT_EQ(said(volume).substr(0, 19), "usage: `clipPlanes`");
    cut = {};
    cut.mask = std::make_shared<Volume>(someMask({{100, 0, 0}, {110, 9, 9}}));
    EXPECT_EQ(said(volume),
              "input: `mask`: got a mask in the world box 100:110,0:9,0:9 that leaves nothing; "
              "expected one that keeps some voxel of those in -5:17,3:22,-11:6");
}

}  // namespace
}  // namespace deltasplat
