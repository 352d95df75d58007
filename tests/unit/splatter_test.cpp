// SPDX-License-Identifier: Apache-2.0
#include "splat/splatter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "deltasplat/optics/class_table.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

// Of the colours of a picture: in one digit, in two, or on two planes as well.
enum class Range { kOneDigit, kTwoDigits, kTwoPlanes };

// What a picture along x is splatted from.
struct Scene {
    Scene(const Volume& volume, Encoding encoding, const Footprint& print, bool oneColor,
          Range range = Range::kOneDigit)
        : classes(classesOf(volume, oneColor, range)),
          deltas(packDeltas(volume, {0, encoding, classes.classOfSlot(), {}})),
          colors(deltas, classes, nullptr),
          footprint(print),
          layout(layoutSheet(deltas.box, footprint, oneColor ? 1 : 4)),
          digits(deltas, classes, footprint.width > 1),
          input{deltas, colors, footprint, classes.oneDigit() ? nullptr : &digits, false} {}

    static ClassTable classesOf(const Volume& volume, bool oneColor, Range range) {
        Optics optics;
        TransferFunction& function = optics.transferFunction;
        function.linearColors = true;
        function.colors = {{0, {1, 0.1, 0.5}}};
        if (!oneColor) function.colors.push_back({255, {0.2, 1, 0.1}});
        const double least = range == Range::kOneDigit    ? 0.03
                             : range == Range::kTwoDigits ? 1e-5
                                                          : 1e-9;
        function.opacities = {{60, 0, 0.5, 0},     {61, least, 0.5, 0}, {140, 2 * least, 0.5, 0},
                              {150, 0.07, 0.5, 0}, {200, 0.4, 0.5, 0},  {255, 1, 0.5, 0}};
        ClassTable classes = classify(volume, optics, 1);
        EXPECT_EQ(classes.oneDigit(), range == Range::kOneDigit);
        EXPECT_EQ(classes.planes.size(), range == Range::kTwoPlanes ? 2u : 1u);
        return classes;
    }

    ClassTable classes;
    PackedDeltas deltas;
    StepColors colors;
    Footprint footprint;
    SheetLayout layout;
    DigitVoxels digits;
    SplatInput input;
};

// What the voxels of a slice add up to in one digit, by plain sums. The scene's slabs are whole.
std::vector<std::int64_t> sumOfDigit(const Scene& scene, const ClassTable::Digit& digit,
                                     int slice) {
    const SheetLayout& layout = scene.layout;
    const int channels = layout.channels;
    const std::size_t pitch = channels * layout.pitchPixels();
    std::vector<std::int64_t> sums(pitch * layout.sizePixels.y);
    if (digit.colors.empty()) return sums;
    for (const DeltaWord& word : scene.deltas.slice(slice)) {
        for (int n = 0; n < 64; ++n) {
            if ((word.visible >> n & 1) == 0) continue;
            const glm::ivec2 voxel(8 * word.block.y + n % 8, 8 * word.block.x + n / 8);
            const ClassTable::Color& color = digit.colors[word.classes[n]];
            for (int y = 0; y < scene.footprint.width; ++y) {
                for (int x = 0; x < scene.footprint.width; ++x) {
                    std::int64_t* sum =
                        &sums[channels * layout.stampPlace(voxel) + y * pitch + x * channels];
                    for (int c = 0; c < channels; ++c)
                        sum[c] += color[channels == 1 ? 3 : c] * scene.footprint.at(x, y);
                }
            }
        }
    }
    return sums;
}

// The sheets of all planes of a slice.
std::vector<std::vector<std::int32_t>> plainSheets(const Scene& scene, int slice) {
    std::vector<std::vector<std::int32_t>> sheets;
    for (const ClassTable::Plane& plane : scene.classes.planes) {
        const std::vector<std::int64_t> high = sumOfDigit(scene, plane.high, slice);
        const std::vector<std::int64_t> low = sumOfDigit(scene, plane.low, slice);
        sheets.emplace_back();
        for (std::size_t i = 0; i < high.size(); ++i)
            sheets.back().push_back(std::int32_t(high[i] + ((low[i] + (1 << 14)) >> 15)));
    }
    return sheets;
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

constexpr Kind kMoving[] = {{1, 1}, {1, 3}, {1, 5},  {1, 6}, {1, 7},
                            {2, 5}, {2, 9}, {2, 11}, {3, 9}, {4, 13}};
constexpr Kind kCovered[] = {{1, 1}, {1, 3}, {1, 6}, {1, 7}, {2, 5}, {2, 9}, {3, 9}};

// A window of rows that moves over the sheet from slice to slice, and comes back or not: in it the
// sheet is that of the slice, whatever was passed over meanwhile, and in the end nothing is left.
void expectMovingWindow(const Volume& volume, bool oneColor, const Footprint& footprint,
                        Range range, bool comesBack) {
    const Scene whole(volume, Encoding::kWhole, footprint, oneColor, range);
    std::vector<std::vector<std::vector<std::int32_t>>> expected;
    for (int slice = kBox.min.x; slice <= kBox.max.x; ++slice)
        expected.push_back(plainSheets(whole, slice));
    for (const Encoding encoding : {Encoding::kChanges, Encoding::kWhole}) {
        const Scene scene(volume, encoding, footprint, oneColor, range);
        Splatter splatter(scene.input, scene.layout);
        const int height = scene.layout.sizePixels.y;
        const std::size_t pitch = scene.layout.channels * scene.layout.pitchPixels();
        for (const PlannedSlab& slab : scene.deltas.slabs) {
            splatter.begin(slab, scene.layout);
            std::span<const Sheet* const> sheets;
            for (int i = 0; i < slab.sliceCount; ++i) {
                const int slice = slab.firstSlice + i;
                const int last = (height - 15) / slab.sliceCount * slab.sliceCount;
                const int first = comesBack ? 11 * i % (height - 15) : last * i / slab.sliceCount;
                NeededPixels needed{first, first + 15};
                if (!comesBack) needed.rowsFromNowOn = {first, last + 15};
                sheets = splatter.splat(slice, needed);
                ASSERT_EQ(sheets.size(), scene.classes.planes.size());
                for (std::size_t p = 0; p < sheets.size(); ++p) {
                    for (int y = first; y < first + 15; ++y) {
                        ASSERT_TRUE(std::equal(sheets[p]->row(y), sheets[p]->row(y) + pitch,
                                               &expected[slice - kBox.min.x][p][pitch * y]))
                            << "slice " << slice << " row " << y << " plane " << p << " width "
                            << footprint.width;
                        ASSERT_TRUE(isFullWhereNotZero(*sheets[p], y)) << slice << ' ' << y;
                    }
                    // Pixels of voxels' own are written in rows that are read, and in no others.
                    if (!slab.whole || footprint.width != 1 || comesBack) continue;
                    for (int y = first + 15; y < height; ++y) {
                        ASSERT_TRUE(std::all_of(sheets[p]->row(y), sheets[p]->row(y) + pitch,
                                                [](std::int32_t value) { return value == 0; }))
                            << "slice " << slice << " row " << y;
                    }
                }
            }
            splatter.end();
            for (const Sheet* sheet : sheets) {
                for (std::size_t p = 0; p < pitch * height; ++p) ASSERT_EQ(sheet->row(0)[p], 0);
            }
        }
    }
}

TEST(Splatter, RowsOfAMovingWindowAreThoseOfTheSlice) {
    for (const Volume& volume : volumes()) {
        for (const bool oneColor : {false, true}) {
            for (const Kind kind : kMoving) {
                const Footprint footprint =
                    makeFootprint(0.5, {0.3, -0.6}, kind.resolution, kind.width);
                for (const Range range : {Range::kOneDigit, Range::kTwoDigits, Range::kTwoPlanes}) {
                    expectMovingWindow(volume, oneColor, footprint, range, true);
                    expectMovingWindow(volume, oneColor, footprint, range, false);
                }
            }
        }
    }
}

// Whether a sheet pixel is read by a pixel of the base plane that is not covered.
bool isSeen(const CoveredCells& cells, const SheetReading& reading, glm::ivec2 pixel) {
    const PlaneBox readers{{readersOf(reading, 0, pixel.x, pixel.x + 1, cells.box()).x,
                            readersOf(reading, 1, pixel.y, pixel.y + 1, cells.box()).x},
                           {readersOf(reading, 0, pixel.x, pixel.x + 1, cells.box()).y,
                            readersOf(reading, 1, pixel.y, pixel.y + 1, cells.box()).y}};
    for (int y = readers.min.y; y < readers.max.y; ++y)
        for (int x = readers.min.x; x < readers.max.x; ++x)
            if (!cells.isCovered((glm::ivec2(x, y) - cells.box().min) / CoveredCells::kCellPixels))
                return true;
    return false;
}

// What is covered moves over the sheet from slice to slice, and there is more of it later.
// @param isWindow  of all rows, some are needed in each slice
void expectCovered(const Volume& volume, bool oneColor, const Footprint& footprint, Range range,
                   bool isWindow) {
    const Scene whole(volume, Encoding::kWhole, footprint, oneColor, range);
    for (const Encoding encoding : {Encoding::kChanges, Encoding::kWhole}) {
        const Scene scene(volume, encoding, footprint, oneColor, range);
        const SheetLayout& layout = scene.layout;
        Splatter splatter(scene.input, layout);
        const auto readingOfSlice = [](int slice) {
            return SheetReading{{2 * slice, -slice}, {0.5, 0}, 1};
        };
        for (const PlannedSlab& slab : scene.deltas.slabs) {
            CoveredCells cells({glm::ivec2(-60), layout.sizePixels + 60});
            splatter.begin(slab, layout);
            SheetCover fromNowOn;
            for (int i = 0; i < slab.sliceCount; ++i) {
                const int slice = slab.firstSlice + i;
                if (i % 8 == 0) {
                    for (int y = 0; y < cells.size().y; ++y)
                        for (int x = 0; x < cells.size().x; ++x)
                            if ((x + i) / 7 % 2 == 0 && y > 5) cells.cover({x, y});
                    cells.settle();
                    fromNowOn.set(cells, readingOfSlice(slice),
                                  readingOfSlice(slab.firstSlice + slab.sliceCount - 1), layout);
                }
                SheetCover cover;
                cover.set(cells, readingOfSlice(slice), readingOfSlice(slice), layout);
                const int first = isWindow ? 5 + i % 11 : 0;
                const int last = layout.sizePixels.y - first;
                const auto sheets = splatter.splat(slice, {first, last, &cover, &fromNowOn});
                const auto expected = plainSheets(whole, slice);
                for (int y = first; y < last; ++y) {
                    for (int x = 0; x < layout.sizePixels.x; ++x) {
                        if (!isSeen(cells, readingOfSlice(slice), {x, y})) continue;
                        for (std::size_t p = 0; p < sheets.size(); ++p) {
                            const std::size_t place = layout.channels * std::size_t(x);
                            const std::int32_t* pixel = sheets[p]->row(y) + place;
                            ASSERT_TRUE(std::equal(pixel, pixel + layout.channels,
                                                   &expected[p][sheets[p]->pitch() * y + place]))
                                << slice << ": " << x << ' ' << y << " width " << footprint.width;
                        }
                    }
                }
            }
            splatter.end();
        }
    }
}

TEST(Splatter, WhatIsNotCoveredIsThatOfTheSlice) {
    for (const Volume& volume : volumes()) {
        for (const bool oneColor : {false, true}) {
            for (const Kind kind : kCovered) {
                const Footprint footprint =
                    makeFootprint(0.5, {0.3, -0.6}, kind.resolution, kind.width);
                for (const Range range : {Range::kOneDigit, Range::kTwoDigits, Range::kTwoPlanes})
                    for (const bool isWindow : {false, true})
                        expectCovered(volume, oneColor, footprint, range, isWindow);
            }
        }
    }
}

// Nothing is made where all is covered.
TEST(Splatter, MakesNothingThatIsCovered) {
    const Volume volume = volumes()[0];
    for (const Kind kind : {Kind{1, 1}, {1, 3}, {1, 6}}) {
        const Footprint footprint = makeFootprint(0.5, {0, 0}, kind.resolution, kind.width);
        for (const Encoding encoding : {Encoding::kChanges, Encoding::kWhole}) {
            const Scene scene(volume, encoding, footprint, false);
            CoveredCells cells({{0, 0}, scene.layout.sizePixels});
            for (int y = 0; y < cells.size().y; ++y)
                for (int x = 0; x < cells.size().x; ++x) cells.cover({x, y});
            cells.settle();
            SheetCover cover;
            cover.set(cells, {}, {}, scene.layout);
            Splatter splatter(scene.input, scene.layout);
            const PlannedSlab& slab = scene.deltas.slabs.front();
            splatter.begin(slab, scene.layout);
            for (int i = 0; i < slab.sliceCount; ++i) {
                const Sheet& sheet =
                    *splatter
                         .splat(slab.firstSlice + i, {0, scene.layout.sizePixels.y, &cover, &cover})
                         .front();
                const std::size_t length = sheet.pitch() * std::size_t(scene.layout.sizePixels.y);
                EXPECT_TRUE(std::all_of(sheet.row(0), sheet.row(0) + length,
                                        [](std::int32_t value) { return value == 0; }));
            }
            splatter.end();
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
    const SplatInput input{nothing, scene.colors, scene.footprint, nullptr, true};
    SliceBlocks blocks(input, scene.layout);
    std::vector<glm::ivec2> found;
    blocks.forWhole(kBox.min.x, NeededPixels{0, scene.layout.sizePixels.y},
                    [&](glm::ivec2 block, std::uint64_t voxels, const SeenWord&) {
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
