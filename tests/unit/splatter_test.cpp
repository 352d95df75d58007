// SPDX-License-Identifier: Apache-2.0
#include "splat/splatter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "deltasplat/optics/class_table.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

// What a picture along x is splatted from.
struct Scene {
    Scene(const Volume& volume, Encoding encoding, const Footprint& print, bool oneColor)
        : classes(classesOf(volume, oneColor)),
          deltas(packDeltas(volume, {0, encoding, classes.classOfSlot, {}})),
          footprint(print),
          layout(layoutSheet(deltas.box, footprint, oneColor ? 1 : 4)),
          input{deltas, classes, footprint, false} {}

    static ClassTable classesOf(const Volume& volume, bool oneColor) {
        Optics optics;
        optics.transferFunction.colors = {{0, {1, 0, 0.5}}};
        if (!oneColor) optics.transferFunction.colors.push_back({255, {0.2, 1, 0}});
        optics.transferFunction.opacities = {{60, 0, 0.5, 0}, {200, 0.4, 0.5, 0}, {255, 1, 0.5, 0}};
        return classify(volume, optics, 1);
    }

    ClassTable classes;
    PackedDeltas deltas;
    Footprint footprint;
    SheetLayout layout;
    SplatInput input;
};

// The sheet of a slice, all voxels of which are stamped one by one.
std::vector<std::int32_t> stampedSheet(const Scene& scene, int slice) {
    Sheet sheet(scene.layout);
    StampSplatter splatter(scene.input, scene.layout, sheet);
    splatter.splat(slice, true, 0, scene.layout.sizePixels.y);
    return {sheet.row(0), sheet.row(0) + sheet.pitch() * scene.layout.sizePixels.y};
}

bool isFullWhereNotZero(const Sheet& sheet, int row) {
    const std::size_t length = std::size_t{kTilePixels} * sheet.layout().channels;
    for (int tile = 0; tile < sheet.layout().tiles().x; ++tile) {
        const std::int32_t* first = sheet.row(row) + length * tile;
        const bool zero = std::all_of(first, first + length, [](int value) { return value == 0; });
        const bool full = sheet.fullRows(row / kTilePixels)[tile] >> row % kTilePixels & 1;
        if (!zero && !full) return false;
    }
    return true;
}

const IndexBox kBox{{-19, -11, 2}, {20, 50, 25}};

// Few voxels change in the first, most in the second.
std::vector<Volume> volumes() {
    return {test::makeVolume(kBox,
                             [](int x, int y, int z) {
                                 const int d =
                                     (x - 3) * (x - 3) + (y - 20) * (y - 20) + (z - 12) * (z - 12);
                                 if (d < 150) return d < 70 ? 220 : 90;
                                 return (x + 3 * y + 5 * z) % 211 == 0 ? 150 : test::kInactive;
                             }),
            test::randomVolume(kBox, 4, 0.4)};
}

// Of a footprint.
struct Kind {
    int resolution;
    int width;
};

// A window of rows that moves over the sheet from slice to slice and comes back: in it the sheet is
// that of the slice, whatever was passed over meanwhile, and in the end nothing is left.
TEST(Splatter, RowsOfAMovingWindowAreThoseOfTheSlice) {
    for (const Volume& volume : volumes()) {
        for (const bool oneColor : {false, true}) {
            for (const Kind kind : {Kind{1, 3}, {1, 6}, {2, 5}, {3, 9}, {4, 13}}) {
                const auto [resolution, width] = kind;
                const Footprint footprint = makeFootprint(0.5, {0.3, -0.6}, resolution, width);
                const Scene whole(volume, Encoding::kWhole, footprint, oneColor);
                for (const Encoding encoding : {Encoding::kChanges, Encoding::kWhole}) {
                    const Scene scene(volume, encoding, footprint, oneColor);
                    Splatter splatter(scene.input, scene.layout);
                    const int height = scene.layout.sizePixels.y;
                    const std::size_t pitch = scene.layout.channels * scene.layout.pitchPixels();
                    for (const PlannedSlab& slab : scene.deltas.slabs) {
                        splatter.begin(slab, scene.layout);
                        const Sheet* sheet = nullptr;
                        for (int i = 0; i < slab.sliceCount; ++i) {
                            const int first = 11 * i % (height - 15);
                            const int slice = slab.firstSlice + i;
                            sheet = &splatter.splat(slice, first, first + 15);
                            const std::vector<std::int32_t> expected = stampedSheet(whole, slice);
                            for (int y = first; y < first + 15; ++y) {
                                ASSERT_TRUE(std::equal(sheet->row(y), sheet->row(y) + pitch,
                                                       &expected[pitch * y]))
                                    << "slice " << slice << " row " << y << " width " << width;
                                ASSERT_TRUE(isFullWhereNotZero(*sheet, y)) << slice << ' ' << y;
                            }
                        }
                        splatter.end();
                        for (std::size_t p = 0; p < pitch * height; ++p)
                            ASSERT_EQ(sheet->row(0)[p], 0);
                    }
                }
            }
        }
    }
}

// Without a volume's words, so that every mask is that of the box alone.
TEST(SliceBlocks, TraditionalTakesEveryVoxelOfTheBox) {
    const Volume volume = test::makeVolume(kBox, [](int, int, int) { return 200; });
    const Scene scene(volume, Encoding::kWhole, makeFootprint(0.5, {0, 0}, 1), false);
    PackedDeltas nothing;
    nothing.box = scene.deltas.box;
    nothing.begins.resize(std::size_t(nothing.box.dims().x) + 1);
    const SplatInput input{nothing, scene.classes, scene.footprint, true};
    const SliceBlocks blocks(input, scene.layout);
    std::vector<glm::ivec2> found;
    blocks.forEach(kBox.min.x, true, blocks.rows(),
                   [&](glm::ivec2 block, std::uint64_t voxels, const DeltaWord&) {
                       const glm::ivec2 first = scene.layout.firstVoxel + 8 * block;
                       for (int n = 0; n < 64; ++n) {
                           if (voxels >> n & 1) found.push_back(first + glm::ivec2(n % 8, n / 8));
                       }
                   });
    const auto inside = [&](glm::ivec2 voxel) {
        return voxel.x >= kBox.min.z && voxel.x <= kBox.max.z && voxel.y >= kBox.min.y &&
               voxel.y <= kBox.max.y;
    };
    EXPECT_TRUE(std::all_of(found.begin(), found.end(), inside));
    const auto before = [](glm::ivec2 a, glm::ivec2 b) {
        return a.y != b.y ? a.y < b.y : a.x < b.x;
    };
    std::sort(found.begin(), found.end(), before);
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    const glm::ivec3 dims = kBox.dims();
    EXPECT_EQ(found.size(), std::size_t(dims.y) * dims.z);
}

}  // namespace
}  // namespace deltasplat
