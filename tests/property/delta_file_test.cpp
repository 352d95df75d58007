// SPDX-License-Identifier: Apache-2.0
// What goes into a delta grid comes out of it: read by the library and, by the format's description
// alone, by a reader that shares no code with it.
#include "deltasplat/delta/delta_file.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/exact_deltas.h"
#include "formats/vdb/grid_metadata.h"
#include "reference/plain_delta_reader.h"
#include "support/kept_grid.h"
#include "support/same_volume.h"
#include "unit/ingest_helpers.h"
#include "volume/code_tree.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using test::expectSameVolume;
using testing::keptGrid;
using testing::PlainVolume;
using testing::TempFolder;

// What a value type's random values are.
enum class Kind { kHalf, kFewFloats, kManyFloats, kSmallInts, kWideInts, kBool, kAny };

// Any finite pattern of bits, those at the ends of the type among them.
template <typename T>
T anyValue(std::mt19937& random) {
    using Limits = std::numeric_limits<T>;
    constexpr bool kIsDouble = std::is_same_v<T, double>;
    constexpr T kLargest = kIsDouble ? Limits::max() / 4 : Limits::max();
    constexpr T kSmallest = kIsDouble ? Limits::lowest() / 4 : Limits::lowest();
    constexpr T kEnds[] = {kLargest, kSmallest, Limits::denorm_min(), T(-0.0), T(0)};
    if (random() % 50 == 0) return kEnds[random() % 5];
    if constexpr (std::is_floating_point_v<T>) {
        using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
        const T value = std::bit_cast<T>(Bits(std::uint64_t{random()} << 32 | random()));
        // As far apart as a double can say.
        return std::isfinite(value) && std::fabs(value) <= kLargest ? value : T(1);
    } else {
        return T(std::int32_t(random()));
    }
}

template <typename T>
T randomValue(std::mt19937& random, Kind kind) {
    switch (kind) {
        case Kind::kHalf:
            return T(float(openvdb::math::half(float(int(random() % 4001) - 2000) / 512)));
        case Kind::kFewFloats:
            return T(std::sin(double(random() % 3000)));
        case Kind::kManyFloats:
            return T(double(random()) / 4294967295.0 - 0.25);
        case Kind::kSmallInts:
            return T(int(random() % 60000) - 20000);
        case Kind::kWideInts:
            return T(int(random() % 5000) * 400000 - 1000000000);
        case Kind::kAny:
            return anyValue<T>(random);
        case Kind::kBool:
            break;
    }
    return T(random() % 2);
}

Coord randomCoord(std::mt19937& random, const Coord& low, const Coord& size) {
    const auto below = [&](int n) { return int(random() % unsigned(n)); };
    return low + Coord(below(size.x()), below(size.y()), below(size.z()));
}

// Boxes, single voxels and tiles, active and inactive, with values of their own, anywhere.
template <typename Grid>
typename Grid::Ptr randomGrid(std::mt19937& random, Kind kind) {
    using T = typename Grid::ValueType;
    const auto value = [&] { return randomValue<T>(random, kind); };
    const Coord size(1 + int(random() % 70), 1 + int(random() % 70), 1 + int(random() % 70));
    const Coord low(int(random() % 300) - 200, int(random() % 300) - 200,
                    int(random() % 300) - 200);
    auto grid = Grid::create(random() % 2 ? T(0) : value());
    auto& tree = grid->tree();
    for (int i = 0; i < 6; ++i) {
        const Coord a = randomCoord(random, low, size), b = randomCoord(random, low, size);
        tree.fill({Coord::minComponent(a, b), Coord::maxComponent(a, b)}, value(),
                  random() % 4 != 0);
    }
    for (int i = 0; i < 3000; ++i) {
        const Coord at = randomCoord(random, low, size);
        if (random() % 5 != 0) {
            tree.setValueOn(at, value());
        } else {
            tree.setValueOff(at, value());
        }
    }
    if constexpr (std::is_floating_point_v<T>) {
        constexpr T kOdd[] = {std::numeric_limits<T>::quiet_NaN(),
                              -std::numeric_limits<T>::quiet_NaN(),
                              std::numeric_limits<T>::infinity()};
        for (int i = 0; i < int(random() % 40); ++i)
            tree.setValueOff(randomCoord(random, low, size), kOdd[random() % 3]);
    }
    tree.addTile(1, randomCoord(random, low, size), value(), true);
    tree.addTile(1, randomCoord(random, low, size), value(), false);
    if (random() % 3 == 0) tree.addTile(2, low, value(), false);
    // More different values than a code book holds.
    for (int i = 0; kind == Kind::kAny && i < 90000; ++i) {
        const Coord at = low + Coord(i % 45, i / 45 % 45, i / 2025);
        if (random() % 16 != 0) tree.setValueOn(at, value());
    }
    return grid;
}

void dress(openvdb::GridBase& grid, std::mt19937& random) {
    const openvdb::GridClass classes[] = {openvdb::GRID_UNKNOWN, openvdb::GRID_FOG_VOLUME,
                                          openvdb::GRID_LEVEL_SET, openvdb::GRID_STAGGERED};
    grid.setName("density");
    grid.setGridClass(classes[random() % 4]);
    grid.setCreator("a test");
    grid.insertMeta("weight", openvdb::DoubleMetadata(0.1));
    grid.insertMeta("frame", openvdb::Int32Metadata(-7));
    grid.insertMeta("place", openvdb::Vec3DMetadata({1, 2, 1e-300}));
    using namespace openvdb::math;
    const Mat4d matrix(0.1, 0.02, 0., 0., -0.03, 0.2, 0.01, 0., 0.3, 0., -0.7, 0., 1., 2., 3., 1.);
    const MapBase::Ptr maps[] = {
        std::make_shared<UniformScaleMap>(0.1),
        std::make_shared<ScaleMap>(Vec3d(0.1, 0.7, 1.3)),
        std::make_shared<TranslationMap>(Vec3d(1, -2, 0.1)),
        std::make_shared<UniformScaleTranslateMap>(0.3, Vec3d(0.1, 0, 0)),
        std::make_shared<ScaleTranslateMap>(Vec3d(1, 2, 0.3), Vec3d(0.1, 5, -6)),
        std::make_shared<AffineMap>(matrix)};
    grid.setTransform(std::make_shared<Transform>(maps[random() % 6]));
}

std::uint64_t bits(double value) {
    return std::bit_cast<std::uint64_t>(value);
}

// Returns a box that holds all of a grid that is not background, and a rim.
openvdb::CoordBBox reachOf(const openvdb::GridBase& grid) {
    openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    return box.empty() ? openvdb::CoordBBox(Coord(-8), Coord(8))
                       : openvdb::CoordBBox(box.min() - Coord(9), box.max() + Coord(9));
}

template <typename Grid>
void expectSameVoxels(const Grid& expected, const Grid& grid) {
    EXPECT_EQ(grid.activeVoxelCount(), expected.activeVoxelCount());
    std::uint64_t wrong = 0;
    for (auto at = reachOf(expected).begin(); at; ++at) {
        typename Grid::ValueType p{}, q{};
        const bool on = expected.tree().probeValue(*at, p);
        const bool restoredOn = grid.tree().probeValue(*at, q);
        // Two int64 may be one double, two NaN are never equal.
        const bool same = p == q || (p != p && q != q);
        wrong += on == restoredOn && same && bits(double(p)) == bits(double(q)) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0u);
}

// Metadata but what OpenVDB notes anew when it writes a file.
openvdb::MetaMap ownMetadata(const openvdb::MetaMap& metadata) {
    openvdb::MetaMap own(metadata);
    for (const char* const key : fileMetadata()) own.removeMeta(key);
    return own;
}

template <typename Grid>
void expectEqual(const Grid& expected, const Volume& restored, const PlainVolume& plain) {
    ASSERT_TRUE(restored.source());
    const auto kept = keptGrid<Grid>(restored);
    ASSERT_TRUE(kept);
    const Grid& grid = *kept;
    EXPECT_EQ(bits(double(grid.background())), bits(double(expected.background())));
    EXPECT_EQ(bits(plain.background), bits(double(expected.background())));
    EXPECT_EQ(grid.transform(), expected.transform());
    EXPECT_EQ(grid.transform().mapType(), expected.transform().mapType());
    EXPECT_EQ(plain.worldFromIndex, expected.transform().baseMap()->getAffineMap()->getMat4());
    EXPECT_TRUE(ownMetadata(grid) == ownMetadata(expected));
    EXPECT_TRUE(ownMetadata(plain.metadata) == ownMetadata(expected));
    EXPECT_EQ(grid.getGridClass(), expected.getGridClass());
    EXPECT_EQ(grid.saveFloatAsHalf(), expected.saveFloatAsHalf());
    EXPECT_EQ(grid.activeVoxelCount(), expected.activeVoxelCount());

    auto a = expected.getConstAccessor();
    auto b = grid.getConstAccessor();
    std::uint64_t wrong = 0;
    for (auto at = reachOf(expected).begin(); at; ++at) {
        typename Grid::ValueType p{}, q{};
        const bool on = a.probeValue(*at, p);
        const bool restoredOn = b.probeValue(*at, q);
        const bool same = on == restoredOn && bits(double(p)) == bits(double(q)) &&
                          on == plain.activeAt(*at) && bits(double(p)) == bits(plain.valueAt(*at));
        wrong += same ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0u);
}

Volume readKept(const std::string& file, ReadOptions reading = {}) {
    reading.keepSource = true;
    return readVolume(file, reading);
}

DeltaFileOptions codesOnly() {
    DeltaFileOptions options;
    options.codesOnly = true;
    return options;
}

// Makes a delta grid of source.vdb in either form, and reads it back.
template <typename Grid>
DeltaFileEntry expectComesBack(const Grid& source, DeltaFileOptions options, bool pack) {
    SCOPED_TRACE(pack ? "packed" : "voxels");
    ReadOptions reading;
    reading.keepSource = true;
    reading.levelSetToFog = false;
    options.pack = pack;
    DeltaFile file;
    const DeltaFileEntry entry = file.add(readVolume("source.vdb", reading), options);
    file.write("delta.vdb");
    EXPECT_EQ(entry.maxError, 0);
    EXPECT_TRUE(entry.lossless);
    const Volume restored = readVolume("delta.vdb", reading);
    EXPECT_EQ(restored.origin()->deltas, entry.deltas);
    expectEqual(source, restored, testing::readPlainDeltas("delta.vdb", "density"));
    return entry;
}

// Writes a grid as OpenVDB does, makes delta grids of it, and reads those back.
template <typename Grid>
void expectRoundTrip(unsigned seed, Kind kind, const std::string& codeBook = "") {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TempFolder folder;
    openvdb::initialize();
    std::mt19937 random(seed);
    auto grid = randomGrid<Grid>(random, kind);
    if (kind == Kind::kHalf) grid->setSaveFloatAsHalf(true);
    dress(*grid, random);
    openvdb::io::File("source.vdb").write({grid});
    openvdb::io::File input("source.vdb");
    input.open();
    const auto source = openvdb::gridPtrCast<Grid>(input.readGrid("density"));

    DeltaFileOptions options;
    if (seed % 4 != 3) options.sliceAxis = int(seed % 4);
    options.keyInterval = int(8 * (seed % 5));
    for (const bool pack : {false, true}) {
        const DeltaFileEntry entry = expectComesBack(*source, options, pack);
        if (!codeBook.empty()) {
            EXPECT_EQ(entry.codeBook, codeBook);
        }
    }
}

TEST(DeltaFile, HalfGridsComeBack) {
    for (unsigned seed = 1; seed <= 12; ++seed)
        expectRoundTrip<openvdb::FloatGrid>(seed, Kind::kHalf);
}

TEST(DeltaFile, FloatGridsOfFewValuesComeBack) {
    for (unsigned seed = 21; seed <= 28; ++seed)
        expectRoundTrip<openvdb::FloatGrid>(seed, Kind::kFewFloats);
}

TEST(DeltaFile, DoubleGridsComeBack) {
    for (unsigned seed = 31; seed <= 34; ++seed)
        expectRoundTrip<openvdb::DoubleGrid>(seed, Kind::kManyFloats);
}

TEST(DeltaFile, IntegerGridsComeBack) {
    for (unsigned seed = 41; seed <= 44; ++seed) {
        expectRoundTrip<openvdb::Int32Grid>(seed, Kind::kSmallInts);
        expectRoundTrip<openvdb::Int64Grid>(seed, Kind::kWideInts);
    }
}

// Voxels of a mask are true where they are active; its tiles have values.
TEST(DeltaFile, MaskGridsComeBack) {
    openvdb::initialize();
    for (unsigned seed = 51; seed <= 54; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const TempFolder folder;
        std::mt19937 random(seed);
        const auto grid = openvdb::MaskGrid::create();
        const Coord low(-30, 7, -100), size(150, 60, 40);
        for (int i = 0; i < 5; ++i) {
            const Coord a = randomCoord(random, low, size), b = randomCoord(random, low, size);
            grid->tree().fill({Coord::minComponent(a, b), Coord::maxComponent(a, b)}, true, i != 3);
        }
        grid->tree().addTile(1, low + Coord(400, 0, 0), true, true);
        grid->tree().addTile(1, low + Coord(440, 0, 0), false, true);
        grid->tree().addTile(2, low + Coord(600, 0, 0), true, true);
        dress(*grid, random);
        openvdb::io::File("source.vdb").write({grid});
        DeltaFileOptions options;
        options.sliceAxis = int(seed % 3);
        for (const bool pack : {false, true}) expectComesBack(*grid, options, pack);
    }
}

TEST(DeltaFile, FloatGridsOfAnyValuesComeBack) {
    for (unsigned seed = 61; seed <= 68; ++seed)
        expectRoundTrip<openvdb::FloatGrid>(seed, Kind::kAny, "float32");
}

TEST(DeltaFile, DoubleGridsOfAnyValuesComeBack) {
    for (unsigned seed = 71; seed <= 76; ++seed)
        expectRoundTrip<openvdb::DoubleGrid>(seed, Kind::kAny, "float64");
}

TEST(DeltaFile, IntegerGridsOfAnyValuesComeBack) {
    for (unsigned seed = 81; seed <= 84; ++seed)
        expectRoundTrip<openvdb::Int32Grid>(seed, Kind::kAny, "int32");
}

// Values that no double holds, up to the largest that has a slot.
TEST(DeltaFile, WideIntegersComeBackAsFarAsThereAreSlots) {
    const TempFolder folder;
    openvdb::initialize();
    std::mt19937_64 random(7);
    auto grid = openvdb::Int64Grid::create(-3);
    grid->setName("labels");
    constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max() - 65537;
    for (int i = 0; i < 70000; ++i) {
        const Coord at(i % 41, i / 41 % 41, i / 1681);
        grid->tree().setValueOn(at, std::min(std::int64_t(random()), kLargest));
    }
    grid->tree().setValueOn(Coord(0, 0, 0), kLargest);
    grid->tree().setValueOn(Coord(1, 0, 0), std::numeric_limits<std::int64_t>::min());
    grid->tree().setValueOff(Coord(2, 0, 0), 12);
    openvdb::io::File("source.vdb").write({grid});
    ReadOptions reading;
    reading.keepSource = true;
    for (const bool pack : {false, true}) {
        DeltaFileOptions options;
        options.pack = pack;
        DeltaFile file;
        const DeltaFileEntry entry = file.add(readVolume("source.vdb", reading), options);
        EXPECT_EQ(entry.codeBook, "int64");
        EXPECT_TRUE(entry.lossless);
        file.write("delta.vdb");
        const Volume restored = readVolume("delta.vdb", reading);
        expectSameVoxels(*grid, *keptGrid<openvdb::Int64Grid>(restored));
    }

    grid->tree().setValueOn(Coord(3, 0, 0), kLargest + 1);
    openvdb::io::File("source.vdb").write({grid});
    const DeltaFileEntry rounded = DeltaFile().add(readVolume("source.vdb", reading), {});
    EXPECT_EQ(rounded.codeBook, "pieces");
    EXPECT_FALSE(rounded.lossless);
}

// Blocks that OpenVDB's prune would take for uniform.
TEST(DeltaFile, BlocksOfNearlyOneValueComeBack) {
    const TempFolder folder;
    openvdb::initialize();
    auto floats = openvdb::FloatGrid::create(0.0f);
    auto ints = openvdb::Int32Grid::create(0);
    floats->setName("floats");
    ints->setName("ints");
    for (int i = 0; i < 512; ++i) {
        const Coord at(i / 64, i / 8 % 8, i % 8);
        floats->tree().setValueOn(at, i % 3 == 0 ? -0.0f : 0.0f);
        floats->tree().setValueOff(at + Coord(8), i == 5 ? NAN : 2.0f);
        ints->tree().setValueOn(at, i % 2 == 0 ? 2000000000 : -2000000000);
    }
    openvdb::io::File("source.vdb").write({floats, ints});
    openvdb::io::File input("source.vdb");
    input.open();
    floats = openvdb::gridPtrCast<openvdb::FloatGrid>(input.readGrid("floats"));
    ints = openvdb::gridPtrCast<openvdb::Int32Grid>(input.readGrid("ints"));
    for (const bool pack : {false, true}) {
        SCOPED_TRACE(pack ? "packed" : "voxels");
        DeltaFileOptions options;
        options.pack = pack;
        DeltaFile file;
        for (const char* name : {"floats", "ints"}) {
            ReadOptions reading;
            reading.gridName = name;
            EXPECT_TRUE(file.add(readKept("source.vdb", reading), options).lossless);
        }
        file.write("delta.vdb");
        ReadOptions reading;
        reading.gridName = "floats";
        const Volume restored = readKept("delta.vdb", reading);
        expectSameVoxels(*floats, *keptGrid<openvdb::FloatGrid>(restored));
        reading.gridName = "ints";
        const Volume others = readKept("delta.vdb", reading);
        expectSameVoxels(*ints, *keptGrid<openvdb::Int32Grid>(others));
    }
}

TEST(DeltaFile, BoolGridsComeBack) {
    for (unsigned seed = 51; seed <= 55; ++seed)
        expectRoundTrip<openvdb::BoolGrid>(seed, Kind::kBool);
}

// A dense volume of noise on slow waves, as a scanner makes it.
constexpr glm::ivec3 kWaves(95, 41, 50);

std::vector<float> waves(std::mt19937& random, double noise) {
    std::vector<float> values;
    for (int z = 0; z < kWaves.z; ++z) {
        for (int y = 0; y < kWaves.y; ++y) {
            for (int x = 0; x < kWaves.x; ++x) {
                const double wave = std::sin(x * 0.1) * std::cos(y * 0.07 + z * 0.02);
                const double grain = noise * (double(random()) / 4294967295.0 - 0.5);
                values.push_back(wave < 0 ? 0 : float(wave * 300 + grain));
            }
        }
    }
    return values;
}

constexpr const char* kWavesFile = "waves_95x41x50_float32.raw";

ReadOptions inBits(int bits) {
    ReadOptions reading;
    reading.bits = bits;
    return reading;
}

// The largest error of a voxel by the plain reader, and whether all that is 0 stayed 0.
double largestError(const std::vector<float>& values, const PlainVolume& plain) {
    double largest = 0;
    std::size_t i = 0;
    for (int z = 0; z < kWaves.z; ++z) {
        for (int y = 0; y < kWaves.y; ++y) {
            for (int x = 0; x < kWaves.x; ++x, ++i) {
                const float restored = float(plain.valueAt(Coord(x, y, z)));
                largest = std::max(largest, std::fabs(double(restored) - double(values[i])));
                EXPECT_TRUE(plain.activeAt(Coord(x, y, z)));
            }
        }
    }
    return largest;
}

TEST(DeltaFile, LinearBooksKeepToHalfAStepAndSayTheLargestError) {
    std::mt19937 random(5);
    std::vector<float> values = waves(random, 40);
    for (const int bits : {8, 11, 16}) {
        SCOPED_TRACE(bits);
        const TempFolder folder;
        testing::writeBytes(kWavesFile, testing::bytesOf(values));
        const Volume volume = readKept(kWavesFile, inBits(bits));
        DeltaFileOptions options = codesOnly();
        options.pack = bits == 11;
        DeltaFile file;
        const DeltaFileEntry entry = file.add(volume, options);
        file.write("delta.vdb");
        const double found =
            largestError(values, testing::readPlainDeltas("delta.vdb", "waves_95x41x50_float32"));
        EXPECT_GT(entry.maxError, 0);
        EXPECT_FALSE(entry.lossless);
        EXPECT_LE(entry.maxError, volume.codeBook().step / 2);
        EXPECT_EQ(entry.maxError, found);
        EXPECT_EQ(readVolume("delta.vdb").origin()->maxError, entry.maxError);
        DeltaFileOptions strict = codesOnly();
        strict.maxError = entry.maxError * 0.99;
        EXPECT_THROW(DeltaFile().add(volume, strict), Error);
        strict.maxError = entry.maxError;
        EXPECT_NO_THROW(DeltaFile().add(volume, strict));
    }
}

// Of a restored volume no voxel is farther off than stated, and holding makes fewer deltas.
void expectWithin(const std::vector<float>& values, const Volume& volume, int sliceAxis,
                  const Tolerance& tolerance) {
    SCOPED_TRACE("axis " + std::to_string(sliceAxis) + ", relative " +
                 std::to_string(tolerance.relative) + ", value " + std::to_string(tolerance.value));
    DeltaFileOptions options;
    options.sliceAxis = sliceAxis;
    DeltaFile exactly;
    const DeltaFileEntry exact = exactly.add(volume, options);
    options.tolerance = tolerance;
    DeltaFile file;
    const DeltaFileEntry entry = file.add(volume, options);
    file.write("held.vdb");
    EXPECT_LT(entry.deltas, exact.deltas);
    options.pack = false;
    DeltaFile voxels;
    EXPECT_EQ(voxels.add(volume, options).maxError, entry.maxError);
    voxels.write("voxels.vdb");
    expectSameVolume(readVolume("held.vdb"), readVolume("voxels.vdb"));
    const PlainVolume plain = testing::readPlainDeltas("held.vdb", volume.name());
    double largest = 0;
    std::uint64_t over = 0, filled = 0;
    std::size_t i = 0;
    for (int z = 0; z < kWaves.z; ++z) {
        for (int y = 0; y < kWaves.y; ++y) {
            for (int x = 0; x < kWaves.x; ++x, ++i) {
                const double truth = values[i];
                const double error = std::fabs(plain.valueAt(Coord(x, y, z)) - truth);
                const bool tooFar =
                    (tolerance.relative > 0 && error > tolerance.relative * std::fabs(truth)) ||
                    (tolerance.value > 0 && error > tolerance.value);
                over += tooFar ? 1 : 0;
                filled += truth == 0 && error != 0 ? 1 : 0;
                largest = std::max(largest, error);
            }
        }
    }
    EXPECT_EQ(over, 0u);
    EXPECT_EQ(filled, 0u);
    EXPECT_GT(largest, 0);
    EXPECT_NEAR(entry.maxError, largest, 1e-4 * largest);
}

TEST(DeltaFile, ToleranceBoundsEveryVoxelsError) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        SCOPED_TRACE(seed);
        const TempFolder folder;
        std::mt19937 random(seed);
        std::vector<float> values = waves(random, 20);
        for (float& value : values) value = std::round(value * 4) / 4 + 0.0f;
        testing::writeBytes(kWavesFile, testing::bytesOf(values));
        const Volume volume = readKept(kWavesFile);
        ASSERT_TRUE(volume.codeBook().isExact());
        for (int axis = 0; axis < 3; ++axis) {
            expectWithin(values, volume, axis, {0.1, 0});
            expectWithin(values, volume, axis, {0, 9});
            expectWithin(values, volume, axis, {0.2, 7.5});
        }
    }
}

TEST(DeltaFile, ToleranceLeavesRoomForALinearBook) {
    const TempFolder folder;
    std::mt19937 random(9);
    const std::vector<float> values = waves(random, 20);
    testing::writeBytes(kWavesFile, testing::bytesOf(values));
    const Volume volume = readKept(kWavesFile, inBits(10));
    expectWithin(values, volume, 2, {0, 5});
    // Less than half a step cannot be kept.
    DeltaFileOptions options;
    options.tolerance.value = volume.codeBook().step / 3;
    EXPECT_THROW(DeltaFile().add(volume, options), Error);
}

TEST(DeltaFile, RelativeToleranceOfValuesOfManyKinds) {
    // More than 65536 different ones, over nine orders of magnitude and both signs.
    const TempFolder folder;
    std::mt19937 random(12);
    std::vector<float> values = waves(random, 20);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double scale = std::pow(10.0, double(i / 5000 % 10) - 6);
        values[i] *= float(i / 3000 % 3 == 0 ? -scale : scale);
    }
    testing::writeBytes(kWavesFile, testing::bytesOf(values));
    ReadOptions reading;
    reading.relativeError = 0.05;
    const Volume volume = readKept(kWavesFile, reading);
    EXPECT_EQ(volume.codeBook().name(), "table");
    EXPECT_FALSE(volume.codeBook().isExact());
    expectWithin(values, volume, 2, {0.1, 0});
    expectWithin(values, volume, 0, {0.1, 1e4});
    DeltaFileOptions options;
    options.tolerance.relative = 0.01;  // less than the code book's own error
    EXPECT_THROW(DeltaFile().add(volume, options), Error);
    // Without a book for it, the smallest values could not be kept.
    options.tolerance.relative = 0.1;
    EXPECT_THROW(DeltaFile().add(readKept(kWavesFile), options), Error);
}

// Active states survive holding; what is inactive never takes a value.
TEST(DeltaFile, ToleranceKeepsActiveStates) {
    const TempFolder folder;
    openvdb::initialize();
    std::mt19937 random(4);
    auto grid = randomGrid<openvdb::FloatGrid>(random, Kind::kHalf);
    grid->setName("density");
    const float background = grid->background();
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    for (int i = 0; i < 2000; ++i)
        grid->tree().setValueOn(randomCoord(random, box.min(), box.dim()), background);
    openvdb::io::File("source.vdb").write({grid});
    DeltaFileOptions options;
    options.tolerance.value = 2.5;
    DeltaFile file;
    file.add(readKept("source.vdb"), options);
    file.write("delta.vdb");
    const PlainVolume plain = testing::readPlainDeltas("delta.vdb", "density");
    auto accessor = grid->getConstAccessor();
    std::uint64_t held = 0;
    for (auto at = reachOf(*grid).begin(); at; ++at) {
        float value = 0;
        const bool on = accessor.probeValue(*at, value);
        ASSERT_EQ(on, plain.activeAt(*at));
        if (!on) {
            ASSERT_EQ(bits(plain.valueAt(*at)), bits(double(value)));
            continue;
        }
        const double error = std::fabs(plain.valueAt(*at) - double(value));
        // Nothing becomes empty, though active, and what is stays so.
        ASSERT_EQ(plain.valueAt(*at) == double(background), value == background);
        ASSERT_LE(error, 2.5);
        held += error > 0 ? 1 : 0;
    }
    EXPECT_GT(held, 100u);
}

// Volumes without empty places, a third of them of one value, on which deltas rest.
TEST(DeltaFile, DenseVolumesOfManyValuesComeBackAsTheyAreRead) {
    std::mt19937 random(31);
    const std::vector<float> floats = waves(random, 40);
    const std::vector<double> doubles(floats.begin(), floats.end());
    std::vector<std::int32_t> ints(floats.size());
    for (std::size_t i = 0; i < ints.size(); ++i)
        ints[i] = floats[i] == 0 ? -5 : std::int32_t(random());
    std::vector<std::uint32_t> labels(ints.begin(), ints.end());
    const std::tuple<std::string, std::string, std::string> sources[] = {
        {"float32", testing::bytesOf(floats), "float32"},
        {"float64", testing::bytesOf(doubles), "float64"},
        {"int32", testing::bytesOf(ints), "int32"},
        {"uint32", testing::bytesOf(labels), "int64"}};
    for (const auto& [type, bytes, book] : sources) {
        for (int form = 0; form < 6; ++form) {
            const int axis = form / 2;
            SCOPED_TRACE(type + " along " + std::to_string(axis));
            const TempFolder folder;
            const std::string name = "waves_95x41x50_" + type;
            testing::writeBytes(name + ".raw", bytes);
            const Volume volume = readKept(name + ".raw");
            ASSERT_TRUE(volume.codeBook().pieces);
            DeltaFileOptions options;
            options.sliceAxis = axis;
            options.keyInterval = axis == 1 ? 16 : 0;
            options.pack = form % 2 == 1;
            DeltaFile file;
            const DeltaFileEntry entry = file.add(volume, options);
            file.write("delta.vdb");
            EXPECT_EQ(entry.codeBook, book);
            EXPECT_TRUE(entry.lossless);
            // Of what rests, no more than its ends is spoken of.
            EXPECT_LT(entry.deltas, std::uint64_t(0.8 * double(floats.size())));
            const Volume restored = readKept("delta.vdb");
            EXPECT_EQ(restored.origin()->codeBook, book);
            expectSameVolume(volume, restored);
            // What lies outside is what a converted source has there.
            EXPECT_EQ(backgroundOf(restored.source()->grid), backgroundOf(volume.source()->grid));
            const PlainVolume plain = testing::readPlainDeltas("delta.vdb", name);
            std::uint64_t wrong = 0;
            for (std::size_t i = 0; i < floats.size(); ++i) {
                const Coord at(int(i % 95), int(i / 95 % 41), int(i / 3895));
                const double own = type == "int32"    ? double(ints[i])
                                   : type == "uint32" ? double(labels[i])
                                                      : double(floats[i]);
                wrong += plain.activeAt(at) && bits(plain.valueAt(at)) == bits(own) ? 0 : 1;
            }
            EXPECT_EQ(wrong, 0u);
            // Deltas of deltas lose nothing either.
            DeltaFile again;
            EXPECT_TRUE(again.add(restored, {}).lossless);
        }
    }
}

// What codes are off by is said to those who are given codes, of a source and of its deltas.
TEST(DeltaFile, WhoIsGivenTheValuesIsNotWarnedOfCodes) {
    const TempFolder folder;
    std::vector<double> values(std::size_t(60) * 50 * 40);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = double(i) * std::numeric_limits<double>::denorm_min();
    testing::writeBytes("tiny_60x50x40_float64.raw", testing::bytesOf(values));
    DeltaFile file;
    EXPECT_TRUE(file.add(readKept("tiny_60x50x40_float64.raw"), {}).lossless);
    file.write("delta.vdb");
    for (const char* name : {"tiny_60x50x40_float64.raw", "delta.vdb"}) {
        for (const bool keeps : {false, true}) {
            SCOPED_TRACE(std::string(name) + (keeps ? ", kept" : ""));
            std::vector<std::string> warnings;
            Listener listener;
            listener.warning = [&](const std::string& text) { warnings.push_back(text); };
            ReadOptions reading;
            reading.keepSource = keeps;
            const Volume volume = readVolume(name, reading, listener);
            EXPECT_GT(volume.codeError().relative, 1e-3);
            EXPECT_EQ(warnings.size(), keeps ? 0u : 1u);
        }
    }
}

// An array of 64-bit whole numbers, which .raw files have no type for.
void writeNpy(const std::string& file, const std::string& type, const std::string& shape,
              const std::string& data) {
    std::string text =
        "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + ")}";
    text.resize(117, ' ');
    text += '\n';
    testing::writeBytes(file, std::string("\x93NUMPY\1\0v\0", 10) + text + data);
}

// What most voxels hold, as a double, has no slot, nor is it a value of the source.
TEST(DeltaFile, DenseVolumesOfTheLargestIntegersComeBack) {
    const TempFolder folder;
    std::mt19937_64 random(3);
    constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max() - 65537;
    std::vector<std::int64_t> values(std::size_t(60) * 50 * 80);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = i % 3 != 0 ? kLargest : std::int64_t(random() >> 2);
    writeNpy("a.npy", "<i8", "80, 50, 60", testing::bytesOf(values));
    const Volume volume = readKept("a.npy");
    for (const bool pack : {false, true}) {
        SCOPED_TRACE(pack ? "packed" : "voxels");
        DeltaFileOptions options;
        options.pack = pack;
        DeltaFile file;
        const DeltaFileEntry entry = file.add(volume, options);
        file.write("delta.vdb");
        EXPECT_EQ(entry.codeBook, "int64");
        EXPECT_TRUE(entry.lossless);
        const Volume restored = readKept("delta.vdb");
        expectSameVoxels(*keptGrid<openvdb::Int64Grid>(volume),
                         *keptGrid<openvdb::Int64Grid>(restored));
    }
}

// Without sign and of 64 bits, whole numbers are doubles here, but their codes those of whole ones.
TEST(DeltaFile, LargeWholeNumbersAreReadAsTheirSourceIs) {
    for (const int bits : {24, 40, 64}) {
        SCOPED_TRACE(bits);
        const TempFolder folder;
        std::mt19937_64 random(5);
        std::vector<std::uint64_t> values(std::size_t(60) * 50 * 40);
        for (std::uint64_t& value : values) value = random() >> (64 - bits);
        writeNpy("a.npy", "<u8", "40, 50, 60", testing::bytesOf(values));
        const Volume volume = readVolume("a.npy");
        DeltaFile file;
        EXPECT_EQ(file.add(readKept("a.npy"), {}).codeBook, bits < 64 ? "int64" : "float64");
        file.write("delta.vdb");
        const Volume restored = readVolume("delta.vdb");
        EXPECT_EQ(restored.codeBook().name(), volume.codeBook().name());
        std::uint64_t wrong = 0;
        for (auto code = volume.codes()->tree().cbeginValueOn(); code; ++code) {
            const Code other = restored.codes()->tree().getValue(code.getCoord());
            wrong += restored.codeBook().valueOf(other) == volume.codeBook().valueOf(*code) ? 0 : 1;
        }
        EXPECT_EQ(wrong, 0u);
    }
}

// Errors that reading made are not forgotten.
TEST(DeltaFile, IntegersThatDoublesRoundAreNotCalledExact) {
    const TempFolder folder;
    std::mt19937_64 random(3);
    for (const unsigned kinds : {100u, 1000000u}) {
        std::vector<std::uint64_t> kind(kinds), values(std::size_t(60) * 50 * 40);
        for (std::uint64_t& value : kind) value = random();
        for (std::uint64_t& value : values) value = kind[random() % kinds];
        writeNpy("a.npy", "<u8", "40, 50, 60", testing::bytesOf(values));
        const Volume volume = readKept("a.npy");
        DeltaFile file;
        const DeltaFileEntry entry = file.add(volume, {});
        EXPECT_GT(entry.maxError, 0);
        EXPECT_FALSE(entry.lossless);
        file.write("delta.vdb");
        EXPECT_EQ(readVolume("delta.vdb").origin()->maxError, entry.maxError);
        DeltaFileOptions strict;
        strict.maxError = 0;
        EXPECT_THROW(DeltaFile().add(volume, strict), Error);
    }
}

// Of inactive voxels and the background too.
TEST(DeltaFile, InactiveIntegersThatDoublesRoundAreNotCalledExact) {
    const TempFolder folder;
    openvdb::initialize();
    for (const bool isBackground : {false, true}) {
        auto grid = openvdb::Int64Grid::create(isBackground ? (std::int64_t{1} << 60) + 1 : 0);
        for (int i = 0; i < 900; ++i) grid->tree().setValueOn(Coord(i % 9, i / 9 % 10, i / 90), i);
        if (!isBackground) grid->tree().setValueOff(Coord(3, 3, 3), (std::int64_t{1} << 53) + 1);
        grid->setName("count");
        openvdb::io::File("source.vdb").write({grid});
        std::vector<std::string> warnings;
        Listener listener;
        listener.warning = [&](const std::string& text) { warnings.push_back(text); };
        const DeltaFileEntry entry = DeltaFile().add(readKept("source.vdb"), {}, listener);
        EXPECT_FALSE(entry.lossless);
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_NE(warnings[0].find("beyond 2^53"), std::string::npos);
    }
}

TEST(DeltaFile, GridsOfManyValuesComeBackAsTheyAreRead) {
    const TempFolder folder;
    openvdb::initialize();
    std::mt19937 random(77);
    auto grid = randomGrid<openvdb::FloatGrid>(random, Kind::kManyFloats);
    for (int i = 0; i < 90000; ++i)
        grid->tree().setValueOn(Coord(i % 45, i / 45 % 45, i / 2025),
                                randomValue<float>(random, Kind::kManyFloats));
    grid->setName("density");
    openvdb::io::File("source.vdb").write({grid});
    const Volume volume = readKept("source.vdb");
    ASSERT_TRUE(volume.codeBook().pieces);
    DeltaFile file;
    file.add(volume, {});
    file.write("delta.vdb");
    expectSameVolume(volume, readKept("delta.vdb"));
    // Who asks for less is given less.
    EXPECT_EQ(DeltaFile().add(volume, codesOnly()).codeBook, "pieces");
    DeltaFileOptions held;
    held.tolerance.value = 0.1;
    EXPECT_EQ(DeltaFile().add(volume, held).codeBook, "pieces");
    EXPECT_EQ(DeltaFile().add(readKept("source.vdb", inBits(12)), codesOnly()).codeBook, "linear");
}

// Returns the largest error of a volume's codes as they come back, which is what is said of it.
std::int64_t largestErrorOfCodes(const openvdb::Int32Grid& grid, const Volume& volume, bool pack) {
    SCOPED_TRACE(pack ? "packed" : "voxels");
    DeltaFileOptions options = codesOnly();
    options.pack = pack;
    DeltaFile file;
    const DeltaFileEntry entry = file.add(volume, options);
    file.write("delta.vdb");
    const Volume restored = readKept("delta.vdb");
    const auto kept = keptGrid<openvdb::Int32Grid>(restored);
    std::int64_t largest = 0;
    const PlainVolume plain = testing::readPlainDeltas("delta.vdb", "count");
    std::uint64_t others = 0;
    for (auto voxel = grid.cbeginValueOn(); voxel; ++voxel) {
        const std::int64_t other = kept->tree().getValue(voxel.getCoord());
        others += plain.valueAt(voxel.getCoord()) == double(other) ? 0 : 1;
        largest = std::max(largest, std::abs(other - std::int64_t(*voxel)));
    }
    EXPECT_EQ(others, 0u);
    EXPECT_EQ(double(largest), entry.maxError);
    return largest;
}

// Whole numbers of more than 65536 kinds, up to the ends of their type.
TEST(DeltaFile, WideIntegersStayWholeAndWithinHalfAStep) {
    const TempFolder folder;
    openvdb::initialize();
    std::mt19937 random(8);
    for (const bool ends : {false, true}) {
        auto grid = openvdb::Int32Grid::create(3);
        std::int64_t value = ends ? std::numeric_limits<std::int32_t>::min() : 16'000'000;
        for (int i = 0; i < 50 * 50 * 40; ++i) {
            grid->tree().setValue(Coord(i % 50, i / 50 % 50, i / 2500), std::int32_t(value));
            value += 1 + random() % (ends ? 80000u : 2u);
            value = std::min<std::int64_t>(value, std::numeric_limits<std::int32_t>::max());
        }
        grid->setName("count");
        openvdb::io::File("source.vdb").write({grid});
        const Volume volume = readKept("source.vdb");
        ASSERT_FALSE(volume.codeBook().isExact());
        double step = 0;
        for (int code = 0; code < kCodeCount; ++code) {
            const double own = volume.codeBook().valueOf(Code(code));
            EXPECT_EQ(own, std::floor(own));
            step = std::max(step, 2 * volume.codeBook().largestErrorOf(Code(code)));
        }
        for (const bool pack : {false, true}) {
            const std::int64_t largest = largestErrorOfCodes(*grid, volume, pack);
            EXPECT_GT(largest, 0);
            EXPECT_LE(double(largest), step / 2);
            EXPECT_EQ(double(largest), volume.codeError().absolute);
        }
    }
}

// Ladders for floats with an outlier, of both signs: as whoever reads the page would read them.
TEST(DeltaFile, FloatsBesideAnOutlierComeBackAsTheirCodes) {
    const TempFolder folder;
    std::mt19937 random(19);
    std::vector<float> values(std::size_t(50) * 48 * 40);
    for (float& value : values) value = float(random() % 6000001) * 1e-9f - 0.003f;
    values[777] = 1000;
    testing::writeBytes("fog_50x48x40_float32.raw", testing::bytesOf(values));
    const Volume volume = readKept("fog_50x48x40_float32.raw");
    ASSERT_TRUE(volume.codeBook().pieces);
    DeltaFile file;
    DeltaFileOptions options = codesOnly();
    options.pack = true;
    const DeltaFileEntry entry = file.add(volume, options);
    file.write("delta.vdb");
    EXPECT_EQ(entry.maxError, volume.codeError().absolute);
    const Volume restored = readVolume("delta.vdb");
    EXPECT_EQ(*restored.codeBook().table, *volume.codeBook().table);
    EXPECT_EQ(restored.codeBook().largestErrorOf(9), volume.codeBook().largestErrorOf(9));
    const PlainVolume plain = testing::readPlainDeltas("delta.vdb", "fog_50x48x40_float32");
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Coord at(int(i % 50), int(i / 50 % 48), int(i / 2400));
        const auto own = double(values[i]);
        ASSERT_LE(std::fabs(plain.valueAt(at) - own),
                  std::max(2e-4 * std::fabs(own), 0x1p-16 * 0.006));
        ASSERT_EQ(plain.valueAt(at),
                  volume.codeBook().valueOf(volume.codes()->tree().getValue(at)));
    }
}

// Whole numbers whose smallest in use is far from the first that their book has.
void beginWithTheSmallest(bool pack) {
    SCOPED_TRACE(pack);
    const TempFolder folder;
    std::mt19937 random(14);
    std::vector<std::int16_t> values(std::size_t(60) * 50 * 40);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = std::int16_t(i % 5 == 0 ? 1700 : 1200 + int(random() % 900));
    values[31] = 20000;
    testing::writeBytes("a_60x50x40_int16.raw", testing::bytesOf(values));
    const Volume volume = readKept("a_60x50x40_int16.raw");
    DeltaFileOptions options;
    options.pack = pack;
    DeltaFile file;
    EXPECT_TRUE(file.add(volume, options).lossless);
    file.write("delta.vdb");
    const Volume restored = readVolume("delta.vdb");
    EXPECT_EQ(restored.codeBook().offset, 1200);
    EXPECT_EQ(restored.valueMin(), 1200);
    EXPECT_EQ(restored.valueMax(), 20000);
    EXPECT_EQ(restored.mostFrequent()->value, 1700);
    const PlainVolume plain = testing::readPlainDeltas("delta.vdb", "a_60x50x40_int16");
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Coord at(int(i % 60), int(i / 60 % 50), int(i / 3000));
        ASSERT_EQ(plain.valueAt(at), values[i]);
        ASSERT_EQ(restored.codeBook().valueOf(restored.codes()->tree().getValue(at)), values[i]);
    }
}

TEST(DeltaFile, WholeNumbersBeginWithTheSmallest) {
    beginWithTheSmallest(true);
    beginWithTheSmallest(false);
}

TEST(DeltaFile, PackedGridsWithoutVoxelsComeBack) {
    const TempFolder folder;
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.25f);
    grid->setName("density");
    openvdb::io::File("source.vdb").write({grid});
    DeltaFileOptions options;
    options.pack = true;
    DeltaFile file;
    EXPECT_TRUE(file.add(readKept("source.vdb"), options).lossless);
    file.write("delta.vdb");
    const Volume restored = readKept("delta.vdb");
    EXPECT_EQ(restored.activeCount(), 0u);
    EXPECT_EQ(restored.background(), 0.25);
    ASSERT_TRUE(restored.source()->grid.as<openvdb::FloatTree>());
    EXPECT_EQ(restored.source()->grid.tree->leafCount(), 0u);
    EXPECT_EQ(testing::readPlainDeltas("delta.vdb", "density").background, 0.25);
}

// What one delta grid lost, another made of it does not forget.
TEST(DeltaFile, ErrorsOfADeltaGridAreCarriedOn) {
    const TempFolder folder;
    std::mt19937 random(2);
    testing::writeBytes(kWavesFile, testing::bytesOf(waves(random, 20)));
    DeltaFileOptions options;
    options.tolerance.value = 4;
    DeltaFile first;
    const DeltaFileEntry before = first.add(readKept(kWavesFile), options);
    first.write("first.vdb");
    DeltaFile second;
    const DeltaFileEntry same = second.add(readKept("first.vdb"), {});
    EXPECT_EQ(same.maxError, before.maxError);
    EXPECT_FALSE(same.lossless);
    second.write("second.vdb");
    EXPECT_EQ(readVolume("second.vdb").origin()->maxError, before.maxError);
    EXPECT_EQ(readVolume("second.vdb").origin()->toleranceValue, 4);
}

}  // namespace
}  // namespace deltasplat
