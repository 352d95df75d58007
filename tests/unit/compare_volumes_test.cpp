// SPDX-License-Identifier: Apache-2.0
// Compares the comparison with one that visits every voxel of a box, and with closed forms.
#include "deltasplat/diff/compare_volumes.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <limits>
#include <random>
#include <utility>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "support/make_volume.h"
#include "volume/tree_grid.h"

namespace deltasplat {
namespace {

using openvdb::Coord;

const IndexBox kBox{glm::ivec3(-21, -9, -13), glm::ivec3(14, 27, 22)};

template <typename Grid>
Volume volumeOf(const typename Grid::Ptr& grid) {
    VolumeData volume;
    volume.name = "test";
    volume.type = grid->valueType();
    volume.gridClass = "fog volume";
    volume.hasBackground = true;
    volume.background = double(grid->background());
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    volume.box = {{box.min().x(), box.min().y(), box.min().z()},
                  {box.max().x(), box.max().y(), box.max().z()}};
    volume.source = std::make_shared<SourceGrid>(SourceGrid{fromOpenVdb(grid)});
    return Volume(std::move(volume));
}

// Leaves with active and inactive values of all kinds, and tiles of 8^3, within kBox.
template <typename Grid>
Volume randomGrid(std::uint32_t seed, double scale, double background, double activeShare = 0.5) {
    openvdb::initialize();
    using T = typename Grid::ValueType;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto value = [&] { return T(std::floor(uniform(random) * 8) * scale); };
    auto grid = Grid::create(T(background));
    for (int x = -16; x < 8; x += 8) {
        for (int y = -8; y < 24; y += 8) {
            for (int z = -8; z < 16; z += 8) {
                const double kind = uniform(random);
                if (kind < 0.2) continue;
                if (kind < 0.4) {
                    grid->tree().addTile(1, Coord(x, y, z), value(), uniform(random) < 0.5);
                    continue;
                }
                for (int n = 0; n < 512; ++n) {
                    const Coord at(x + (n >> 6), y + (n >> 3 & 7), z + (n & 7));
                    if (uniform(random) < 0.3) continue;
                    if (kind < 0.5 || uniform(random) < activeShare) {
                        grid->tree().setValueOn(at, value());
                    } else {
                        grid->tree().setValueOff(at, value());
                    }
                }
            }
        }
    }
    return volumeOf<Grid>(grid);
}

struct Voxel {
    long double value = 0;
    bool active = false;
};

template <typename Tree>
Voxel probe(const Tree& tree, const Coord& at) {
    if constexpr (std::is_same_v<typename Tree::ValueType, openvdb::ValueMask>) {
        return {tree.isValueOn(at) ? 1.0L : 0.0L, tree.isValueOn(at)};
    } else {
        return {static_cast<long double>(tree.getValue(at)), tree.isValueOn(at)};
    }
}

Voxel voxelOf(const Volume& volume, const Coord& at) {
    if (!volume.source()) {
        const bool active = volume.codes()->tree().isValueOn(at);
        const Code code = volume.codes()->tree().getValue(at);
        return {active ? volume.codeBook().valueOf(code) : volume.background(), active};
    }
    Voxel voxel;
    volume.source()->grid.apply<ScalarTrees>([&](const auto& tree) { voxel = probe(tree, at); });
    return voxel;
}

// What compareVolumes is to find within kBox, from its definition.
VolumeComparison bruteForce(const Volume& a, const Volume& b, const CompareOptions& options) {
    VolumeComparison result;
    long double sum = 0;
    long double squares = 0;
    for (int z = kBox.min.z; z <= kBox.max.z; ++z) {
        for (int y = kBox.min.y; y <= kBox.max.y; ++y) {
            for (int x = kBox.min.x; x <= kBox.max.x; ++x) {
                const Voxel va = voxelOf(a, Coord(x, y, z));
                const Voxel vb = voxelOf(b, Coord(x, y, z));
                result.activeMismatch += va.active != vb.active;
                if (!va.active && !vb.active && va.value == a.background() &&
                    vb.value == b.background()) {
                    continue;
                }
                ++result.voxels;
                const long double error = std::fabs(va.value - vb.value);
                sum += error;
                squares += error * error;
                result.overFail += error > options.fail;
                result.overWarn += error > options.warn;
                if (double(error) > result.maxError) {
                    result.maxError = double(error);
                    result.maxAt = {x, y, z};
                    result.valueA = double(va.value);
                    result.valueB = double(vb.value);
                }
            }
        }
    }
    if (result.voxels == 0) return result;
    result.meanError = double(sum / result.voxels);
    result.rmsError = double(std::sqrt(squares / result.voxels));
    return result;
}

void expectAsBruteForce(const Volume& a, const Volume& b, double warn = 0, double fail = 0) {
    const CompareOptions options{fail, warn, 0};
    const VolumeComparison got = compareVolumes(a, b, options);
    const VolumeComparison expected = bruteForce(a, b, options);
    EXPECT_EQ(got.voxels, expected.voxels);
    EXPECT_EQ(got.activeMismatch, expected.activeMismatch);
    EXPECT_EQ(got.overFail, expected.overFail);
    EXPECT_EQ(got.overWarn, expected.overWarn);
    EXPECT_EQ(got.maxError, expected.maxError);
    EXPECT_EQ(got.maxAt, expected.maxAt);
    EXPECT_EQ(got.valueA, expected.valueA);
    EXPECT_EQ(got.valueB, expected.valueB);
    EXPECT_NEAR(got.meanError, expected.meanError, 1e-14 * expected.meanError);
    EXPECT_NEAR(got.rmsError, expected.rmsError, 1e-14 * expected.rmsError);
}

void expectNothing(const VolumeComparison& result) {
    EXPECT_TRUE(result.equal());
    EXPECT_EQ(result.meanError, 0);
    EXPECT_EQ(result.rmsError, 0);
    EXPECT_EQ(result.maxError, 0);
    EXPECT_EQ(result.maxAt, glm::ivec3(0));
    EXPECT_EQ(result.overFail, 0U);
    EXPECT_EQ(result.overWarn, 0U);
}

TEST(CompareVolumes, EveryPairOfTypesAsBruteForce) {
    Volume codes = test::randomVolume(kBox, 7);
    test::changed(codes)->hasBackground = true;
    test::changed(codes)->background = 0.5;
    const std::vector<Volume> volumes = {randomGrid<openvdb::FloatGrid>(1, 0.3, 0.25),
                                         randomGrid<openvdb::DoubleGrid>(2, 0.7, -3),
                                         randomGrid<openvdb::Int32Grid>(3, 2e8, 5),
                                         randomGrid<openvdb::Int64Grid>(4, 1e18, -7),
                                         randomGrid<openvdb::BoolGrid>(5, 0.2, 0),
                                         randomGrid<openvdb::MaskGrid>(6, 1, 0, 1),
                                         codes};
    for (const Volume& a : volumes) {
        for (const Volume& b : volumes) {
            SCOPED_TRACE(a.type() + " and " + b.type());
            expectAsBruteForce(a, b, 0.5, 1e8);
        }
    }
}

TEST(CompareVolumes, ManyTopologiesAsBruteForce) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        // Equal backgrounds and different ones; neighbouring seeds share nothing.
        const Volume a = randomGrid<openvdb::FloatGrid>(seed, 0.125, 0, 0.3);
        const Volume b = randomGrid<openvdb::FloatGrid>(seed + 100, 0.125, seed % 2 == 0 ? 0 : 1);
        expectAsBruteForce(a, b, 0.25, 0.5);
        const Volume self = randomGrid<openvdb::FloatGrid>(seed, 0.125, 0, 0.3);
        expectNothing(compareVolumes(a, self));
        EXPECT_EQ(compareVolumes(a, self).voxels, bruteForce(a, a, {}).voxels);
    }
}

TEST(CompareVolumes, CodesMeanTheirValues) {
    Volume codes = test::randomVolume(kBox, 3);
    test::changed(codes)->codeBook = CodeBook::linear(-2, 7, 8);
    Volume others = test::randomVolume(kBox, 4);
    std::vector<double> values(256);
    for (int i = 0; i < 256; ++i) values[std::size_t(i)] = std::sqrt(i) - 5;
    test::changed(others)->codeBook = CodeBook::ofTable(std::move(values));
    expectAsBruteForce(codes, others, 1, 3);
    test::changed(others)->hasBackground = true;
    test::changed(others)->background = 2.5;
    // The dense one takes the other's background where it has no voxels.
    test::changed(codes)->background = 2.5;
    expectAsBruteForce(codes, others, 1, 3);
    EXPECT_EQ(compareVolumes(codes, others).backgroundError, 0);
    EXPECT_EQ(compareVolumes(others, codes).backgroundError, 0);
}

TEST(CompareVolumes, TheSameForAnyNumberOfThreads) {
    // Several batches of work, with errors everywhere.
    const auto make = [](float step, int seed) {
        auto grid = openvdb::FloatGrid::create(0);
        std::mt19937 random(seed);
        std::uniform_int_distribution<int> place(-2000, 2000);
        std::uniform_real_distribution<float> value(0, 1);
        for (int i = 0; i < 3000; ++i) {
            const Coord at(place(random), place(random), place(random));
            for (int n = 0; n < 8; ++n) {
                grid->tree().setValue(at.offsetBy(n, n & 3, 2 * n), step + value(random));
            }
        }
        return volumeOf<openvdb::FloatGrid>(grid);
    };
    const Volume a = make(0, 11);
    const Volume b = make(0.25F, 11);
    VolumeComparison first;
    for (const int threads : {1, 2, 3, 7}) {
        const ThreadLimit limit(threads);
        const VolumeComparison result = compareVolumes(a, b);
        if (threads == 1) first = result;
        EXPECT_EQ(result.meanError, first.meanError);
        EXPECT_EQ(result.rmsError, first.rmsError);
        EXPECT_EQ(result.maxError, first.maxError);
        EXPECT_EQ(result.maxAt, first.maxAt);
        EXPECT_EQ(result.voxels, first.voxels);
    }
    EXPECT_GT(first.meanError, 0.1);
    EXPECT_EQ(first.voxels, a.source()->grid.tree->activeVoxelCount());
}

TEST(CompareVolumes, HugeTilesAreComparedAsTiles) {
    auto a = openvdb::FloatGrid::create(0);
    auto b = openvdb::FloatGrid::create(0);
    // 4096^3 against another value, 128^3 against nothing, 4096^3 against itself with one voxel
    // changed.
    a->tree().addTile(3, Coord(-4096, 0, 4096), 1.0F, true);
    b->tree().addTile(3, Coord(-4096, 0, 4096), 3.0F, true);
    a->tree().addTile(2, Coord(128, -256, 0), 2.0F, true);
    a->tree().addTile(3, Coord(8192, 0, 0), 0.5F, true);
    b->tree().addTile(3, Coord(8192, 0, 0), 0.5F, true);
    b->tree().setValueOn(Coord(8200, 7, 9), 2.5F);
    const VolumeComparison result =
        compareVolumes(volumeOf<openvdb::FloatGrid>(a), volumeOf<openvdb::FloatGrid>(b));
    const std::uint64_t large = std::uint64_t{1} << 36;
    const std::uint64_t small = std::uint64_t{1} << 21;
    EXPECT_EQ(result.voxels, 2 * large + small);
    EXPECT_EQ(result.overFail, large + small + 1);
    EXPECT_EQ(result.activeMismatch, small);
    EXPECT_EQ(result.maxError, 2);
    EXPECT_EQ(result.maxAt, glm::ivec3(128, -256, 0));
    EXPECT_DOUBLE_EQ(result.meanError, 2.0 * double(large + small + 1) / double(2 * large + small));
    EXPECT_DOUBLE_EQ(result.rmsError,
                     std::sqrt(4.0 * double(large + small + 1) / double(2 * large + small)));
}

TEST(CompareVolumes, TheFirstOfTheLargestErrorsIsNamed) {
    const Volume a = test::makeVolume(kBox, [](int, int, int) { return 5; });
    const auto withErrorsAt = [&](const std::vector<glm::ivec3>& places) {
        return test::makeVolume(kBox, [&](int x, int y, int z) {
            for (const glm::ivec3& at : places) {
                if (at == glm::ivec3(x, y, z)) return 9;
            }
            return x == 0 ? 6 : 5;
        });
    };
    const std::vector<glm::ivec3> inOrder = {{14, 27, -13}, {-21, -9, 1}, {-1, 0, 1}, {-20, -8, 2}};
    std::vector<glm::ivec3> places;
    for (int i = int(inOrder.size()) - 1; i >= 0; --i) {
        places.push_back(inOrder[std::size_t(i)]);
        const VolumeComparison result = compareVolumes(a, withErrorsAt(places));
        EXPECT_EQ(result.maxAt, inOrder[std::size_t(i)]);
        EXPECT_EQ(result.maxError, 4);
        EXPECT_EQ(result.valueA, 5);
        EXPECT_EQ(result.valueB, 9);
    }
}

TEST(CompareVolumes, LargeIntegersAreExact) {
    const auto one = [](std::int64_t value, std::int64_t background = 0) {
        auto grid = openvdb::Int64Grid::create(background);
        grid->tree().setValueOn(Coord(1, 2, 3), value);
        return volumeOf<openvdb::Int64Grid>(grid);
    };
    const auto errorOf = [&](std::int64_t a, std::int64_t b) {
        return compareVolumes(one(a), one(b)).maxError;
    };
    const std::int64_t large = std::int64_t{1} << 53;
    constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
    constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(errorOf(large, large + 1), 1);
    EXPECT_EQ(errorOf(-large - 1, -large), 1);
    EXPECT_EQ(errorOf(kMax, kMax - 1), 1);
    EXPECT_EQ(errorOf(kMin, kMin + 1), 1);
    EXPECT_EQ(errorOf(kMin, kMax), 0x1p64);
    EXPECT_EQ(errorOf(-1, 1), 2);
    EXPECT_EQ(errorOf(0xffffffffLL, 0x100000000LL), 1);
    EXPECT_EQ(errorOf(-0x100000000LL, -0xffffffffLL), 1);
    EXPECT_EQ(compareVolumes(one(0, large), one(0, large + 1)).backgroundError, 1);

    auto real = openvdb::DoubleGrid::create(0);
    real->tree().setValueOn(Coord(1, 2, 3), double(large));
    const Volume realVolume = volumeOf<openvdb::DoubleGrid>(real);
    EXPECT_EQ(compareVolumes(realVolume, one(large + 1)).maxError, 1);
    EXPECT_EQ(compareVolumes(realVolume, one(large)).maxError, 0);
    real->tree().setValueOn(Coord(1, 2, 3), -0.75);
    EXPECT_EQ(compareVolumes(realVolume, one(-1)).maxError, 0.25);
    EXPECT_EQ(compareVolumes(one(1), realVolume).maxError, 1.75);
}

// Two values are told apart by what is said of them, however near they are.
TEST(CompareVolumes, ValuesAreNamedExactly) {
    const auto one = [](std::int64_t value) {
        auto grid = openvdb::Int64Grid::create(0);
        grid->tree().setValueOn(Coord(1, 2, 3), value);
        return volumeOf<openvdb::Int64Grid>(grid);
    };
    const auto expectNamed = [](const Volume& a, const Volume& b, const char* textA,
                                const char* textB) {
        const VolumeComparison result = compareVolumes(a, b);
        EXPECT_EQ(result.valueTextA, textA);
        EXPECT_EQ(result.valueTextB, textB);
    };
    constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
    expectNamed(one(9007199254740993), one(9007199254740992), "9007199254740993",
                "9007199254740992");
    expectNamed(one(kMin + 1), one(-1), "-9223372036854775807", "-1");
    // Doubles that are next to each other there are named by all digits as well.
    expectNamed(one(4611692241834999808), one(4611692241835000000), "4611692241834999808",
                "4611692241835000000");
    expectNamed(one(kMin), one(100000), "-9223372036854775808", "1e+05");
    const auto real = [](double value) {
        auto grid = openvdb::DoubleGrid::create(0);
        grid->tree().setValueOn(Coord(1, 2, 3), value);
        return volumeOf<openvdb::DoubleGrid>(grid);
    };
    expectNamed(real(18446744073709555712.0), one(5), "18446744073709555712", "5");
    expectNamed(real(8589934592.75), one(5), "8589934592.75", "5");
    expectNamed(real(0.1), real(1e300), "0.1", "1e+300");
}

TEST(CompareVolumes, ValuesAtTheEndsOfTheRange) {
    const auto one = [](double value, double inactive = 0) {
        auto grid = openvdb::DoubleGrid::create(0);
        grid->tree().setValueOn(Coord(1, 2, 3), value);
        grid->tree().setValueOn(Coord(1, 2, 4), 0);
        if (inactive != 0) grid->tree().setValueOff(Coord(0, 0, 0), inactive);
        return volumeOf<openvdb::DoubleGrid>(grid);
    };
    constexpr double kLargest = std::numeric_limits<double>::max();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const VolumeComparison far = compareVolumes(one(kLargest), one(-kLargest));
    EXPECT_EQ(far.maxError, kLargest);
    EXPECT_DOUBLE_EQ(far.meanError, kLargest / 2);
    EXPECT_DOUBLE_EQ(far.rmsError, kLargest * std::sqrt(0.5));
    const double tiny = std::numeric_limits<double>::denorm_min();
    const VolumeComparison near = compareVolumes(one(4 * tiny), one(0));
    EXPECT_EQ(near.maxError, 4 * tiny);
    EXPECT_EQ(near.meanError, 2 * tiny);
    EXPECT_EQ(near.overFail, 1U);
    EXPECT_EQ(compareVolumes(one(0.0), one(-0.0)).maxError, 0);
    EXPECT_EQ(compareVolumes(one(1, kInfinity), one(1, kInfinity)).maxError, 0);
    EXPECT_EQ(compareVolumes(one(1, std::nan("")), one(1, std::nan(""))).maxError, 0);
    EXPECT_EQ(compareVolumes(one(1, std::nan("")), one(1, 2)).maxError, kLargest);
    EXPECT_EQ(compareVolumes(one(1, kInfinity), one(1, -kInfinity)).maxError, kLargest);
}

TEST(CompareVolumes, DenseAgainstSparse) {
    // Air (0) is inactive in the sparse one.
    const auto code = [](int x, int y, int) { return x * y % 5 == 0 ? 0 : 100 + x + y; };
    const Volume dense = test::makeVolume(kBox, code);
    Volume sparse = test::makeVolume(kBox, [&](int x, int y, int z) {
        const int value = code(x, y, z);
        return value == 0 ? test::kInactive : value;
    });
    test::changed(sparse)->hasBackground = true;
    const VolumeComparison result = compareVolumes(dense, sparse);
    EXPECT_EQ(result.maxError, 0);
    EXPECT_EQ(result.activeMismatch, dense.activeCount() - sparse.activeCount());
    EXPECT_EQ(result.voxels, dense.activeCount());
    EXPECT_TRUE(result.sizeEqual);
    EXPECT_FALSE(result.equal());
}

TEST(CompareVolumes, DenseVolumesOfOtherSizes) {
    const auto code = [](int, int, int) { return 3; };
    const IndexBox small{kBox.min, glm::ivec3(kBox.max.x - 1, kBox.max.y, kBox.max.z)};
    const VolumeComparison result =
        compareVolumes(test::makeVolume(kBox, code), test::makeVolume(small, code));
    EXPECT_FALSE(result.sizeEqual);
    EXPECT_FALSE(result.equal());
    EXPECT_EQ(result.activeMismatch, std::uint64_t(kBox.voxels() - small.voxels()));
    EXPECT_EQ(result.overFail, result.activeMismatch);
    EXPECT_EQ(result.maxError, 3);
    EXPECT_EQ(result.maxAt, glm::ivec3(kBox.max.x, kBox.min.y, kBox.min.z));
}

TEST(CompareVolumes, BackgroundsAreComparedOnce) {
    const Volume a = volumeOf<openvdb::FloatGrid>(openvdb::FloatGrid::create(1.5F));
    const Volume b = volumeOf<openvdb::FloatGrid>(openvdb::FloatGrid::create(-1));
    const VolumeComparison result = compareVolumes(a, b);
    EXPECT_EQ(result.backgroundError, 2.5);
    EXPECT_EQ(result.voxels, 0U);
    EXPECT_EQ(result.maxError, 0);
    EXPECT_FALSE(result.equal());
}

TEST(CompareVolumes, NamesOfTypesAndClassesAreNoDifference) {
    const Volume a = test::randomVolume(kBox, 1);
    Volume b = a;
    test::changed(b)->name = "other";
    test::changed(b)->type = "float";
    test::changed(b)->gridClass = "level set";
    const VolumeComparison result = compareVolumes(a, b);
    EXPECT_FALSE(result.nameEqual);
    EXPECT_FALSE(result.typeEqual);
    EXPECT_FALSE(result.classEqual);
    expectNothing(result);
}

TEST(CompareVolumes, ShiftIsInVoxels) {
    const auto code = [](int, int, int) { return 3; };
    const IndexBox box{glm::ivec3(0), glm::ivec3(10, 20, 30)};
    const Volume a = test::makeVolume(box, code, glm::dvec3(2, 4, 3));
    Volume b = a;
    test::changed(b)->worldFromIndex[3][1] = 1;
    EXPECT_DOUBLE_EQ(compareVolumes(a, b).shift, 0.5);
    EXPECT_FALSE(compareVolumes(a, b).transformEqual);
    EXPECT_TRUE(compareVolumes(a, b, {0, 0, 0.5}).transformEqual);

    // Another spacing along z moves the voxels of z = 30 by 30 times its difference.
    b = a;
    test::changed(b)->worldFromIndex[2][2] = 3 + 1e-9;
    EXPECT_NEAR(compareVolumes(a, b).shift, 30e-9 / 2, 1e-14);
    EXPECT_TRUE(compareVolumes(a, b).transformEqual);
    EXPECT_TRUE(compareVolumes(a, b).equal());
    test::changed(b)->worldFromIndex[2][2] = 3 + 1e-6;
    EXPECT_FALSE(compareVolumes(a, b).transformEqual);
    EXPECT_EQ(compareVolumes(a, a).shift, 0);
}

// A volume with a source of its own, at the same place in the world, but `offset` further on.
Volume elsewhere(const Volume& volume, const Coord& offset) {
    Volume result = volume;
    volume.source()->grid.apply<ScalarTrees>([&](const auto& tree) {
        const auto moved = std::make_shared<std::decay_t<decltype(tree)>>(tree.background());
        for (auto voxel = openvdb::CoordBBox(-21, -9, -13, 14, 27, 22).begin(); voxel; ++voxel) {
            moved->setValueOn(*voxel + offset, tree.getValue(*voxel));
            moved->setActiveState(*voxel + offset, tree.isValueOn(*voxel));
        }
        test::changed(result)->source = std::make_shared<SourceGrid>(SourceGrid{{moved, {}}});
    });
    const glm::ivec3 way(offset.x(), offset.y(), offset.z());
    test::changed(result)->box = {volume.box().min + way, volume.box().max + way};
    test::changed(result)->worldFromIndex =
        glm::translate(volume.worldFromIndex(), -glm::dvec3(way));
    return result;
}

TEST(CompareVolumes, WholeVoxelsApartTheSamePlacesAreCompared) {
    Volume codes = test::randomVolume(kBox, 7);
    test::changed(codes)->hasBackground = true;
    test::changed(codes)->background = 0.5;
    // Of a mask, only states matter; of its tiles' values, those that agree with them.
    const auto mask = openvdb::MaskGrid::create();
    mask->fill(openvdb::CoordBBox(-16, -8, -8, 3, 23, 15), true);
    const std::vector<Volume> volumes = {
        randomGrid<openvdb::FloatGrid>(1, 0.3, 0.25), randomGrid<openvdb::Int64Grid>(4, 1e18, -7),
        randomGrid<openvdb::BoolGrid>(5, 0.2, 0), volumeOf<openvdb::MaskGrid>(mask), codes};
    for (const Volume& a : volumes) {
        if (!a.source()) continue;
        for (const Volume& b : volumes) {
            SCOPED_TRACE(a.type() + " and " + b.type());
            const VolumeComparison expected = compareVolumes(a, b);
            const VolumeComparison got = compareVolumes(elsewhere(a, {5, -8, 11}), b);
            EXPECT_EQ(got.offset, glm::ivec3(5, -8, 11));
            EXPECT_TRUE(got.transformEqual);
            EXPECT_NEAR(got.shift, 0, 1e-12);
            EXPECT_EQ(got.voxels, expected.voxels);
            EXPECT_EQ(got.activeMismatch, expected.activeMismatch);
            EXPECT_EQ(got.overFail, expected.overFail);
            EXPECT_EQ(got.maxError, expected.maxError);
            EXPECT_NEAR(got.meanError, expected.meanError, 1e-14 * expected.meanError);
        }
    }
}

TEST(CompareVolumes, OffsetsThatAreNotWholeAreADifference) {
    const Volume a = randomGrid<openvdb::FloatGrid>(1, 0.3, 0.25);
    Volume b = elsewhere(a, {1, 0, 0});
    expectNothing(compareVolumes(a, b));
    EXPECT_EQ(compareVolumes(a, b).offset, glm::ivec3(-1, 0, 0));
    test::changed(b)->worldFromIndex[3].x += 1e-5;
    EXPECT_FALSE(compareVolumes(a, b).transformEqual);
    // Voxels are compared with those nearest to them all the same.
    EXPECT_EQ(compareVolumes(a, b).offset, glm::ivec3(-1, 0, 0));
    EXPECT_EQ(compareVolumes(a, b).maxError, 0);
    EXPECT_NEAR(compareVolumes(a, b).shift, 1e-5, 1e-12);
    test::changed(b)->worldFromIndex[3].x += 0.49;
    EXPECT_EQ(compareVolumes(a, b).offset, glm::ivec3(-1, 0, 0));
    test::changed(b)->worldFromIndex[3].x -= 0.49;
    EXPECT_TRUE(compareVolumes(a, b, {0, 0, 1e-4}).transformEqual);
    EXPECT_EQ(compareVolumes(a, b, {0, 0, 1e-4}).offset, glm::ivec3(-1, 0, 0));
}

// A sparse volume somewhere, and a dense one of the same voxels from index 0 on.
std::pair<Volume, Volume> sparseAndDense(const glm::dmat4& worldFromIndex) {
    const glm::ivec3 min(100, -40, 7);
    const auto code = [](int x, int y, int z) { return 10 + (x * 7 + y * 3 + z * 11) % 200; };
    const glm::ivec3 size(12, 9, 10);
    Volume sparse = test::makeVolume({min, min + size - 1}, code);
    test::changed(sparse)->hasBackground = true;
    test::changed(sparse)->worldFromIndex = worldFromIndex;
    Volume dense = test::makeVolume({glm::ivec3(0), size - 1}, [&](int x, int y, int z) {
        return code(x + min.x, y + min.y, z + min.z);
    });
    test::changed(dense)->worldFromIndex = glm::translate(worldFromIndex, glm::dvec3(min));
    return {sparse, dense};
}

glm::dmat4 asFloats(const glm::dmat4& matrix) {
    return glm::dmat4(glm::mat4(matrix));
}

CompareOptions withFloatsInB() {
    CompareOptions options;
    options.placeDigitsB = 24;
    return options;
}

// A turned grid of voxels a tenth of a unit wide, far from the world's origin.
glm::dmat4 oddPlace(double distance) {
    glm::dmat4 place = glm::rotate(glm::dmat4(0.1), 0.3, glm::dvec3(1, 2, 3));
    place[3] = glm::dvec4(distance / 3, -distance / 7, distance, 1);
    return place;
}

// A format of 32-bit floats cannot say the place of a .vdb better than it does.
TEST(CompareVolumes, PlacesAreEqualAsFarAsBothFormatsTell) {
    auto [sparse, dense] = sparseAndDense(oddPlace(1000));
    test::changed(dense)->worldFromIndex = asFloats(dense.worldFromIndex());
    for (const bool turned : {false, true}) {
        CompareOptions options = withFloatsInB();
        if (turned) std::swap(options.placeDigitsA, options.placeDigitsB);
        const VolumeComparison result = turned ? compareVolumes(dense, sparse, options)
                                               : compareVolumes(sparse, dense, options);
        EXPECT_EQ(result.offset, glm::ivec3(100, -40, 7) * (turned ? -1 : 1));
        EXPECT_GT(result.shift, 1e-5);
        EXPECT_TRUE(result.transformEqual);
        EXPECT_TRUE(result.equal());
        EXPECT_EQ(result.voxels, 12u * 9 * 10);
    }
    // Doubles would have told the place.
    EXPECT_FALSE(compareVolumes(sparse, dense).transformEqual);
    EXPECT_EQ(compareVolumes(sparse, dense).maxError, 0);
    // So would floats, a little farther away.
    for (int number = 0; number < 3; ++number) {
        Volume moved = dense;
        double place = moved.worldFromIndex()[3][number];
        place = double(std::nextafter(float(place), 1e9F));
        place = double(std::nextafter(float(place), 1e9F));
        test::changed(moved)->worldFromIndex[3][number] = place;
        EXPECT_FALSE(compareVolumes(sparse, moved, withFloatsInB()).transformEqual) << number;
    }
}

// Far away floats are voxels apart: what is where is said by the boxes then.
TEST(CompareVolumes, PlacesCoarserThanVoxels) {
    auto [sparse, dense] = sparseAndDense(oddPlace(1e8));
    test::changed(dense)->worldFromIndex = asFloats(dense.worldFromIndex());
    const VolumeComparison result = compareVolumes(sparse, dense, withFloatsInB());
    EXPECT_GT(result.shift, 0.5);
    EXPECT_EQ(result.offset, glm::ivec3(100, -40, 7));
    EXPECT_TRUE(result.equal());
}

// Bits of unsigned integers that no int64 and no double holds.
TEST(CompareVolumes, UnsignedIntegersAreExact) {
    const auto one = [](std::uint64_t value) {
        auto grid = openvdb::Int64Grid::create(0);
        grid->tree().setValueOn(Coord(1, 2, 3), std::int64_t(value));
        Volume volume = volumeOf<openvdb::Int64Grid>(grid);
        test::changed(volume)->type = "uint64";
        return volume;
    };
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;
    for (const std::uint64_t value :
         {std::uint64_t{1} << 53, kHalf - 1, kHalf, kHalf + 4, kMost - 1}) {
        const VolumeComparison result = compareVolumes(one(value), one(value + 1));
        EXPECT_EQ(result.maxError, 1);
        EXPECT_EQ(result.valueTextA, std::to_string(value));
        EXPECT_EQ(result.valueTextB, std::to_string(value + 1));
        EXPECT_TRUE(compareVolumes(one(value), one(value)).equal());
    }
    EXPECT_EQ(compareVolumes(one(0), one(kMost)).maxError, 0x1p64);
    auto real = openvdb::DoubleGrid::create(0);
    real->tree().setValueOn(Coord(1, 2, 3), 0x1p63);
    EXPECT_EQ(compareVolumes(volumeOf<openvdb::DoubleGrid>(real), one(kHalf + 5)).maxError, 5);
}

TEST(CompareVolumes, DenseVolumesThatOverlapInPart) {
    const auto code = [](int, int, int) { return 3; };
    const Volume a = test::makeVolume({glm::ivec3(0), glm::ivec3(9)}, code);
    Volume b = a;
    test::changed(b)->worldFromIndex[3].x = 4;
    const VolumeComparison result = compareVolumes(a, b);
    EXPECT_EQ(result.offset, glm::ivec3(4, 0, 0));
    EXPECT_TRUE(result.transformEqual);
    EXPECT_FALSE(result.sizeEqual);
    EXPECT_EQ(result.activeMismatch, 800U);
}

TEST(CompareVolumes, PatientSpacesAreComparedInOne) {
    const auto code = [](int, int, int) { return 3; };
    Volume a = test::makeVolume(kBox, code, glm::dvec3(2, 4, 3));
    test::changed(a)->worldFromIndex[3] = {10, 20, 30, 1};
    Volume b = a;
    test::changed(b)->worldFromIndex =
        glm::dmat4({-2, 0, 0, 0}, {0, -4, 0, 0}, {0, 0, 3, 0}, {-10, -20, 30, 1});
    test::changed(a)->space = "RAS";
    test::changed(b)->space = "LPS";
    EXPECT_EQ(compareVolumes(a, b).shift, 0);
    EXPECT_EQ(compareVolumes(b, a).shift, 0);
    test::changed(b)->space = "RAS";
    EXPECT_GT(compareVolumes(a, b).shift, 1);
    test::changed(b)->space = "";
    EXPECT_GT(compareVolumes(a, b).shift, 1);
}

TEST(CompareVolumes, ListenerStopsTheWork) {
    Listener listener;
    listener.progress = [](double) { throw Error(ErrorCode::kInterrupted, "stop"); };
    const Volume a = test::randomVolume(kBox, 1);
    EXPECT_THROW(compareVolumes(a, a, {}, listener), Error);
}

}  // namespace
}  // namespace deltasplat
