// SPDX-License-Identifier: Apache-2.0
// Damaged delta grids: each is refused with one line that says what is wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/text.h"
#include "deltasplat/delta/delta_file.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/memory_limit.h"
#include "formats/delta/delta_format.h"
#include "unit/ingest_helpers.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::expectError;
using testing::TempFolder;

using Damage = std::function<void(openvdb::Int32Grid&)>;

// Reads NAME.raw, writes its delta grid of voxels, and that damaged as a.vdb.
void writeDamaged(const std::string& name, DeltaFileOptions options, const Damage& damage) {
    options.pack = false;
    ReadOptions reading;
    reading.keepSource = true;
    DeltaFile file;
    file.add(readVolume(name + ".raw", reading), options);
    file.write("whole.vdb");
    EXPECT_NO_THROW(readVolume("whole.vdb"));
    openvdb::initialize();
    openvdb::io::File input("whole.vdb");
    input.open();
    const auto grid = openvdb::gridPtrCast<openvdb::Int32Grid>(input.readGrid(name));
    damage(*grid);
    openvdb::io::File("a.vdb").write({grid});
}

// Of a 20 x 9 x 12 volume of bytes, sliced along z.
void writeDamagedBytes(const Damage& damage) {
    std::string voxels(20 * 9 * 12, '\0');
    for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = char(i % 7 == 0 ? i % 250 : 0);
    testing::writeBytes("a_20x9x12_uint8.raw", voxels);
    DeltaFileOptions options;
    options.sliceAxis = 2;
    options.keyInterval = 8;
    writeDamaged("a_20x9x12_uint8", options, damage);
}

void expectRefused(const std::string& message, const Damage& damage) {
    SCOPED_TRACE(message);
    const TempFolder folder;
    writeDamagedBytes(damage);
    expectError(ErrorCode::kInput, "a.vdb: grid \"a_20x9x12_uint8\"" + message,
                [] { readVolume("a.vdb"); });
}

template <typename T>
Damage with(const std::string& key, const T& value) {
    return [=](openvdb::Int32Grid& grid) {
        grid.removeMeta(key);
        grid.insertMeta(key, openvdb::TypedMetadata<T>(value));
    };
}

TEST(ReadDeltaError, UnknownVersion) {
    expectRefused(": metadata \"delta_version\": got 8; expected an int32 within 6..7",
                  with<std::int32_t>("delta_version", 8));
    expectRefused(": metadata \"delta_version\": got 5; expected an int32 within 6..7",
                  with<std::int32_t>("delta_version", 5));
    expectRefused(": got deltas of type int32; expected int64 for packed deltas",
                  with<std::int32_t>("delta_version", 7));
}

TEST(ReadDeltaError, MetadataOfAnotherType) {
    expectRefused(
        ": metadata \"delta_key_interval\": got type float; expected an int32 within "
        "8..1073741824",
        with<float>("delta_key_interval", 8));
}

TEST(ReadDeltaError, MetadataOutOfRange) {
    expectRefused(": metadata \"delta_slice_axis\": got \"w\"; expected one of \"x\" \"y\" \"z\"",
                  with<std::string>("delta_slice_axis", "w"));
    expectRefused(": metadata \"delta_key_interval\": got 12; expected a multiple of 8",
                  with<std::int32_t>("delta_key_interval", 12));
    expectRefused(
        ": metadata \"delta_code_book\": got \"octal\"; expected one of \"integer\" \"half\" "
        "\"linear\" \"table\" \"pieces\" \"float32\" \"float64\" \"int32\" \"int64\"",
        with<std::string>("delta_code_book", "octal"));
    expectRefused(": metadata \"delta_offset\": got nan; expected a finite double",
                  with<double>("delta_offset", std::nan("")));
    expectRefused(
        ": metadata \"delta_slab_deltas\": got \"12 many\"; expected at most 134217728 "
        "numbers with one space between",
        with<std::string>("delta_slab_deltas", "12 many"));
    expectRefused(": metadata \"delta_active\": got -5; expected a count",
                  with<std::int64_t>("delta_active", -5));
    expectRefused(
        ": metadata \"delta_box_max\": got [1073741824, 8, 11] with minimum [0, 0, 0]; "
        "expected indices within 2^30 of 0",
        with<openvdb::Vec3i>("delta_box_max", {1 << 30, 8, 11}));
}

TEST(ReadDeltaError, TablesThatAreNone) {
    const auto table = [](const std::string& text) {
        return [=](openvdb::Int32Grid& grid) {
            with<std::string>("delta_code_book", "table")(grid);
            with<std::string>("delta_table", text)(grid);
        };
    };
    expectRefused(
        ": metadata \"delta_table\": got no increasing finite numbers; expected at least "
        "one",
        table("1 3 2"));
    expectRefused(
        ": metadata \"delta_table\": got no increasing finite numbers; expected at least "
        "one",
        table(""));
    expectRefused(
        ": metadata \"delta_code_count\": got 250; expected 2, the numbers of "
        "delta_table",
        table("1 2"));
}

TEST(ReadDeltaError, PiecesThatAreNone) {
    const auto pieces = [](const std::string& text) {
        return [=](openvdb::Int32Grid& grid) {
            with<std::string>("delta_code_book", "pieces")(grid);
            with<std::string>("delta_pieces", text)(grid);
        };
    };
    const std::string expected =
        "; expected groups of a first value, a step and a count, in increasing order";
    const std::string begin = ": metadata \"delta_pieces\": got ";
    expectRefused(begin + "0 numbers" + expected, pieces(""));
    expectRefused(begin + "4 numbers" + expected, pieces("1 2 3 4"));
    expectRefused(begin + "1 0 2" + expected, pieces("1 0 2"));
    expectRefused(begin + "1 -1 1" + expected, pieces("1 -1 1"));
    expectRefused(begin + "1 1 0" + expected, pieces("1 1 0"));
    expectRefused(begin + "1 1 1.5" + expected, pieces("1 1 1.5"));
    expectRefused(begin + "1 1 65537" + expected, pieces("1 1 65537"));
    expectRefused(begin + "9 1 2" + expected, pieces("0 1 65535 9 1 2"));
    expectRefused(begin + "3 1 2" + expected, pieces("1 1 3 3 1 2"));
    expectRefused(begin + "1 1e+308 9" + expected, pieces("1 1e308 9"));
    expectRefused(
        ": metadata \"delta_code_count\": got 250; expected 3, the numbers of "
        "delta_pieces",
        pieces("1 1 2 5 0.5 1"));
}

TEST(ReadDeltaError, MissingKeySlice) {
    expectRefused(": got 152 deltas in slab 1; expected 178, as \"delta_slab_deltas\" says",
                  [](openvdb::Int32Grid& grid) {
                      for (auto value = grid.beginValueOn(); value; ++value) {
                          if (value.getCoord().x() == 8) value.setActiveState(false);
                      }
                  });
}

TEST(ReadDeltaError, CodesOutsideOfTheBook) {
    // Voxel (0, 0, 0) has code 0, the most frequent one; (7, 0, 0) has code 7. Deltas have no
    // sign: 1 is -1.
    expectRefused(
        ": got deltas that lead to 251 at (0, 7, 0); expected 0..250, the codes of "
        "its integer code book",
        [](openvdb::Int32Grid& grid) { grid.tree().setValue(Coord(0, 7, 0), 2 * 251); });
    expectRefused(
        ": got deltas that lead to -1 at (0, 7, 0); expected 0..250, the codes of its "
        "integer code book",
        [](openvdb::Int32Grid& grid) { grid.tree().setValue(Coord(0, 7, 0), 1); });
}

// Sums of deltas that no 32 bits hold.
TEST(ReadDeltaError, ChainsBeyondIntegers) {
    expectRefused(
        ": got deltas that lead to 2147483647 at (0, 7, 0); expected 0..250, the codes "
        "of its integer code book",
        [](openvdb::Int32Grid& grid) { grid.tree().setValue(Coord(0, 7, 0), -2); });
}

// Of 60 x 40 x 30 floats, more than a code book has codes for, sliced along x.
void expectExactRefused(const std::string& message, const Damage& damage) {
    SCOPED_TRACE(message);
    const TempFolder folder;
    std::vector<float> values(60 * 40 * 30);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i) * 0.001f;
    testing::writeBytes("f_60x40x30_float32.raw", testing::bytesOf(values));
    DeltaFileOptions options;
    options.sliceAxis = 0;
    writeDamaged("f_60x40x30_float32", options, damage);
    expectError(ErrorCode::kInput, "a.vdb: grid \"f_60x40x30_float32\"" + message,
                [] { readVolume("a.vdb"); });
}

TEST(ReadDeltaError, ExactValuesThatAreNone) {
    const auto setFirst = [](std::int32_t zigzag) {
        return [=](openvdb::Int32Grid& grid) { grid.tree().setValue(Coord(0, 8, 8), zigzag); };
    };
    const std::string range = " at (0, 8, 8); expected 0 or 8388609..4286578688";
    expectExactRefused(": got deltas that lead to 5" + range, setFirst(10));
    expectExactRefused(": got deltas that lead to 8388608" + range, setFirst(2 * 8388608));
    // -8388607 of 32 bits: behind the largest float, where inactive values would begin.
    expectExactRefused(": got deltas that lead to 4286578689" + range, setFirst(2 * 8388607 - 1));
}

TEST(ReadDeltaError, ExactBooksOfOtherGrids) {
    expectExactRefused(": got deltas of type int32; expected int64 for the code book float64",
                       with<std::string>("delta_code_book", "float64"));
    expectExactRefused(
        ": metadata \"delta_source_tree\": got \"double\"; expected \"float\", for the code book "
        "float32",
        with<std::string>("delta_source_tree", "double"));
    expectExactRefused(
        ": metadata \"delta_background\": got 0.1; expected a float32, for active voxels to rest "
        "at",
        with<double>("delta_background", 0.1));
    expectExactRefused(
        ": metadata \"delta_box_min\": got [-1, 0, 0]; expected [0, 0, 0] in a box of at least one "
        "voxel, for active voxels to rest in a volume of float32",
        with<openvdb::Vec3i>("delta_box_min", {-1, 0, 0}));
    expectExactRefused(": got 72000 active voxels; expected 71999, as \"delta_active\" says",
                       with<std::int64_t>("delta_active", 71999));
}

TEST(ReadDeltaError, DeltasOutsideOfTheBox) {
    const auto more = [](openvdb::Int32Grid& grid) { grid.tree().setValue(Coord(0, 200, 0), 4); };
    expectRefused(
        ": got deltas at (0, 200, 0); expected deltas within the box (0, 0, 0) to (11, "
        "19, 8)",
        more);
}

TEST(ReadDeltaError, AnotherNumberOfSlabs) {
    expectRefused(": got 2 slabs in \"delta_slab_deltas\"; expected 1",
                  with<std::int32_t>("delta_key_interval", 16));
}

TEST(ReadDeltaError, AnotherNumberOfActiveVoxels) {
    expectRefused(": got 2160 active voxels; expected 2161, as \"delta_active\" says",
                  with<std::int64_t>("delta_active", 2161));
}

TEST(ReadDeltaError, AnotherBackground) {
    expectRefused(": got background 3; expected 0", [](openvdb::Int32Grid& grid) {
        grid.tree().root().setBackground(3, /*updateChildNodes=*/true);
    });
}

// A box that claims more than there is does not make the reader ask for memory.
TEST(ReadDeltaError, BoxesThatMemoryCannotHold) {
    const TempFolder folder;
    writeDamagedBytes([](openvdb::Int32Grid& grid) {
        constexpr std::int64_t kSide = (1 << 20) + 1;
        with<openvdb::Vec3i>("delta_box_max", {kSide - 1, kSide - 1, 11})(grid);
        with<std::int64_t>("delta_active", kSide * kSide * 12)(grid);
    });
    expectError(ErrorCode::kInput, "", [] {
        try {
            readVolume("a.vdb");
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("of memory"), std::string::npos);
            throw Error(error.code(), "");
        }
    });
}

// One delta that lasts for millions of slices takes more in tiles than in the file.
TEST(ReadDeltaError, ChainsThatMemoryCannotHold) {
    const TempFolder folder;
    openvdb::initialize();
    auto block = openvdb::FloatGrid::create();
    block->fill({Coord(0), Coord(7)}, 1);
    block->setName("a");
    openvdb::io::File("source.vdb").write({block});
    const auto claim = [&](int slices, std::int64_t active) {
        DeltaFileOptions options;
        options.sliceAxis = 2;
        options.keyInterval = slices;
        options.pack = false;
        DeltaFile file;
        file.add(readVolume("source.vdb"), options);
        file.write("whole.vdb");
        openvdb::io::File input("whole.vdb");
        input.open();
        const auto grid = openvdb::gridPtrCast<openvdb::Int32Grid>(input.readGrid("a"));
        with<openvdb::Vec3i>("delta_box_max", {7, 7, slices - 1})(*grid);
        with<std::int64_t>("delta_active", active)(*grid);
        openvdb::io::File("a.vdb").write({grid});
    };
    claim(1 << 23, 512);
    expectError(ErrorCode::kInput,
                "a.vdb: grid \"a\": got at least 1024 active voxels; expected 512, as "
                "\"delta_active\" says",
                [] { readVolume("a.vdb"); });
    claim(1 << 25, std::int64_t{1} << 31);
    setMemoryLimit(std::uint64_t{1} << 28);
    EXPECT_THROW(readVolume("a.vdb"), Error);
    setMemoryLimit(0);
}

TEST(ReadDeltaError, BackgroundsThatNothingCanHold) {
    // 0 is what most voxels of the file rest at.
    for (const double value : {std::nan(""), 0.5, 300.0, 1e300}) {
        expectRefused(": metadata \"delta_background\": got " + numberText(value) +
                          "; expected the value of a code, for active voxels to rest at",
                      with<double>("delta_background", value));
    }
    const auto inactive = [](const std::string& tree, double background) {
        return [=](openvdb::Int32Grid& grid) {
            with<std::string>("delta_rest", "inactive")(grid);
            with<std::string>("delta_source_tree", tree)(grid);
            with<double>("delta_background", background)(grid);
        };
    };
    expectRefused(": metadata \"delta_background\": got 1e+300; expected a float",
                  inactive("float", 1e300));
    expectRefused(": metadata \"delta_background\": got 0.5; expected a whole number of type int32",
                  inactive("int32", 0.5));
    expectRefused(
        ": metadata \"delta_code_book\": got \"half\"; expected a book of whole numbers for type "
        "int32",
        [&](openvdb::Int32Grid& grid) {
            inactive("int32", 0)(grid);
            with<std::string>("delta_code_book", "half")(grid);
        });
}

}  // namespace
}  // namespace deltasplat
