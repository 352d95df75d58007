// SPDX-License-Identifier: Apache-2.0
// What volumes become in a .vdb, read back by OpenVDB alone.
#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/delta/delta_file.h"
#include "deltasplat/ingest/list_grids.h"
#include "support/changed_volume.h"
#include "unit/convert_helpers.h"
#include "unit/format_helpers.h"
#include "unit/vdb_compare.h"
#include "unit/vdb_helpers.h"
#include "volume/placement.h"
#include "volume/tree_types.h"

namespace deltasplat::testing {
namespace {

using openvdb::Coord;
constexpr glm::ivec3 kDims(19, 17, 10);

// Writes raw values, and checks every voxel and what the grid says of itself.
template <typename Grid, typename T>
void expectStored(const std::string& type, const std::vector<T>& values, bool half,
                  const std::vector<std::string>& notes, const WriteOptions& options = {}) {
    SCOPED_TRACE(type + " up to " + std::to_string(values.back()));
    const WriteReport report = write("out.vdb", rawVolume(values, kDims, type), options);
    EXPECT_EQ(report.notes, notes);
    EXPECT_TRUE(report.lossless);
    EXPECT_EQ(report.maxError, 0);
    EXPECT_EQ(report.files, std::vector<std::filesystem::path>{"out.vdb"});
    const auto grid = readGrid<Grid>("out.vdb");
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->saveFloatAsHalf(), half);
    EXPECT_EQ(grid->activeVoxelCount(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Coord place(int(i % 19), int(i / 19 % 17), int(i / 19 / 17));
        ASSERT_EQ(double(grid->tree().getValue(place)), double(values[i])) << place;
    }
    EXPECT_EQ(grid->evalActiveVoxelBoundingBox(), openvdb::CoordBBox({0, 0, 0}, {18, 16, 9}));
    EXPECT_EQ(grid->template metaValue<std::string>("deltasplat_source_type"), type);
    EXPECT_EQ(grid->template metaValue<openvdb::Vec3i>("deltasplat_box_max"),
              openvdb::Vec3i(18, 16, 9));
    EXPECT_EQ(grid->getName(), "source");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_UNKNOWN);
    EXPECT_EQ(grid->getCreator().substr(0, 11), "deltasplat ");
}

TEST(WriteGrids, SmallIntegersAreHalves) {
    const TempFolder folder;
    expectStored<openvdb::FloatGrid>("uint8", pattern<std::uint8_t>(kDims, 0, 255), true,
                                     {"out.vdb: uint8 stored as half, which holds every value"});
    expectStored<openvdb::FloatGrid>("int8", pattern<std::int8_t>(kDims, -128, 127), true,
                                     {"out.vdb: int8 stored as half, which holds every value"});
    expectStored<openvdb::FloatGrid>("int16", pattern<std::int16_t>(kDims, -2048, 2048), true,
                                     {"out.vdb: int16 stored as half, which holds every value"});
    expectStored<openvdb::FloatGrid>("uint16", pattern<std::uint16_t>(kDims, 0, 2049), false,
                                     {"out.vdb: uint16 stored as float, which holds every value"});
    WriteOptions options;
    options.fullFloat = true;
    expectStored<openvdb::FloatGrid>("uint8", pattern<std::uint8_t>(kDims, 0, 255), false,
                                     {"out.vdb: uint8 stored as float, which holds every value"},
                                     options);
}

TEST(WriteGrids, LargeIntegersTakeTheSmallestTypeThatHoldsThem) {
    const TempFolder folder;
    expectStored<openvdb::FloatGrid>("uint32", pattern<std::uint32_t>(kDims, 0, 1 << 24), false,
                                     {"out.vdb: uint32 stored as float, which holds every value"});
    expectStored<openvdb::Int32Grid>("int32", pattern<std::int32_t>(kDims, -16777217, 5), false,
                                     {});
    expectStored<openvdb::Int32Grid>("uint32", pattern<std::uint32_t>(kDims, 0, 16777217), false,
                                     {"out.vdb: uint32 stored as int32, which holds every value"});
    expectStored<openvdb::DoubleGrid>(
        "uint32", pattern<std::uint32_t>(kDims, 0, 4000000001U), false,
        {"out.vdb: uint32 stored as double, which holds every value"});
}

TEST(WriteGrids, RealValues) {
    const TempFolder folder;
    expectStored<openvdb::FloatGrid>(
        "float32", std::vector<float>(kDims.x * kDims.y * kDims.z, 0.25F), true, {});
    expectStored<openvdb::FloatGrid>("float32", pattern<float>(kDims, 0, 0.1F), false, {});
    expectStored<openvdb::FloatGrid>(
        "float64", std::vector<double>(kDims.x * kDims.y * kDims.z, 0x1p-30), false,
        {"out.vdb: float64 stored as float, which holds every value"});
    expectStored<openvdb::DoubleGrid>("float64", pattern<double>(kDims, 0, 0.1), false, {});
}

TEST(WriteGrids, MoreValuesThanCodes) {
    const TempFolder folder;
    const glm::ivec3 dims(60, 50, 40);
    std::vector<float> values(std::size_t(dims.x * dims.y * dims.z));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-10, 10);
    for (float& value : values) value = uniform(random);
    write("out.vdb", rawVolume(values, dims, "float32"));
    const auto grid = readGrid<openvdb::FloatGrid>("out.vdb");
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Coord place(int(i % 60), int(i / 60 % 50), int(i / 3000));
        if (grid->tree().getValue(place) != values[i] || !grid->tree().isValueOn(place)) ++wrong;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(grid->activeVoxelCount(), values.size());

    // Doubles that are floats all of them do not need the type they came in.
    write("out.vdb", rawVolume(std::vector<double>(values.begin(), values.end()), dims, "float64"));
    const auto narrow = readGrid<openvdb::FloatGrid>("out.vdb");
    ASSERT_TRUE(narrow);
    EXPECT_EQ(countDifferences(narrow->constTree(), grid->constTree()), 0u);
}

TEST(WriteGrids, UniformBlocksAreTiles) {
    const TempFolder folder;
    write("out.vdb",
          rawVolume(std::vector<std::uint8_t>(64 * 64 * 64, 7), glm::ivec3(64), "uint8"));
    const auto grid = readGrid<openvdb::FloatGrid>("out.vdb");
    EXPECT_EQ(grid->tree().leafCount(), 0u);
    EXPECT_EQ(grid->activeVoxelCount(), 64u * 64 * 64);
}

TEST(WriteGrids, PlacesAreExact) {
    const TempFolder folder;
    const std::vector<std::uint8_t> values = pattern<std::uint8_t>(kDims, 0, 9);
    Volume volume = rawVolume(values, kDims, "uint8", {0.7, 1.1, 0.3}, {5.1, -1e6 / 3, 0.1});
    const glm::dmat4 scaled = volume.worldFromIndex();
    write("out.vdb", volume);
    EXPECT_EQ(readGrids("out.vdb").at(0)->transform().mapType(), "ScaleTranslateMap");
    EXPECT_EQ(readVolume("out.vdb").worldFromIndex(), scaled);

    test::changed(volume)->worldFromIndex =
        glm::rotate(scaled, 0.3, glm::normalize(glm::dvec3(1, 2, 3)));
    test::changed(volume)->worldFromIndex[1].x += 0.2;  // and a shear
    write("out.vdb", volume);
    EXPECT_EQ(readVolume("out.vdb").worldFromIndex(), volume.worldFromIndex());

    test::changed(volume)->worldFromIndex =
        glm::scale(glm::dmat4(1), glm::dvec3(-1e-4, 3e-4, 1.0001e-4));
    write("out.vdb", volume);
    EXPECT_EQ(readVolume("out.vdb").worldFromIndex(), volume.worldFromIndex());

    test::changed(volume)->worldFromIndex = glm::scale(glm::dmat4(1), glm::dvec3(2e-15, 1, 1));
    expectError(ErrorCode::kFailed,
                "voxel size: got 2e-15,1,1 without a unit of length; expected a volume of at least "
                "3e-15, as OpenVDB's grids have it (.nrrd has no such limit)",
                [&] { write("out.vdb", volume); });
}

// What OpenVDB takes for flat is kept in a smaller unit, if there is one; a patient's space is in
// millimetres again when it is read.
TEST(WriteGrids, SmallVoxelsComeBack) {
    for (const auto& [space, unit, kept] :
         {std::tuple{"", "mm", "um"}, {"", "m", "mm"}, {"LPS", "mm", "mm"}}) {
        for (const double size : {1e-5, 1e-6}) {
            for (const bool deltas : {false, true}) {
                SCOPED_TRACE(std::string(space) + unit + std::to_string(size * 1e6));
                const TempFolder folder;
                Volume volume = rawVolume(pattern<float>(kDims, 0, 9), kDims, "float32",
                                          glm::dvec3(size), {3 * size, 0, 0});
                EXPECT_EQ(volume.voxelSize(), glm::dvec3(size));
                test::changed(volume)->space = space;
                test::changed(volume)->lengthUnit = unit;
                if (deltas) {
                    DeltaFile file;
                    file.add(volume, {});
                    file.write("out.vdb");
                } else {
                    write("out.vdb", volume);
                }
                const Volume back = readKept("out.vdb");
                EXPECT_EQ(back.lengthUnit(), kept);
                const double factor = millimetresIn(unit) / millimetresIn(kept);
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_NEAR(back.voxelSize()[axis], factor * size, 1e-12 * factor * size);
                EXPECT_NEAR(back.worldFromIndex()[3].x, factor * 3 * size, 1e-12 * factor * size);
            }
        }
    }
}

TEST(WriteGrids, TheSpaceComesBack) {
    const TempFolder folder;
    Volume volume = rawVolume(pattern<std::uint8_t>(kDims, 0, 9), kDims, "uint8");
    for (const char* const space : {"RAS", "LPS", ""}) {
        test::changed(volume)->space = space;
        write("out.vdb", volume);
        EXPECT_EQ(readVolume("out.vdb").space(), space);
    }
}

// Every detail that a grid can have; the file's own metadata too.
template <typename Grid>
typename Grid::Ptr detailedGrid(const std::string& name, typename Grid::ValueType odd) {
    using T = typename Grid::ValueType;
    auto grid = makeGrid<Grid>(
        name, [](int i) { return T(i % 50); }, T(3));
    grid->tree().setValueOff(Coord(1, 1, 1), odd);
    grid->tree().addTile(2, Coord(1024, 0, 0), odd, false);
    grid->tree().addTile(3, Coord(0, 8192, 0), T(1), true);
    grid->setGridClass(openvdb::GRID_STAGGERED);
    grid->setCreator("someone");
    const double rows[] = {0.1, 0.2, 0, 0, -0.2, 0.1, 0, 0, 0, 0.3, 0.5, 0, 1.1, -2.2, 3.3, 1};
    grid->setTransform(openvdb::math::Transform::createLinearTransform(openvdb::Mat4R(&rows[0])));
    grid->insertMeta("artist", openvdb::StringMetadata("a name"));
    grid->insertMeta("look", openvdb::Vec3SMetadata(openvdb::Vec3s(1, 2, 3)));
    return grid;
}

template <typename Grid>
void expectKept(typename Grid::ValueType odd) {
    const TempFolder folder;
    const auto grid = detailedGrid<Grid>("density", odd);
    openvdb::MetaMap fileMetadata;
    fileMetadata.insertMeta("scene", openvdb::Int32Metadata(12));
    openvdb::io::File("in.vdb").write({grid}, fileMetadata);
    const WriteReport report = write("out.vdb", readKept("in.vdb"));
    EXPECT_EQ(report.notes, std::vector<std::string>{});
    EXPECT_TRUE(report.lossless);
    const auto back = readGrid<Grid>("out.vdb");
    ASSERT_TRUE(back);
    expectSameGrid(*grid, *back);
    openvdb::io::File out("out.vdb");
    out.open();
    EXPECT_EQ(metadataOf(*out.getMetadata()), metadataOf(fileMetadata));
}

TEST(WriteGrids, AVdbKeepsEverything) {
    expectKept<openvdb::FloatGrid>(0.1F);
    expectKept<openvdb::FloatGrid>(std::nanf(""));
    expectKept<openvdb::DoubleGrid>(0.1);
    expectKept<openvdb::Int32Grid>(-2000000000);
    expectKept<openvdb::Int64Grid>((std::int64_t{1} << 62) + 1);
    expectKept<openvdb::BoolGrid>(false);
}

TEST(WriteGrids, AMaskKeepsEverything) {
    const TempFolder folder;
    openvdb::initialize();
    const auto mask = openvdb::MaskGrid::create(false);
    mask->setName("mask");
    mask->fill(openvdb::CoordBBox({-20, 3, 5}, {40, 9, 60}), true);
    openvdb::io::File("in.vdb").write({mask});
    write("out.vdb", readKept("in.vdb"));
    expectSameGrid(*mask, *readGrid<openvdb::MaskGrid>("out.vdb"));
}

// What keeps no source is made again from its codes.
template <typename Grid>
void expectRemade() {
    using T = typename Grid::ValueType;
    const TempFolder folder;
    const auto grid = makeGrid<Grid>(
        "density", [](int i) { return T(i % 50); }, T(3));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.3));
    openvdb::io::File("in.vdb").write({grid});
    write("out.vdb", readVolume("in.vdb"));
    const auto back = readGrid<Grid>("out.vdb");
    ASSERT_TRUE(back);
    EXPECT_EQ(back->background(), grid->background());
    EXPECT_EQ(back->transform(), grid->transform());
    EXPECT_FALSE(back->template getMetadata<openvdb::StringMetadata>("deltasplat_source_type"));
    EXPECT_TRUE(back->tree().hasSameTopology(grid->tree()));
    EXPECT_EQ(countDifferences(back->constTree(), grid->constTree()), 0u);
}

TEST(WriteGrids, CodesOfHalvesAreStoredAsHalves) {
    const TempFolder folder;
    const auto grid = makeGrid<openvdb::FloatGrid>(
        "density", [](int i) { return float(i % 50) / 4; }, 0.5F);
    grid->setSaveFloatAsHalf(true);
    openvdb::io::File("in.vdb").write({grid});
    const Volume volume = readVolume("in.vdb");
    ASSERT_EQ(volume.type(), "half");
    write("out.vdb", volume);
    const auto back = readGrid<openvdb::FloatGrid>("out.vdb");
    EXPECT_TRUE(back->saveFloatAsHalf());
    EXPECT_EQ(countDifferences(back->constTree(), grid->constTree()), 0u);
}

TEST(WriteGrids, CodesAloneMakeTheSameVoxels) {
    expectRemade<openvdb::FloatGrid>();
    expectRemade<openvdb::DoubleGrid>();
    expectRemade<openvdb::Int32Grid>();
    expectRemade<openvdb::Int64Grid>();
    expectRemade<openvdb::BoolGrid>();
}

TEST(WriteGrids, SeveralGridsInOneFile) {
    const TempFolder folder;
    writeGrids("in.vdb", {oneVoxel("a", 1), oneVoxel("b", 2), oneVoxel("a", 3)});
    ReadOptions options;
    options.keepSource = true;
    writeVolumes("out.vdb", readAllVolumes("in.vdb", options));
    const openvdb::GridPtrVec grids = readGrids("out.vdb");
    ASSERT_EQ(grids.size(), 3u);
    // OpenVDB hands them out by name.
    const char* const names[] = {"a", "a", "b"};
    const float values[] = {1, 3, 2};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(grids[i]->getName(), names[i]);
        const auto typed = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[i]);
        EXPECT_EQ(typed->tree().getValue(Coord(1, 2, 3)), values[i]);
    }
}

using Named = std::vector<std::pair<std::string, float>>;

// Names and values of one voxel each, by OpenVDB alone.
Named namedIn(const std::filesystem::path& file) {
    Named all;
    for (const openvdb::GridBase::Ptr& grid : readGrids(file)) {
        const auto typed = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
        all.emplace_back(grid->getName(), typed->tree().getValue(Coord(1, 2, 3)));
    }
    std::sort(all.begin(), all.end());
    return all;
}

// What `gridName` finds under each name that is listed, in file order.
std::vector<Volume> byName(const std::filesystem::path& file) {
    std::vector<Volume> volumes;
    for (const std::string& name : listGrids(file).scalar) {
        ReadOptions options;
        options.gridName = name;
        options.keepSource = true;
        volumes.push_back(readVolume(file, options));
        EXPECT_EQ(volumes.back().name(), name);
    }
    return volumes;
}

// Checks the names in a file, and those of what is converted, and restored from deltas.
void expectNames(const std::filesystem::path& file, const std::vector<std::string>& shown,
                 Named stored) {
    std::sort(stored.begin(), stored.end());
    DeltaFile deltas;
    const std::vector<Volume> volumes = byName(file);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        EXPECT_EQ(volumes[i].valueMax(), i + 1);
        deltas.add(volumes[i], {});
    }
    deltas.write("delta.vdb");
    writeVolumes("converted.vdb", volumes);
    writeVolumes("restored.vdb", byName("delta.vdb"));
    for (const auto& one : {file, {"delta.vdb"}, {"converted.vdb"}, {"restored.vdb"}})
        EXPECT_EQ(listGrids(one).scalar, shown) << one;
    for (const auto& one : {file, {"converted.vdb"}, {"restored.vdb"}})
        EXPECT_EQ(namedIn(one), stored) << one;
}

TEST(WriteGrids, NamesComeBack) {
    const TempFolder folder;
    const auto expectKept = [&](const std::vector<std::string>& names,
                                const std::vector<std::string>& shown) {
        openvdb::GridCPtrVec grids;
        Named stored;
        for (std::size_t i = 0; i < names.size(); ++i) {
            stored.emplace_back(names[i], float(i + 1));
            grids.push_back(oneVoxel(names[i], float(i + 1)));
        }
        writeGrids("in.vdb", grids);
        expectNames("in.vdb", shown, stored);
    };
    expectKept({""}, {""});
    expectKept({"density", "", "a/b"}, {"density", "", "a/b"});
    expectKept({"d", "x", "d"}, {"d[0]", "x", "d[1]"});
    expectKept({"", ""}, {"[0]", "[1]"});
    expectKept({"[0]", ""}, {"[0]", ""});
    expectKept({"[0]", "", ""}, {"[0]", "[1]", "[2]"});
    expectKept({"a", "a[0]", "a"}, {"a[1]", "a[0]", "a[2]"});
    expectKept({"a[12]", "a", "a[", "]"}, {"a[12]", "a", "a[", "]"});
}

// Some writers store it as it is.
TEST(WriteGrids, NamesThatNobodyNumberedComeBack) {
    const TempFolder folder;
    std::ofstream out("in.vdb", std::ios::binary);
    openvdb::io::Stream(out).write(
        {openvdb::GridCPtrVec{oneVoxel("density", 1), oneVoxel("", 2), oneVoxel("x", 3)}});
    out.close();
    std::string bytes = readBytes("in.vdb");
    const std::string numbered(
        "\2\0\0\0\x1e"
        "0",
        6);
    const std::size_t at = bytes.find(numbered);
    ASSERT_NE(at, std::string::npos);
    writeBytes("in.vdb", bytes.replace(at, numbered.size(), 4, '\0'));
    expectNames("in.vdb", {"density", "", "x"}, {{"density", 1}, {"", 2}, {"x", 3}});
}

TEST(WriteGrids, TheSameBytes) {
    const TempFolder folder;
    const Volume volume = rawVolume(pattern<std::uint8_t>(kDims, 0, 255), kDims, "uint8");
    write("a.vdb", volume);
    write("b.vdb", volume);
    EXPECT_EQ(readBytes("a.vdb"), readBytes("b.vdb"));
}

TEST(WriteGrids, AnInputMayBeTheOutput) {
    const TempFolder folder;
    writeGrids("a.vdb", {oneVoxel("a", 5)});
    write("a.vdb", readKept("a.vdb"));
    EXPECT_EQ(readGrid<openvdb::FloatGrid>("a.vdb")->tree().getValue(Coord(1, 2, 3)), 5);
}

TEST(WriteGrids, InterruptedItLeavesNothing) {
    const TempFolder folder;
    std::vector<Volume> volumes;
    volumes.push_back(rawVolume(pattern<std::uint8_t>(kDims, 0, 255), kDims, "uint8"));
    Listener listener;
    listener.progress = [](double share) {
        if (share > 0.5) throw Error(ErrorCode::kInterrupted, "interrupted");
    };
    expectError(ErrorCode::kInterrupted, "interrupted",
                [&] { writeVolumes("out.vdb", std::move(volumes), {}, listener); });
    std::filesystem::remove("source.raw");
    EXPECT_TRUE(std::filesystem::is_empty("."));
}

// Whole numbers that no double holds.
TEST(WriteGrids, IntegersOf64Bits) {
    const TempFolder folder;
    const std::int64_t base = std::int64_t{1} << 60;
    std::vector<std::int64_t> values;
    for (int i = 0; i < 24; ++i) values.push_back(base + 3 * i + 1);
    NiftiFile file;
    file.dataType = 1024;
    file.bits = 64;
    file.data = bytesOf(values);
    writeBytes("a.nii", file.bytes());
    const WriteReport report = write("a.vdb", readKept("a.nii"));
    EXPECT_TRUE(report.lossless);
    const auto grid = readGrid<openvdb::Int64Grid>("a.vdb");
    ASSERT_TRUE(grid);
    for (int i = 0; i < 24; ++i)
        EXPECT_EQ(grid->tree().getValue(Coord(i % 4, i / 4 % 3, i / 12)), values[std::size_t(i)]);
}

TEST(WriteGrids, UnsignedIntegersThatBecomeDoubles) {
    const TempFolder folder;
    std::vector<std::uint64_t> values(24, (std::uint64_t{1} << 63) + 1000);
    values[5] += 1023;
    NiftiFile file;
    file.dataType = 1280;
    file.bits = 64;
    file.data = bytesOf(values);
    writeBytes("a.nii", file.bytes());
    EXPECT_EQ(readKept("a.nii").readError(), 1000);  // doubles are 2048 apart there
}

}  // namespace
}  // namespace deltasplat::testing
