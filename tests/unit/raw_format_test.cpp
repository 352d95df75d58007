// SPDX-License-Identifier: Apache-2.0
#include "formats/raw/raw_format.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/text.h"
#include "files/file_name.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

using testing::expectError;

constexpr const char* kTypes = "one of uint8, int8, uint16, int16, uint32, int32, float32, float64";

void expectUsage(const std::string& message, const std::string& file, const RawFormat& format) {
    expectError(ErrorCode::kUsage, message, [&] { resolveRawLayout(file, format); });
}

TEST(RawFormat, ReadsTheName) {
    const RawLayout engine = resolveRawLayout("dir/engine_256x255x128_uint8.raw.gz", {});
    EXPECT_EQ(engine.dims, glm::i64vec3(256, 255, 128));
    EXPECT_EQ(engine.type, RawType::kUint8);
    EXPECT_FALSE(engine.bigEndian);
    EXPECT_EQ(engine.expectedSize(), "8355840 (256x255x128 uint8)");

    const RawLayout tooth = resolveRawLayout("tooth_103x94x161_uint16be.RAW", {});
    EXPECT_EQ(tooth.dims, glm::i64vec3(103, 94, 161));
    EXPECT_EQ(tooth.type, RawType::kUint16);
    EXPECT_TRUE(tooth.bigEndian);
    EXPECT_FALSE(resolveRawLayout("a_b_1x2x3_float64le.raw", {}).bigEndian);
}

TEST(RawFormat, NamesOfAnyLength) {
    const std::string digits(1'000'000, '1');
    expectUsage(
        "a_" + digits + "x1x1_uint8.raw: got dims " + digits + "x1x1; expected each 1..1073741824",
        "a_" + digits + "x1x1_uint8.raw", {});
    const std::string name(1'000'000, 'x');
    EXPECT_EQ(resolveRawLayout(name + "_1x2x3_uint8.raw", {}).dims, glm::i64vec3(1, 2, 3));
    for (const char* const none :
         {"a_1x2_uint8.raw", "a_1x2x3x4_uint8.raw", "a_1x2x_uint8.raw", "a_x2x3_uint8.raw",
          "1x2x3_uint8.raw", "a_1x2x3_.raw", "a_1x2x3_u-8.raw", "_.raw", "a_1xx3_uint8.raw"}) {
        EXPECT_THROW(resolveRawLayout(none, {}), Error) << none;
    }
    EXPECT_EQ(resolveRawLayout("_1x2x3_uint8.raw", {}).dims, glm::i64vec3(1, 2, 3));
}

TEST(RawFormat, ReadsEveryTypeName) {
    for (const RawType type :
         {RawType::kUint8, RawType::kInt8, RawType::kUint16, RawType::kInt16, RawType::kUint32,
          RawType::kInt32, RawType::kFloat32, RawType::kFloat64}) {
        const std::string name = rawTypeName(type);
        EXPECT_EQ(resolveRawLayout("a_1x2x3_" + name + ".raw", {}).type, type);
        EXPECT_EQ(resolveRawLayout("a_1x2x3_" + name + "be.raw", {}).type, type);
        const int bits = std::stoi(name.substr(name.find_first_of("0123456789")));
        EXPECT_EQ(rawTypeBytes(type) * 8, bits);
    }
}

TEST(RawFormat, OptionsWinOverTheName) {
    RawFormat format;
    format.dims = {4, 5, 6};
    format.type = "int16";
    format.bigEndian = false;
    format.skipBytes = 7;
    const RawLayout layout = resolveRawLayout("a_1x2x3_uint16be.raw", format);
    EXPECT_EQ(layout.dims, glm::i64vec3(4, 5, 6));
    EXPECT_EQ(layout.type, RawType::kInt16);
    EXPECT_FALSE(layout.bigEndian);
    EXPECT_EQ(layout.expectedSize(), "247 (7 skipped + 4x5x6 int16)");

    // A name's unknown type does not matter when the option says the type.
    EXPECT_EQ(resolveRawLayout("a_1x2x3_uint12.raw", format).type, RawType::kInt16);
}

TEST(RawFormat, OptionsAndNameComplete) {
    RawFormat format;
    format.bigEndian = true;
    EXPECT_TRUE(resolveRawLayout("a_1x2x3_uint16.raw", format).bigEndian);
}

TEST(RawFormat, MissingDimsAndType) {
    const std::string dims =
        "vol.raw: got no dimensions; expected `dims` XxYxZ and `type` TYPE, or a name such as "
        "volume_256x256x128_uint8.raw";
    expectUsage(dims, "vol.raw", {});
    RawFormat format;
    format.type = "uint8";
    expectUsage(dims, "vol.raw", format);
    format.type.reset();
    format.dims = {1, 1, 1};
    expectUsage(
        "vol.raw: got no value type; expected `type` TYPE, or a name such as "
        "volume_256x256x128_uint8.raw",
        "vol.raw", format);
}

// A name may say no more than the dims.
TEST(RawFormat, NameWithoutType) {
    expectUsage(
        "a_4x5x6.raw: got no value type; expected `type` TYPE, or a name such as "
        "volume_256x256x128_uint8.raw",
        "a_4x5x6.raw", {});
    RawFormat format;
    format.type = "int16";
    EXPECT_EQ(resolveRawLayout("a_4x5x6.raw.gz", format).dims, glm::i64vec3(4, 5, 6));
}

TEST(RawFormat, DimsOutOfRange) {
    RawFormat format;
    format.dims = {0, 4, 4};
    expectUsage("`dims`: got 0x4x4; expected each 1..1073741824", "a_1x2x3_uint8.raw", format);
    format.dims = {4, 4, -3};
    expectUsage("`dims`: got 4x4x-3; expected each 1..1073741824", "a_1x2x3_uint8.raw", format);
    format.dims = {4, std::int64_t{1} << 31, 1};
    expectUsage("`dims`: got 4x2147483648x1; expected each 1..1073741824", "a_1x2x3_uint8.raw",
                format);
    expectUsage("a_4x0x3_uint8.raw: got dims 4x0x3; expected each 1..1073741824",
                "a_4x0x3_uint8.raw", {});
    expectUsage(
        "a_99999999999999999999x1x1_uint8.raw: got dims 99999999999999999999x1x1; expected each "
        "1..1073741824",
        "a_99999999999999999999x1x1_uint8.raw", {});
}

TEST(RawFormat, ProductOverflows) {
    RawFormat format;
    format.dims = {1 << 30, 1 << 30, 8};
    format.type = "uint8";
    expectUsage(
        "`dims`: got 1073741824x1073741824x8 uint8; expected at most 9223372036854775807 "
        "bytes",
        "a.raw", format);
    format.dims = {1 << 30, 1 << 30, 7};
    EXPECT_EQ(resolveRawLayout("a.raw", format).dataBytes(), std::uint64_t{7} << 60);
    format.type = "uint16";
    expectUsage(
        "`dims`: got 1073741824x1073741824x7 uint16; expected at most "
        "9223372036854775807 bytes",
        "a.raw", format);
    format.dims = {1, 1, 1};
    format.skipBytes = std::numeric_limits<std::uint64_t>::max();
    expectUsage(
        "`skipBytes`: got 18446744073709551615; expected less than 9223372036854775807 "
        "bytes together with the voxels",
        "a.raw", format);
}

TEST(RawFormat, UnknownType) {
    RawFormat format;
    format.type = "uint12";
    expectUsage(std::string("`type`: got uint12; expected ") + kTypes, "a_1x2x3_uint8.raw", format);
    expectUsage(std::string("a_1x2x3_uint12be.raw: got value type uint12be; expected ") + kTypes,
                "a_1x2x3_uint12be.raw", {});
}

TEST(RawFormat, SpacingAndOrigin) {
    const std::string file = "a_1x2x3_uint8.raw";
    RawFormat format;
    for (const double spacing : {0.0, 1e-16, 1e16, std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()}) {
        format.spacing = {1, spacing, 1};
        expectUsage("`spacing`: got " + numberText(spacing) +
                        "; expected three numbers from 1e-15 to 1e+15",
                    file, format);
    }
    format.spacing = {1e-15, 1, 1e15};
    format.origin = {-1e15, 0, 0};
    EXPECT_NO_THROW(resolveRawLayout(file, format));
    format.origin = {-1e15, 1e12, 0};
    expectUsage("`origin`: got -1e+15,1e+12,0; expected a place within 1e+15 of 0,0,0", file,
                format);
    format.origin = {0, std::numeric_limits<double>::quiet_NaN(), 0};
    expectUsage("`origin`: got 0,nan,0; expected a place within 1e+15 of 0,0,0", file, format);
}

TEST(FileName, Extensions) {
    EXPECT_EQ(lowerExtension("a/b.c/x.RAW.Gz"), ".raw.gz");
    EXPECT_EQ(lowerExtension("x.vdb"), ".vdb");
    EXPECT_EQ(lowerExtension("x"), "");
    EXPECT_EQ(lowerExtension("x.gz"), ".gz");
    EXPECT_EQ(nameWithoutExtensions("a/b.c/engine_1.5.raw.gz"), "engine_1.5");
    EXPECT_EQ(nameWithoutExtensions("smoke.0001.vdb"), "smoke.0001");
}

}  // namespace
}  // namespace deltasplat
