// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/points/PointDataGrid.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "deltasplat/ingest/read_volume.h"
#include "unit/ingest_helpers.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::expectError;
using testing::readBytes;
using testing::TempFolder;
using testing::writeBytes;

constexpr const char* kScalar = "a scalar grid (float, double, half, int32, int64, bool or mask)";

void expectInput(const std::string& message, const std::string& file,
                 const ReadOptions& options = {}) {
    expectError(ErrorCode::kInput, message, [&] { readVolume(file, options); });
    expectError(ErrorCode::kInput, message, [&] { readAllVolumes(file, options); });
}

void writeGrids(const std::string& file, const openvdb::GridCPtrVec& grids) {
    openvdb::io::File(file).write(grids);
}

template <typename Grid>
typename Grid::Ptr namedGrid(const std::string& name) {
    openvdb::initialize();
    auto grid = Grid::create();
    grid->setName(name);
    return grid;
}

openvdb::FloatGrid::Ptr noise(const std::string& name, int size) {
    auto grid = namedGrid<openvdb::FloatGrid>(name);
    for (int i = 0; i < size * size * size; ++i) {
        const Coord place(i % size, i / size % size, i / size / size);
        grid->tree().setValue(place, float(i * 7919 % 1000));
    }
    return grid;
}

TEST(ReadVdbError, NoGrids) {
    const TempFolder folder;
    openvdb::initialize();
    writeGrids("a.vdb", {});
    expectInput(std::string("a.vdb: got no grids; expected ") + kScalar, "a.vdb");
    ReadOptions options;
    options.gridName = "density";
    expectInput("a.vdb: got no grid \"density\"; expected a file with grids", "a.vdb", options);
}

TEST(ReadVdbError, NoScalarGrid) {
    const TempFolder folder;
    writeGrids("a.vdb", {namedGrid<openvdb::Vec3SGrid>("v"),
                         namedGrid<openvdb::points::PointDataGrid>("p")});
    expectInput(std::string("a.vdb: got only v (vec3s), p (ptdataidx32); expected ") + kScalar,
                "a.vdb");
}

TEST(ReadVdbError, NoSuchGrid) {
    const TempFolder folder;
    auto half = noise("h", 2);
    half->setSaveFloatAsHalf(true);
    writeGrids("a.vdb", {half, namedGrid<openvdb::Vec3SGrid>("v")});
    ReadOptions options;
    options.gridName = "density";
    expectInput("a.vdb: got no grid \"density\"; expected one of h (half), v (vec3s)", "a.vdb",
                options);
    options.gridName = "v";
    expectInput(std::string("a.vdb: got grid \"v\" of type vec3s; expected ") + kScalar +
                    ", or a part of it such as v.x",
                "a.vdb", options);
}

// A program's own grid type that OpenVDB has never heard of does not make the rest unreadable.
TEST(ReadVdbError, UnknownTypesDoNoHarm) {
    const TempFolder folder;
    writeGrids("a.vdb", {namedGrid<openvdb::Vec3SGrid>("v"), noise("d", 3)});
    std::string bytes = readBytes("a.vdb");
    bytes.replace(bytes.find("Tree_vec3s"), 10, "Tree_weird");
    writeBytes("a.vdb", bytes);
    EXPECT_EQ(readVolume("a.vdb").name(), "d");
    ReadOptions options;
    options.gridName = "v";
    expectInput(std::string("a.vdb: got grid \"v\" of type weird; expected ") + kScalar, "a.vdb",
                options);
}

TEST(ReadVdbError, NamesStayOnOneLine) {
    const TempFolder folder;
    writeGrids("a.vdb", {namedGrid<openvdb::Vec3SGrid>("two\nlines\x7f")});
    expectInput(std::string("a.vdb: got only two?lines? (vec3s); expected ") + kScalar, "a.vdb");
}

TEST(ReadVdbError, Frustum) {
    const TempFolder folder;
    auto grid = noise("g", 2);
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(10)), 0.5, 10));
    writeGrids("a.vdb", {grid});
    expectInput(
        "a.vdb: grid \"g\": got a NonlinearFrustumMap transform; expected a linear one (no "
        "frustum)",
        "a.vdb");
}

TEST(ReadVdbError, NonFiniteValues) {
    const TempFolder folder;
    auto grid = noise("g", 20);
    grid->tree().setValue(Coord(15, 3, 4), std::nanf(""));
    grid->tree().setValue(Coord(1, 9, 4), INFINITY);
    grid->tree().setValue(Coord(0, 0, 7), -INFINITY);
    writeGrids("a.vdb", {grid});
    expectInput(
        "a.vdb: grid \"g\": got 3 NaN or infinite active values, the first at (15, 3, 4); "
        "expected finite values (`nanValue` VALUE replaces them)",
        "a.vdb");
    grid->tree().addTile(1, Coord(-8, -16, -24), std::nanf(""), true);
    writeGrids("a.vdb", {grid});
    expectInput(
        "a.vdb: grid \"g\": got 515 NaN or infinite active values, the first at (-8, -16, -24); "
        "expected finite values (`nanValue` VALUE replaces them)",
        "a.vdb");
}

TEST(ReadVdbError, TooFarApart) {
    const TempFolder folder;
    auto grid = namedGrid<openvdb::FloatGrid>("g");
    grid->tree().setValue(Coord(0), 1);
    grid->tree().setValue(Coord(1 << 30, 0, 0), 1);
    writeGrids("a.vdb", {grid});
    expectInput(
        "a.vdb: grid \"g\": got active voxels spread over 1073741825 places; expected indices "
        "within 2^30 of 0",
        "a.vdb");
}

TEST(ReadVdbError, Garbage) {
    const TempFolder folder;
    for (const std::string& bytes :
         {std::string(), std::string("x"), std::string(10000, 'x'), std::string(10000, '\0')}) {
        writeBytes("a.vdb", bytes);
        expectInput("a.vdb: got no OpenVDB data; expected a .vdb file", "a.vdb");
    }
}

TEST(ReadVdbError, OtherVersions) {
    const TempFolder folder;
    writeGrids("a.vdb", {noise("g", 2)});
    std::string bytes = readBytes("a.vdb");
    for (const int version : {221, 226}) {
        bytes[8] = char(version);
        writeBytes("a.vdb", bytes);
        expectInput(
            "a.vdb: got OpenVDB file version " + std::to_string(version) + "; expected 222..225",
            "a.vdb");
    }
}

// Cut anywhere, the file is refused with a line that says so.
void expectRefusedWhereverCut(const std::string& whole) {
    for (std::size_t size = 8; size < whole.size(); size += 1 + size / 50) {
        writeBytes("a.vdb", whole.substr(0, size));
        try {
            readVolume("a.vdb");
            FAIL() << size << " of " << whole.size();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kInput);
            const std::string line = error.what();
            const std::string start =
                "a.vdb: got " + std::to_string(size) + " bytes; expected at least";
            const bool inTransform = line.find("got data that ends too early") != line.npos;
            EXPECT_TRUE(line.rfind(start, 0) == 0 || inTransform) << line;
        }
    }
}

TEST(ReadVdbError, CutShortAnywhere) {
    const TempFolder folder;
    writeGrids("whole.vdb", {noise("g", 20), noise("h", 4)});
    expectRefusedWhereverCut(readBytes("whole.vdb"));
}

// A stream's grids have no offsets that would tell.
TEST(ReadVdbError, StreamCutShortAnywhere) {
    const TempFolder folder;
    {
        std::ofstream out("whole.vdb", std::ios::binary);
        openvdb::io::Stream(out).write(openvdb::GridCPtrVec{noise("g", 20)});
    }
    ASSERT_NO_THROW(readVolume("whole.vdb"));
    expectRefusedWhereverCut(readBytes("whole.vdb"));
}

// Writes one leaf of noise, the last thing in the file, and returns where its data starts: eight
// bytes of size, then that many bytes.
std::size_t writeOneLeaf(std::uint32_t compression, std::string& bytes) {
    openvdb::io::File file("a.vdb");
    file.setCompression(compression);
    file.write(openvdb::GridCPtrVec{noise("g", 8)});
    bytes = readBytes("a.vdb");
    for (std::size_t at = bytes.size() - 24; at > 0; --at) {
        std::int64_t size = 0;
        std::memcpy(&size, bytes.data() + at, 8);
        if (size > 16 && at + 8 + std::size_t(size) == bytes.size()) return at;
    }
    ADD_FAILURE() << "no leaf found";
    return 0;
}

void poke(std::string& bytes, std::size_t at, std::int64_t value, std::size_t width) {
    std::memcpy(bytes.data() + at, &value, width);
    writeBytes("a.vdb", bytes);
}

// Blosc's decoder trusts the sizes that a chunk's own header states.
TEST(ReadVdbError, BloscDataOfAnotherSize) {
    const TempFolder folder;
    const std::string message =
        "a.vdb: got a compressed node of another size; expected a sound OpenVDB tree";
    std::string bytes;
    const std::size_t leaf = writeOneLeaf(openvdb::io::COMPRESS_BLOSC, bytes);
    const std::string whole = bytes;
    poke(bytes, leaf + 8 + 12, 100000, 4);
    expectInput(message, "a.vdb");
    bytes = whole;
    poke(bytes, leaf + 8 + 4, 4096, 4);
    expectInput(message, "a.vdb");
}

// OpenVDB 10 copies data stored as it is without asking how much there is room for.
TEST(ReadVdbError, PlainDataOfAnotherSize) {
    const TempFolder folder;
    for (const auto compression : {openvdb::io::COMPRESS_BLOSC, openvdb::io::COMPRESS_ZIP}) {
        std::string bytes;
        const std::size_t leaf = writeOneLeaf(compression, bytes);
        poke(bytes, leaf, -100, 8);
        expectInput(
            "a.vdb: got a node of -100 bytes instead of -2048; expected a sound OpenVDB tree",
            "a.vdb");
        poke(bytes, leaf, std::numeric_limits<std::int64_t>::min(), 8);
        expectInput(
            "a.vdb: got a node of -9223372036854775808 bytes instead of -2048; expected a "
            "sound OpenVDB tree",
            "a.vdb");
    }
}

// The second mask of the upper node says what is an active tile, the first what is a child.
TEST(ReadVdbError, TileAndChildAtOnce) {
    const TempFolder folder;
    std::string bytes;
    writeOneLeaf(openvdb::io::COMPRESS_ZIP, bytes);
    // The child mask's only bit is its first one: 4096 bytes that begin with 1.
    const std::string mask = '\1' + std::string(4095, '\0');
    const std::size_t at = bytes.find(mask);
    ASSERT_NE(at, std::string::npos);
    poke(bytes, at + 4096, 1, 1);
    expectInput("a.vdb: got a node that is both tile and child; expected a sound OpenVDB tree",
                "a.vdb");
    poke(bytes, at + 4096, 0, 1);
    poke(bytes, at - 12, 8, 4);
    expectInput("a.vdb: got a misplaced root node; expected a sound OpenVDB tree", "a.vdb");
}

// Writes a.vdb with a map, one number of which is another wherever it stands.
void writeWithMap(openvdb::math::MapBase::Ptr map, double before, double after) {
    const auto grid = noise("g", 20);
    grid->setTransform(std::make_shared<openvdb::math::Transform>(std::move(map)));
    writeGrids("a.vdb", {grid});
    std::string bytes = readBytes("a.vdb");
    const std::string pattern(reinterpret_cast<const char*>(&before), sizeof before);
    int found = 0;
    for (std::size_t at = 0; (at = bytes.find(pattern, at)) != std::string::npos; ++found)
        std::memcpy(bytes.data() + at, &after, sizeof after);
    ASSERT_GT(found, 0);
    writeBytes("a.vdb", bytes);
}

// OpenVDB makes no such transforms, but reads them.
TEST(ReadVdbError, VoxelsOfAlmostNoVolume) {
    const TempFolder folder;
    writeWithMap(std::make_shared<openvdb::math::ScaleMap>(openvdb::Vec3d(0.3125)), 0.3125, 1e-7);
    expectInput(
        "a.vdb: grid \"g\": got a transform that cannot be inverted; expected a finite affine map",
        "a.vdb");
}

TEST(ReadVdbError, Projections) {
    const TempFolder folder;
    openvdb::Mat4d turned = openvdb::Mat4d::identity();
    turned[0][0] = 0.5;
    turned[0][1] = turned[2][2] = 0.25;
    turned[1][1] = 0.75;
    writeWithMap(std::make_shared<openvdb::math::AffineMap>(turned), 1, 3);
    expectInput(
        "a.vdb: grid \"g\": got a transform that is a projection; expected a finite affine map",
        "a.vdb");
}

TEST(ReadVdbError, TheListenerStopsTheWork) {
    const TempFolder folder;
    writeGrids("a.vdb", {noise("g", 20)});
    Listener listener;
    listener.progress = [](double) { throw Error(ErrorCode::kInterrupted, "stopped"); };
    expectError(ErrorCode::kInterrupted, "stopped", [&] { readVolume("a.vdb", {}, listener); });
}

}  // namespace
}  // namespace deltasplat
