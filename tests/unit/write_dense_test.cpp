// SPDX-License-Identifier: Apache-2.0
// Volumes in formats without empty places: there and back by this project's readers.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/delta/delta_file.h"
#include "deltasplat/diff/compare_volumes.h"
#include "deltasplat/ingest/label_list.h"
#include "formats/readers.h"
#include "support/changed_volume.h"
#include "unit/convert_helpers.h"
#include "unit/format_helpers.h"
#include "unit/vdb_helpers.h"
#include "volume/placement.h"
#include "volume/tree_types.h"

namespace deltasplat::testing {
namespace {

using openvdb::Coord;
constexpr glm::ivec3 kDims(19, 17, 10);

// The formats whose files can be read back without being told what they are.
std::vector<std::string> formats() {
    return {".nii", ".nii.gz", ".nrrd", ".nhdr", ".mhd", ".mha"};
}

double valueAt(const Volume& volume, const glm::ivec3& place) {
    return volume.codeBook().valueOf(
        volume.codes()->tree().getValue(Coord(place.x, place.y, place.z)));
}

template <typename T>
void expectValues(const Volume& volume, const std::vector<T>& values, const glm::ivec3& dims) {
    ASSERT_EQ(volume.box().dims(), dims);
    EXPECT_EQ(volume.activeCount(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const glm::ivec3 place(int(i) % dims.x, int(i) / dims.x % dims.y, int(i) / dims.x / dims.y);
        ASSERT_EQ(valueAt(volume, place), double(values[i]));
    }
}

template <typename T>
void expectThereAndBack(const std::string& type, T low, T high) {
    const std::vector<T> values = pattern<T>(kDims, low, high);
    for (const std::string& extension : formats()) {
        SCOPED_TRACE(type + extension);
        const TempFolder folder;
        Volume volume = rawVolume(values, kDims, type, {0.5, 1.25, 2}, {-3, 4.5, 8});
        test::changed(volume)->space = "RAS";
        const WriteReport report = write("out" + extension, volume);
        EXPECT_EQ(report.notes, std::vector<std::string>{});
        EXPECT_TRUE(report.lossless);
        EXPECT_EQ(report.maxError, 0);
        const Volume back = readVolume("out" + extension);
        EXPECT_EQ(back.type(), type);
        expectValues(back, values, kDims);
    }
}

TEST(WriteDense, EveryTypeThereAndBack) {
    expectThereAndBack<std::uint8_t>("uint8", 0, 255);
    expectThereAndBack<std::int8_t>("int8", -128, 127);
    expectThereAndBack<std::uint16_t>("uint16", 0, 65535);
    expectThereAndBack<std::int16_t>("int16", -32768, 32767);
    expectThereAndBack<std::uint32_t>("uint32", 0, 4294967295U);
    expectThereAndBack<std::int32_t>("int32", -2147483647, 2147483647);
    expectThereAndBack<float>("float32", -0.1F, 1e30F);
    expectThereAndBack<double>("float64", -0.1, 1e300);
}

// Writes integers that no double holds, and compares them with what comes back.
// @param vdbError  how far what is in a .vdb is off
template <typename T>
void expectWholeNumbers(const std::string& type, const std::vector<T>& values, double vdbError) {
    const TempFolder folder;
    const std::string bytes = bytesOf(values);
    writeBytes("in.nrrd", "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: 5 1 1\n" +
                              "endian: little\nencoding: raw\n\n" + bytes);
    ReadOptions keep;
    keep.keepSource = true;
    for (const std::string extension : {".npy", ".nrrd", ".mha", ".nii"}) {
        SCOPED_TRACE(type + extension);
        Volume volume = readCompared("in.nrrd", keep, {});
        if (extension == ".nii") test::changed(volume)->space = "RAS";
        const WriteReport report = write("out" + extension, volume);
        EXPECT_EQ(report.notes, std::vector<std::string>{});
        EXPECT_TRUE(report.lossless);
        EXPECT_EQ(report.maxError, 0);
        const Volume back = readCompared("out" + extension, keep, {});
        EXPECT_EQ(back.type(), type);
        EXPECT_EQ(compareVolumes(volume, back).maxError, 0);
        if (extension == ".npy") {
            EXPECT_TRUE(readBytes("out.npy").ends_with(bytes));
        }
    }
    const WriteReport raw = write("out_5x1x1_float64.raw", readCompared("in.nrrd", keep, {}));
    EXPECT_EQ(raw.notes, std::vector<std::string>{"out_5x1x1_float64.raw: " + type +
                                                  " stored as float64, which is off by up to 1"});
    EXPECT_FALSE(raw.lossless);
    EXPECT_EQ(raw.maxError, 1);
    EXPECT_EQ(readBytes("out_5x1x1_float64.raw"),
              bytesOf(std::vector<double>(values.begin(), values.end())));

    // OpenVDB has no unsigned ones.
    Warnings warnings;
    const Volume volume = readVolume("in.nrrd", keep, warnings.listener());
    EXPECT_EQ(volume.readError(), vdbError);
    EXPECT_EQ(warnings.lines.size(), vdbError > 0 ? 1 : 0);
    const WriteReport vdb = write("out.vdb", volume);
    const bool isSaid = type == "uint64" && vdbError == 0;
    EXPECT_EQ(vdb.notes,
              isSaid ? std::vector<std::string>{"out.vdb: uint64 stored as int64, which holds "
                                                "every value"}
                     : std::vector<std::string>{});
    EXPECT_EQ(compareVolumes(readCompared("in.nrrd", keep, {}), readKept("out.vdb")).maxError,
              vdbError);
}

TEST(WriteDense, IntegersBeyondDoubles) {
    constexpr std::int64_t kOdd = (std::int64_t{1} << 53) + 1;
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    expectWholeNumbers<std::int64_t>("int64", {0, kOdd, -kOdd, kMost, -kMost - 1}, 0);
    expectWholeNumbers<std::uint64_t>("uint64", {0, kOdd, kOdd + 2, 7, kMost}, 0);
    expectWholeNumbers<std::uint64_t>(
        "uint64", {0, kOdd, std::uint64_t(kMost) + 1, ~std::uint64_t{0}, kMost}, 1);
}

TEST(WriteDense, RawBytesComeBack) {
    const TempFolder folder;
    const std::vector<std::uint16_t> values = pattern<std::uint16_t>(kDims, 0, 65535);
    for (const char* const file : {"out_19x17x10_uint16.raw", "out_19x17x10_uint16.raw.gz"}) {
        const WriteReport report = write(file, rawVolume(values, kDims, "uint16"));
        EXPECT_EQ(report.notes, std::vector<std::string>{});
        expectValues(readVolume(file), values, kDims);
    }
    EXPECT_EQ(readBytes("out_19x17x10_uint16.raw"), bytesOf(values));
}

// A volume that is turned, and has its axes mirrored or not.
glm::dmat4 turned(bool mirrored) {
    glm::dmat4 matrix = glm::translate(glm::dmat4(1), glm::dvec3(-31.5, 7.25, 100.125));
    matrix = glm::rotate(matrix, 0.4, glm::normalize(glm::dvec3(3, -1, 2)));
    return glm::scale(matrix, glm::dvec3(0.75, 1.5, mirrored ? -2.0 : 2.0));
}

double farthest(const glm::dmat4& a, const glm::dmat4& b) {
    double most = 0;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            most = std::max(most, std::abs(a[column][row] - b[column][row]));
        }
    }
    return most;
}

// The same place in the other of the two spaces.
glm::dmat4 otherSpace(const glm::dmat4& matrix) {
    return glm::scale(glm::dmat4(1), glm::dvec3(-1, -1, 1)) * matrix;
}

void expectPlaced(const glm::dmat4& matrix, const std::string& space) {
    for (const std::string& extension : formats()) {
        SCOPED_TRACE(space + extension);
        const TempFolder folder;
        Volume volume = rawVolume(pattern<std::uint8_t>(kDims, 0, 9), kDims, "uint8");
        test::changed(volume)->worldFromIndex = matrix;
        test::changed(volume)->space = space;
        write("out" + extension, volume);
        const Volume back = readVolume("out" + extension);
        const bool nifti = extension.rfind(".nii", 0) == 0;
        const bool nrrd = extension == ".nrrd" || extension == ".nhdr";
        const std::string native = nifti ? "RAS" : nrrd ? space : "LPS";
        EXPECT_EQ(back.space(), space.empty() && !nifti ? "" : native);
        const bool turns = !space.empty() && native != space;
        EXPECT_LT(farthest(back.worldFromIndex(), turns ? otherSpace(matrix) : matrix),
                  nifti ? 1e-5 : 1e-13);
    }
}

TEST(WriteDense, PlacesComeBack) {
    for (const char* const space : {"RAS", "LPS", ""}) {
        expectPlaced(turned(false), space);
        expectPlaced(turned(true), space);
        expectPlaced(glm::scale(glm::dmat4(1), glm::dvec3(1, -1, 0.5)), space);
    }
}

TEST(WriteDense, ShearsComeBack) {
    glm::dmat4 sheared = turned(false);
    sheared[1] += 0.25 * sheared[0];
    expectPlaced(sheared, "LPS");
    const TempFolder folder;
    Volume volume = rawVolume(pattern<std::uint8_t>(kDims, 0, 9), kDims, "uint8");
    test::changed(volume)->worldFromIndex = sheared;
    test::changed(volume)->space = "LPS";
    const WriteReport report = write("out.mha", volume);
    EXPECT_FALSE(report.lossless);
    EXPECT_EQ(report.notes, std::vector<std::string>{
                                "out.mha: axes that are not at right angles: MetaImage has only "
                                "rotations, and programs that rely on it misplace the voxels"});
    EXPECT_TRUE(write("out.nrrd", volume).lossless);
}

// From format to format and back, the affine map stays what it is to the last bit.
TEST(WriteDense, ChainsOfFormatsKeepTheAffine) {
    const TempFolder folder;
    Volume volume = rawVolume(pattern<std::uint8_t>(kDims, 0, 9), kDims, "uint8");
    test::changed(volume)->worldFromIndex =
        glm::dmat4(glm::mat4(turned(true)));  // what NIfTI's floats hold
    test::changed(volume)->space = "RAS";
    std::string file = "a.nii";
    EXPECT_TRUE(write(file, volume).lossless);
    int step = 0;
    for (const std::string extension :
         {".vdb", ".nii.gz", ".nrrd", ".nii", ".mha", ".vdb", ".nii"}) {
        const std::string next = "step" + std::to_string(step++) + extension;
        write(next, readKept(file));
        file = next;
        if (extension.rfind(".nii", 0) != 0) continue;
        SCOPED_TRACE(next);
        EXPECT_EQ(readVolume(next).worldFromIndex(), volume.worldFromIndex());
    }
}

// Returns where a voxel lies, in millimetres left, back and up of the patient or, where there was
// none, in its own space, which NIfTI calls RAS.
glm::dvec3 placeOf(const Volume& volume, const glm::ivec3& voxel, bool patient) {
    const glm::dvec3 place(volume.worldFromIndex() * glm::dvec4(voxel, 1));
    const double unit = volume.lengthUnit().empty() ? 1 : millimetresIn(volume.lengthUnit());
    return unit *
           (patient && volume.space() == "RAS" ? glm::dvec3(-place.x, -place.y, place.z) : place);
}

// Wherever a volume goes, its voxels stay where they are in the world, and lengths whose unit is
// known stay known.
TEST(WriteDense, UnitsComeBack) {
    const TempFolder folder;
    const std::vector<std::uint8_t> values = pattern<std::uint8_t>(kDims, 0, 9);
    for (const std::string space : {"", "RAS", "LPS"}) {
        for (const std::string unit : {"", "mm", "um", "nm", "m", "in"}) {
            if (!space.empty() && !unit.empty() && unit != "mm") continue;
            Volume volume = rawVolume(values, kDims, "uint8", {0.5, 1.25, 2}, {-3, 4.5, 8});
            test::changed(volume)->space = space;
            test::changed(volume)->lengthUnit = unit;
            for (const std::string extension : {".vdb", ".nii", ".nrrd", ".nhdr", ".mhd", ".mha"}) {
                SCOPED_TRACE(space + " " + unit + " " + extension);
                write("a" + extension, volume);
                // Through a grid, and its delta grids.
                write("b.vdb", readKept("a" + extension));
                DeltaFile deltas;
                deltas.add(readKept("b.vdb"), {});
                deltas.write("c.vdb");
                write("d" + extension, readKept("c.vdb"));
                for (const std::string& file : {"a" + extension, std::string("b.vdb"),
                                                std::string("c.vdb"), "d" + extension}) {
                    const Volume back = readVolume(file);
                    EXPECT_EQ(back.lengthUnit().empty(), unit.empty()) << file;
                    if (extension == ".vdb") {
                        EXPECT_EQ(back.lengthUnit(), unit);
                    }
                    for (const glm::ivec3 voxel : {glm::ivec3(0), glm::ivec3(18, 16, 9)}) {
                        const bool patient = !space.empty();
                        const glm::dvec3 place = placeOf(back, voxel, patient);
                        const glm::dvec3 was = placeOf(volume, voxel, patient);
                        const double size = glm::length(was);
                        for (int axis = 0; axis < 3; ++axis)
                            EXPECT_NEAR(place[axis], was[axis], 1e-6 * size) << file;
                    }
                }
            }
        }
    }
}

// Names and colours of labels survive wherever a format has a place for them, and that values are
// labels in all that have a header for it.
TEST(WriteDense, LabelsComeBack) {
    const TempFolder folder;
    const std::vector<std::uint8_t> values = pattern<std::uint8_t>(kDims, 0, 9);
    const std::vector<LabelEntry> named{{3, "liver, left lobe", glm::dvec3(0.5, 0.25, 1)},
                                        {9, "bone \\n", {}}};
    for (const std::vector<LabelEntry>& entries : {named, std::vector<LabelEntry>()}) {
        Volume volume = rawVolume(values, kDims, "uint8");
        test::changed(volume)->space = "LPS";
        test::changed(volume)->labels = std::make_shared<const LabelList>(LabelList{entries});
        for (const std::string extension : {".vdb", ".nrrd", ".nii", ".mha"}) {
            SCOPED_TRACE(extension);
            const bool holdsNames = extension == ".vdb" || extension == ".nrrd";
            const WriteReport report = write("a" + extension, volume);
            EXPECT_EQ(report.lossless, holdsNames || entries.empty());
            write("b.vdb", readKept("a" + extension));
            DeltaFile deltas;
            deltas.add(readKept("b.vdb"), {});
            deltas.write("c.vdb");
            write("d.seg.nrrd", readKept("c.vdb"));
            for (const std::string& file : {"a" + extension, std::string("b.vdb"),
                                            std::string("c.vdb"), std::string("d.seg.nrrd")}) {
                const Volume back = readVolume(file);
                ASSERT_TRUE(back.labels()) << file;
                EXPECT_EQ(back.labels()->entries, holdsNames ? entries : std::vector<LabelEntry>())
                    << file;
            }
        }
    }
    Volume volume = rawVolume(values, kDims, "uint8");
    test::changed(volume)->labels = std::make_shared<const LabelList>(LabelList{named});
    EXPECT_EQ(write("out.nii", volume).notes.back(),
              "out.nii: names and colours of labels are left out: NIfTI has no place for them "
              "(.vdb and .seg.nrrd have)");
    EXPECT_EQ(write("out.npy", volume).notes.back(),
              "out.npy: names and colours of labels, and that values are labels are left out: "
              "NumPy's format has no place for them (.vdb and .seg.nrrd have)");
}

openvdb::FloatGrid::Ptr sparseGrid(float background) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(background);
    grid->setName("density");
    grid->tree().setValueOn(Coord(-11, -3, 5), 0.1F);
    grid->tree().setValueOn(Coord(20, 9, 17), 0.7F);
    grid->tree().setValueOff(Coord(-10, -3, 5), -4);
    grid->tree().addTile(1, Coord(0, 0, 8), 0.3F, true);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    return grid;
}

TEST(WriteDense, AGridBecomesItsActiveBox) {
    const TempFolder folder;
    const auto grid = sparseGrid(2.5F);
    writeGrids("in.vdb", {grid});
    const WriteReport report = write("out.raw", readKept("in.vdb"));
    EXPECT_FALSE(report.lossless);
    const std::vector<std::string> notes = {
        "out.raw: no header; read it with `dims` 32x13x13 `type` float32 `bigEndian=false` "
        "`spacing` 0.25,0.25,0.25 `origin` -2.75,-0.75,1.25",
        "out.raw: 4894 inactive voxels become voxels like the others, with the value they hold "
        "(background 2.5)",
        "out.raw: the grid's name \"density\", class \"unknown\" and other metadata are left out"};
    EXPECT_EQ(report.notes, notes);
    std::vector<float> expected;
    for (int z = 5; z <= 17; ++z) {
        for (int y = -3; y <= 9; ++y) {
            for (int x = -11; x <= 20; ++x) {
                expected.push_back(grid->tree().getValue(Coord(x, y, z)));
            }
        }
    }
    EXPECT_EQ(readBytes("out.raw"), bytesOf(expected));
    // Codes alone know no inactive values but the background.
    write("codes.raw", readVolume("in.vdb"));
    expected[1] = 2.5F;
    EXPECT_EQ(readBytes("codes.raw"), bytesOf(expected));
}

TEST(WriteDense, InactiveValuesThatAreNoNumbers) {
    const TempFolder folder;
    const auto grid = oneVoxel("a", 1);
    grid->tree().setValueOn(Coord(3, 2, 3), 2);
    grid->tree().setValueOff(Coord(2, 2, 3), std::nanf(""));
    writeGrids("in.vdb", {grid});
    write("out.raw", readKept("in.vdb"));
    EXPECT_EQ(readBytes("out.raw"), bytesOf(std::vector<float>{1, 0, 2}));
}

template <typename Grid>
void expectTypeOfGrid(typename Grid::ValueType value, const std::string& file,
                      const std::string& type, const std::string& note, double maxError = 0) {
    SCOPED_TRACE(file + " " + type);
    const TempFolder folder;
    openvdb::initialize();
    const auto grid = Grid::create();
    grid->setName("a");
    grid->tree().setValueOn(Coord(0), value);
    writeGrids("in.vdb", {grid});
    const WriteReport report = write(file, readKept("in.vdb"));
    EXPECT_EQ(report.maxError, maxError);
    EXPECT_EQ(report.notes.size(), note.empty() ? 1u : 2u);
    if (!note.empty()) {
        EXPECT_EQ(report.notes[0], file + ": " + note);
    }
    const Volume back = readVolume(file);
    EXPECT_EQ(back.type(), type);
    EXPECT_NEAR(back.valueMax(), double(value), maxError);
}

TEST(WriteDense, TypesOfGrids) {
    const std::string raw = "o_1x1x1_";
    expectTypeOfGrid<openvdb::FloatGrid>(0.1F, raw + "float32.raw", "float32", "");
    expectTypeOfGrid<openvdb::DoubleGrid>(0.1, raw + "float64.raw", "float64", "");
    expectTypeOfGrid<openvdb::Int32Grid>(-7, raw + "int32.raw", "int32", "");
    expectTypeOfGrid<openvdb::Int64Grid>(-7, raw + "int32.raw", "int32",
                                         "int64 stored as int32, which holds every value");
    expectTypeOfGrid<openvdb::Int64Grid>(std::int64_t{1} << 33, raw + "float32.raw", "float32",
                                         "int64 stored as float32, which holds every value");
    expectTypeOfGrid<openvdb::Int64Grid>((std::int64_t{1} << 40) + 1, raw + "float64.raw",
                                         "float64",
                                         "int64 stored as float64, which holds every value");
    expectTypeOfGrid<openvdb::Int64Grid>((std::int64_t{1} << 60) + 100, raw + "float64.raw",
                                         "float64",
                                         "int64 stored as float64, which is off by up to 100", 100);
    expectTypeOfGrid<openvdb::BoolGrid>(true, raw + "uint8.raw", "uint8",
                                        "bool stored as uint8, which holds every value");
    expectTypeOfGrid<openvdb::MaskGrid>(true, raw + "uint8.raw", "uint8",
                                        "mask stored as uint8, which holds every value");
}

TEST(WriteDense, ThroughAVdbTypesComeBack) {
    const TempFolder folder;
    const std::vector<std::int16_t> values = pattern<std::int16_t>(kDims, -1000, 3071);
    write("mid.vdb", rawVolume(values, kDims, "int16"));
    Volume volume = readKept("mid.vdb");
    EXPECT_EQ(volume.type(), "float");
    const WriteReport report = write("out_19x17x10_int16.raw", volume);
    EXPECT_EQ(report.notes, std::vector<std::string>{});
    EXPECT_TRUE(report.lossless);
    EXPECT_EQ(readBytes("out_19x17x10_int16.raw"), bytesOf(values));

    // A value that the type cannot hold was not there before: the type is the grid's own.
    const auto grid = readGrid<openvdb::FloatGrid>("mid.vdb");
    grid->tree().setValueOn(Coord(1, 1, 1), 0.5F);
    writeGrids("mid.vdb", {grid});
    EXPECT_EQ(write("o_19x17x10_float32.raw", readKept("mid.vdb")).notes[0],
              "o_19x17x10_float32.raw: int16 stored as float32, which holds every value");
}

TEST(WriteDense, ABoxInMetadataIsNotTrusted) {
    const TempFolder folder;
    const auto write1 = [&](const openvdb::Vec3i& min, const openvdb::Vec3i& max) {
        const auto grid = oneVoxel("a", 5);
        grid->insertMeta("deltasplat_box_min", openvdb::Vec3IMetadata(min));
        grid->insertMeta("deltasplat_box_max", openvdb::Vec3IMetadata(max));
        writeGrids("in.vdb", {grid});
        write("out.raw", readKept("in.vdb"));
        return readBytes("out.raw").size() / sizeof(float);
    };
    constexpr int kMost = std::numeric_limits<int>::max();
    EXPECT_EQ(write1({0, 0, 0}, {1, 2, 3}), 2u * 3 * 4);
    EXPECT_EQ(write1({0, 0, 0}, {1, 2, 2}), 1u);
    EXPECT_EQ(write1({2, 0, 0}, {1, 2, 3}), 1u);
    EXPECT_EQ(write1({-kMost, -kMost, -kMost}, {kMost, kMost, kMost}), 1u);
}

TEST(WriteDense, WhatCannotBeWritten) {
    const TempFolder folder;
    openvdb::initialize();
    const auto empty = openvdb::FloatGrid::create();
    empty->setName("nothing");
    writeGrids("in.vdb", {empty});
    expectError(ErrorCode::kInput,
                "out.nrrd: got \"nothing\", which has no active voxels; expected a volume with a "
                "bounding box (.vdb holds empty ones)",
                [] { write("out.nrrd", readKept("in.vdb")); });
    std::vector<std::uint8_t> row(40000, 1);
    const Volume lengthy = rawVolume(row, {40000, 1, 1}, "uint8");
    expectError(ErrorCode::kFailed,
                "out.nii: got 40000x1x1 voxels; expected at most 32767 along each axis in NIfTI "
                "(.nrrd has no such limit)",
                [&] { write("out.nii", lengthy); });
    expectError(
        ErrorCode::kUsage,
        "out.txt: got extension \".txt\"; expected .vdb, .raw, .raw.gz, .npy, .nrrd, .nhdr, "
        ".mhd, .mha, .nii or .nii.gz",
        [&] { write("out.txt", lengthy); });
    expectError(ErrorCode::kUsage, "out.nrrd: got 2 volumes; expected one, except in a .vdb", [&] {
        writeVolumes("out.nrrd", {lengthy, lengthy});
    });
    expectError(ErrorCode::kUsage,
                "a%d.raw: got a name with \"%\" or control characters; expected one that a header "
                "can hold",
                [&] { checkVolumeFile("a%d.mhd"); });
    expectError(ErrorCode::kOutput, "no/out.nrrd: cannot be written: there is no folder no",
                [&] { checkVolumeFile("no/out.nrrd"); });
    EXPECT_FALSE(std::filesystem::exists("out.nrrd"));
}

TEST(WriteDense, InterruptedItLeavesNothing) {
    for (const char* const file : {"out.nrrd", "out.nhdr", "out.mhd", "out.nii.gz", "out.raw"}) {
        const TempFolder folder;
        std::vector<Volume> volumes;
        volumes.push_back(rawVolume(pattern<std::uint8_t>(kDims, 0, 255), kDims, "uint8"));
        std::filesystem::remove("source.raw");
        Listener listener;
        listener.progress = [](double) { throw Error(ErrorCode::kInterrupted, "interrupted"); };
        expectError(ErrorCode::kInterrupted, "interrupted",
                    [&] { writeVolumes(file, std::move(volumes), {}, listener); });
        EXPECT_TRUE(std::filesystem::is_empty("."));
    }
}

TEST(WriteDense, FilesOfHeadersAndData) {
    const TempFolder folder;
    EXPECT_EQ(dataFileOf("a/b.mhd"), "a/b.raw");
    EXPECT_EQ(dataFileOf("b.c.NHDR"), "b.c.raw.gz");
    EXPECT_EQ(dataFileOf("b.mha"), "");
    EXPECT_EQ(dataFileOf("b.vdb"), "");
    const std::vector<std::uint8_t> values = pattern<std::uint8_t>(kDims, 0, 255);
    const WriteReport report = write("out.mhd", rawVolume(values, kDims, "uint8"));
    const std::vector<std::filesystem::path> files = {"out.mhd", "out.raw"};
    EXPECT_EQ(report.files, files);
    EXPECT_EQ(readBytes("out.raw"), bytesOf(values));
}

}  // namespace
}  // namespace deltasplat::testing
