// SPDX-License-Identifier: Apache-2.0
// A packed delta grid that is read straight from its file's leaves is the volume that it is as a
// whole OpenVDB grid, shows the same pictures, and is refused with the same words. Deltas that lie
// in a file as voxels are always read as a whole grid.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "deltasplat/delta/delta_file.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/read_delta_grid.h"
#include "formats/vdb/vdb_file.h"
#include "support/changed_volume.h"
#include "support/same_picture.h"
#include "support/same_volume.h"
#include "unit/ingest_helpers.h"
#include "volume/code_tree.h"
#include "volume/slot_blocks.h"
#include "volume/tree_types.h"
#include "volume/vdb_transform.h"
#include "words/packed_deltas.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using test::expectSameCodes;
using test::expectSameFacts;
using testing::TempFolder;

const std::string kDeltas = "deltas.vdb";

// Reads a file as a whole OpenVDB grid, as readVolume does where blocks are not enough.
Volume readWhole(const std::string& file) {
    ReadOptions options;
    options.keepSource = true;
    const VdbFile vdb(file);
    if (vdb.grids().empty() || !vdb.grids().front().isScalar()) return readVolume(file, options);
    const VdbGrid& grid = vdb.grids().front();
    const std::string where = file + ": grid \"" + grid.name + "\"";
    TreeGrid stored = vdb.read(grid, {});
    if (!isDeltaGrid(stored)) return readVolume(file, options);
    worldFromIndexOf(*stored.map, where);
    VolumeData volume = readDeltaGrid(stored, vdb.metadata(), where, options, {});
    volume.name = grid.name;
    volume.source = nullptr;
    return Volume(std::move(volume));
}

const SlotBlocks* blocksOf(const Volume& volume) {
    return volume.codes()->blocksAlong(volume.origin()->sliceAxis);
}

// How deltas lie in a file.
constexpr std::array kPacked{false, true};

// Writes a volume's deltas, and returns what is read of them.
Volume throughDeltas(const Volume& volume, int sliceAxis, int keyInterval, bool pack) {
    DeltaFileOptions options;
    options.sliceAxis = sliceAxis;
    options.keyInterval = keyInterval;
    options.pack = pack;
    DeltaFile file;
    file.add(volume, options);
    file.write(kDeltas);
    return readVolume(kDeltas);
}

// What is said of the volume and of its deltas, before any tree is made.
void expectSameOfDeltas(const Volume& a, const Volume& b) {
    expectSameFacts(a, b);
    ASSERT_TRUE(a.origin() && b.origin());
    EXPECT_EQ(a.origin()->deltas, b.origin()->deltas);
    EXPECT_EQ(a.origin()->keyInterval, b.origin()->keyInterval);
}

std::vector<Slot> someClasses(unsigned step) {
    std::vector<Slot> classes(kSlotCount, 0);
    for (Slot slot = 1; slot < kSlotCount; ++slot)
        classes[std::size_t(slot)] = slot % 5 == 0 ? 0 : 1 + slot / Slot(step) % 60000;
    return classes;
}

void expectSameWords(const PackedDeltas& a, const PackedDeltas& b) {
    EXPECT_EQ(a.box, b.box);
    EXPECT_EQ(a.begins, b.begins);
    ASSERT_EQ(a.slabs.size(), b.slabs.size());
    for (std::size_t i = 0; i < a.slabs.size(); ++i) {
        EXPECT_EQ(a.slabs[i].firstSlice, b.slabs[i].firstSlice);
        EXPECT_EQ(a.slabs[i].deltas, b.slabs[i].deltas);
        EXPECT_EQ(a.slabs[i].whole, b.slabs[i].whole);
    }
    ASSERT_EQ(a.words.size(), b.words.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < a.words.size(); ++i) {
        const DeltaWord& p = a.words[i];
        const DeltaWord& q = b.words[i];
        const bool isSame = p.visible == q.visible && p.changed == q.changed &&
                            p.block == q.block && std::equal(p.classes, p.classes + 64, q.classes);
        wrong += isSame ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0u);
}

// Compares words before any tree is made, those held within a tolerance too, and then codes.
void expectSameAsWhole(const Volume& quick, bool pack) {
    ASSERT_EQ(blocksOf(quick) != nullptr, pack);
    const Volume whole = readWhole(kDeltas);
    ASSERT_EQ(blocksOf(whole), nullptr);
    expectSameOfDeltas(quick, whole);
    const int axis = quick.origin()->sliceAxis;
    const auto holds = [](Slot held, Slot slot) { return std::abs(held - slot) < 40; };
    for (const Encoding encoding :
         {Encoding::kChanges, Encoding::kWhole, Encoding::kFewerWordsOrStamps}) {
        for (const unsigned step : {1u, 7u}) {
            const std::vector<Slot> classes = someClasses(step);
            expectSameWords(packDeltas(quick, {axis, encoding, classes, {}}),
                            packDeltas(whole, {axis, encoding, classes, {}}));
            expectSameWords(packDeltas(quick, {axis, encoding, classes, holds}),
                            packDeltas(whole, {axis, encoding, classes, holds}));
        }
    }
    const std::vector<Slot> classes = someClasses(3);
    for (int other = 0; other < 3; ++other)
        expectSameWords(packDeltas(quick, {other, Encoding::kChanges, classes, {}}),
                        packDeltas(whole, {other, Encoding::kChanges, classes, {}}));
    expectSameCodes(quick, whole);
    ReadOptions asked;
    asked.readLater = true;
    const Volume later = readVolume(kDeltas, asked);
    expectSameOfDeltas(later, whole);
    expectSameWords(packDeltas(later, {axis, Encoding::kFewerWordsOrStamps, classes, {}}),
                    packDeltas(whole, {axis, Encoding::kFewerWordsOrStamps, classes, {}}));
    expectSameCodes(later, whole);
    const ThreadLimit one(1);
    const Volume alone = readVolume(kDeltas);
    expectSameOfDeltas(alone, whole);
    expectSameCodes(alone, whole);
}

// Boxes, single voxels and tiles, active and inactive, with values of their own, anywhere.
template <typename Grid, typename Value>
typename Grid::Ptr randomGrid(std::mt19937& random, const Value& value) {
    using T = typename Grid::ValueType;
    const auto below = [&](int n) { return int(random() % unsigned(n)); };
    const Coord size(1 + below(70), 1 + below(70), 1 + below(70));
    const Coord low(below(300) - 200, below(300) - 200, below(300) - 200);
    const auto place = [&] {
        return low + Coord(below(size.x()), below(size.y()), below(size.z()));
    };
    auto grid = Grid::create(random() % 2 ? T(0) : value());
    auto& tree = grid->tree();
    for (int i = 0; i < 6; ++i) {
        const Coord a = place(), b = place();
        tree.fill({Coord::minComponent(a, b), Coord::maxComponent(a, b)}, value(),
                  random() % 4 != 0);
    }
    for (int i = 0; i < 3000; ++i) {
        if (random() % 5 != 0) {
            tree.setValueOn(place(), value());
        } else {
            tree.setValueOff(place(), value());
        }
    }
    tree.addTile(1, place(), value(), true);
    tree.addTile(1, place(), value(), false);
    grid->setName("density");
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    return grid;
}

template <typename Grid, typename Value>
void expectSameOfRandom(unsigned seed, const Value& value, const std::string& codeBook,
                        bool half = false) {
    SCOPED_TRACE(codeBook + ", seed " + std::to_string(seed));
    const TempFolder folder;
    openvdb::initialize();
    std::mt19937 random(seed);
    const auto grid = randomGrid<Grid>(random, [&] { return value(random); });
    grid->setSaveFloatAsHalf(half);
    openvdb::io::File("source.vdb").write({grid});
    ReadOptions reading;
    reading.keepSource = true;
    const Volume source = readVolume("source.vdb", reading);
    for (const bool pack : kPacked) {
        const Volume quick = throughDeltas(source, int(seed % 3), int(8 * (1 + seed % 5)), pack);
        ASSERT_EQ(quick.origin()->codeBook, codeBook);
        expectSameAsWhole(quick, pack);
    }
}

TEST(DeltaLeaves, HalfGrids) {
    const auto value = [](std::mt19937& random) {
        return float(openvdb::math::half(float(int(random() % 4001) - 2000) / 512));
    };
    for (unsigned seed = 1; seed <= 8; ++seed)
        expectSameOfRandom<openvdb::FloatGrid>(seed, value, "half", true);
}

TEST(DeltaLeaves, GridsOfFewFloats) {
    const auto value = [](std::mt19937& random) { return float(std::sin(double(random() % 90))); };
    for (unsigned seed = 11; seed <= 16; ++seed)
        expectSameOfRandom<openvdb::FloatGrid>(seed, value, "table");
}

TEST(DeltaLeaves, IntegerGrids) {
    const auto value = [](std::mt19937& random) { return int(random() % 60000) - 20000; };
    for (unsigned seed = 21; seed <= 26; ++seed)
        expectSameOfRandom<openvdb::Int32Grid>(seed, value, "integer");
}

TEST(DeltaLeaves, BoolGrids) {
    const auto value = [](std::mt19937& random) { return random() % 2 != 0; };
    for (unsigned seed = 31; seed <= 33; ++seed)
        expectSameOfRandom<openvdb::BoolGrid>(seed, value, "integer");
}

// A volume without empty places, most of which rests; of sizes that end within blocks.
std::string writeDense(unsigned seed, const glm::ivec3& dims) {
    std::mt19937 random(seed);
    std::string voxels(std::size_t(dims.x) * std::size_t(dims.y) * std::size_t(dims.z), '\7');
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const bool rests = std::hypot(x - 20, y - 14, z - 21) > 17;
                const int value = rests ? 7 : x + (random() % 3 == 0 ? int(random() % 90) : 0);
                voxels[std::size_t((z * dims.y + y) * dims.x + x)] = char(value);
            }
        }
    }
    const std::string name = "dense_" + std::to_string(dims.x) + "x" + std::to_string(dims.y) +
                             "x" + std::to_string(dims.z) + "_uint8.raw";
    testing::writeBytes(name, voxels);
    return name;
}

TEST(DeltaLeaves, VolumesWithoutEmptyPlaces) {
    unsigned seed = 0;
    for (const glm::ivec3 dims :
         {glm::ivec3(43, 29, 50), glm::ivec3(8, 64, 24), glm::ivec3(1), glm::ivec3(33, 1, 70)}) {
        for (int axis = 0; axis < 3; ++axis) {
            const TempFolder folder;
            ReadOptions reading;
            reading.keepSource = true;
            const Volume source = readVolume(writeDense(++seed, dims), reading);
            for (const bool pack : kPacked)
                expectSameAsWhole(throughDeltas(source, axis, seed % 2 ? 8 : 24, pack), pack);
        }
    }
}

TEST(DeltaLeaves, PicturesAreTheSame) {
    const TempFolder folder;
    ReadOptions reading;
    reading.keepSource = true;
    const Volume source = readVolume(writeDense(5, {43, 29, 50}), reading);
    RenderOptions options;
    options.camera.sizePixels = {60, 50};
    options.optics.transferFunction.colors = {{0, {1, 0.2, 0}}, {90, {0, 0.4, 1}}};
    options.optics.transferFunction.opacities = {{5, 0, 0.5, 0}, {30, 0.3, 0.5, 0}};
    for (int axis = 0; axis < 3; ++axis) {
        SCOPED_TRACE(axis);
        throughDeltas(source, axis, 16, axis == 1);
        const Volume whole = readWhole(kDeltas);
        for (const char* view : {"front", "left", "top", "iso"}) {
            options.camera.view = view;
            for (const std::optional<int> between :
                 {std::optional<int>(0), std::optional<int>(1)}) {
                options.splat.between = between;
                const Volume quick = readVolume(kDeltas);
                const auto expected = render(whole, options).image.rgba;
                EXPECT_TRUE(render(source, options).image.rgba == expected);
                EXPECT_TRUE(render(quick, options).image.rgba == expected);
                test::expectTheSameHoweverMade([&](Method method) {
                    RenderOptions other = options;
                    other.splat.method = method;
                    return render(readVolume(kDeltas), other).image.rgba;
                });
            }
        }
    }
}

// What reads leaves finds the tree that the blocks make.
TEST(DeltaLeaves, PicturesThatNeedTheTreeAreTheSame) {
    const TempFolder folder;
    ReadOptions reading;
    reading.keepSource = true;
    throughDeltas(readVolume(writeDense(6, {43, 29, 50}), reading), 2, 16, true);
    const Volume whole = readWhole(kDeltas);
    RenderOptions options;
    options.camera.sizePixels = {60, 50};
    options.camera.view = "front";
    options.optics.transferFunction.colors = {{0, {1, 0.2, 0}}, {90, {0, 0.4, 1}}};
    options.optics.transferFunction.opacities = {{5, 0, 0.5, 0}, {30, 0.3, 0.5, 0}};
    options.optics.shading.emplace();
    EXPECT_TRUE(render(readVolume(kDeltas), options).image.rgba ==
                render(whole, options).image.rgba);
    options.optics.shading.reset();
    options.splat.tolerance.value = 9;
    EXPECT_TRUE(render(readVolume(kDeltas), options).image.rgba ==
                render(whole, options).image.rgba);
    options.splat.tolerance = {};
    options.mode = Mode::kMip;
    EXPECT_TRUE(render(readVolume(kDeltas), options).image.rgba ==
                render(whole, options).image.rgba);
}

// Writes the deltas of kDeltas anew, as another program might, and compares what is read of them.
template <typename Grid>
void expectSameOfOtherWriters() {
    const Volume whole = readWhole(kDeltas);
    openvdb::initialize();
    openvdb::io::File input(kDeltas);
    input.open();
    const auto grid = openvdb::gridPtrCast<Grid>(input.readGrid(whole.name()));
    // Inactive deltas mean nothing.
    int changed = 0;
    for (auto leaf = grid->tree().beginLeaf(); leaf; ++leaf) {
        for (auto off = leaf->beginValueOff(); off; ++off, ++changed)
            leaf->setValueOnly(off.pos(), changed % 5);
    }
    ASSERT_GT(changed, 0);
    using namespace openvdb::io;
    for (const std::uint32_t packing :
         {std::uint32_t(COMPRESS_NONE), std::uint32_t(COMPRESS_ACTIVE_MASK),
          std::uint32_t(COMPRESS_BLOSC), std::uint32_t(COMPRESS_ACTIVE_MASK | COMPRESS_BLOSC),
          std::uint32_t(COMPRESS_ZIP)}) {
        SCOPED_TRACE(packing);
        openvdb::io::File output("other.vdb");
        output.setCompression(packing);
        output.write({grid});
        output.close();
        const Volume quick = readVolume("other.vdb");
        EXPECT_EQ(blocksOf(quick) != nullptr, (std::is_same_v<Grid, openvdb::Int64Grid>));
        expectSameOfDeltas(quick, whole);
        expectSameCodes(quick, whole);
    }
}

// What the file is not packed by, or what it holds besides, is read as well or left to OpenVDB.
TEST(DeltaLeaves, OtherWritersFiles) {
    const TempFolder folder;
    ReadOptions reading;
    reading.keepSource = true;
    const Volume source = readVolume(writeDense(8, {43, 29, 50}), reading);
    throughDeltas(source, 0, 16, false);
    expectSameOfOtherWriters<openvdb::Int32Grid>();
    throughDeltas(source, 0, 16, true);
    expectSameOfOtherWriters<openvdb::Int64Grid>();
}

// Words of several leaves, and of several nodes' worth of leaves read at once.
TEST(DeltaLeaves, StreamsOfManyLeaves) {
    const TempFolder folder;
    std::mt19937 random(12);
    std::string voxels;
    for (int i = 0; i < 100 * 90 * 80; ++i) voxels += char(random());
    testing::writeBytes("noise_100x90x80_uint8.raw", voxels);
    ReadOptions reading;
    reading.keepSource = true;
    const Volume quick =
        throughDeltas(readVolume("noise_100x90x80_uint8.raw", reading), 1, 16, true);
    openvdb::initialize();
    openvdb::io::File input(kDeltas);
    input.open();
    const auto words = openvdb::gridPtrCast<openvdb::Int64Grid>(input.readGrid(quick.name()));
    EXPECT_GT(words->tree().leafCount(), 150u);
    expectSameAsWhole(quick, true);
}

TEST(DeltaLeaves, EmptyVolumes) {
    const TempFolder folder;
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0.5f);
    grid->setName("density");
    openvdb::io::File("source.vdb").write({grid});
    ReadOptions reading;
    reading.keepSource = true;
    for (const bool pack : kPacked) {
        const Volume quick = throughDeltas(readVolume("source.vdb", reading), 1, 8, pack);
        EXPECT_TRUE(quick.empty());
        expectSameOfDeltas(quick, readWhole(kDeltas));
    }
}

// Returns the message, or what was read in short.
std::string outcomeOf(const std::function<Volume()>& read) {
    try {
        const Volume volume = read();
        std::string text = std::to_string(volume.activeCount()) + " voxels";
        for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
            if (volume.histogram()[code] != 0)
                text += " " + std::to_string(code) + ":" + std::to_string(volume.histogram()[code]);
        }
        std::uint64_t sum = 0;
        const openvdb::tree::ValueAccessor<const CodeTree::Tree> codes(volume.codes()->tree());
        const glm::ivec3 low = volume.box().min, high = volume.box().max;
        for (openvdb::CoordBBox::Iterator<true> at(
                 {{low.x, low.y, low.z}, {high.x, high.y, high.z}});
             at; ++at) {
            Code code = 0;
            const bool isOn = codes.probeValue(*at, code);
            sum = 31 * sum + (isOn ? code + 1u : 0u);
        }
        return text + " " + std::to_string(sum);
    } catch (const Error& error) {
        return error.what();
    }
}

void expectSameRefusals(bool isDense, bool pack) {
    SCOPED_TRACE(std::string(isDense ? "dense" : "sparse") + (pack ? ", packed" : ""));
    const TempFolder folder;
    openvdb::initialize();
    ReadOptions reading;
    reading.keepSource = true;
    std::mt19937 random(isDense ? 3 : 4);
    std::string name = "source.vdb";
    if (isDense) {
        name = writeDense(9, {20, 14, 24});
    } else {
        const auto grid =
            randomGrid<openvdb::Int32Grid>(random, [&] { return int(random() % 300); });
        openvdb::io::File(name).write({grid});
    }
    const Volume quick = throughDeltas(readVolume(name, reading), 2, pack ? 24 : 8, pack);
    ASSERT_EQ(blocksOf(quick) != nullptr, pack);
    const std::string bytes = testing::readBytes(kDeltas);
    int refused = 0;
    // Of several things that are wrong, one thread finds the same first.
    const ThreadLimit one(1);
    for (int i = 0; i < 400; ++i) {
        std::string damaged = bytes;
        // Half of them in the masks, which come last but for the values.
        const std::size_t from = i % 2 ? bytes.size() / 2 : 0;
        for (int n = 0; n < 1 + i % 3; ++n)
            damaged[from + random() % (bytes.size() - from)] ^= char(1 << random() % 8);
        testing::writeBytes("damaged.vdb", damaged);
        const std::string whole = outcomeOf([] { return readWhole("damaged.vdb"); });
        EXPECT_EQ(outcomeOf([] { return readVolume("damaged.vdb"); }), whole) << i;
        refused += whole.find("damaged.vdb") != std::string::npos ? 1 : 0;
    }
    EXPECT_GT(refused, 20);
    EXPECT_LT(refused, 400);
}

// Bytes of a file changed at random: both ways of reading say the same.
TEST(DeltaLeaves, DamagedFilesAreRefusedWithTheSameWords) {
    for (const bool isDense : {true, false}) {
        for (const bool pack : kPacked) expectSameRefusals(isDense, pack);
    }
}

}  // namespace
}  // namespace deltasplat
