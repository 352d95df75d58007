// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "deltasplat/convert/write_volume.h"
#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

// A file as NumPy writes it: the header is filled up to a multiple of 64 bytes.
std::string npy(const std::string& dictionary, const std::string& data, int version = 1) {
    const std::size_t start = version == 1 ? 10 : 12;
    std::string text = dictionary;
    while ((start + text.size() + 1) % 64 != 0) text += ' ';
    text += '\n';
    const std::string length = version == 1 ? bytesOf<std::uint16_t>({std::uint16_t(text.size())})
                                            : bytesOf<std::uint32_t>({std::uint32_t(text.size())});
    return "\x93NUMPY" + std::string{char(version), '\0'} + length + text + data;
}

std::string dictionary(const std::string& type, const std::string& shape, bool fortran = false) {
    return "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") +
           ", 'shape': " + shape + ", }";
}

std::string sample() {
    return npy(dictionary("<u2", "(2, 3, 4)"), bytesOf(ramp<std::uint16_t>(24)));
}

TEST(ReadNpy, LastIndexIsX) {
    const TempFolder folder;
    for (const int version : {1, 2, 3}) {
        writeBytes("a.npy",
                   npy(dictionary("<u2", "(2, 3, 4)"), bytesOf(ramp<std::uint16_t>(24)), version));
        const Volume volume = readVolume("a.npy");
        EXPECT_EQ(volume.name(), "a");
        EXPECT_EQ(volume.type(), "uint16");
        EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 2));
        EXPECT_EQ(valuesOf(volume), ramp<double>(24));
    }
}

TEST(ReadNpy, PackedByContent) {
    const TempFolder folder;
    writeGzip("a.npy.gz", sample());
    writeGzip("b.npy", sample());
    writeBytes("c.npy.gz", sample());
    for (const char* const name : {"a.npy.gz", "b.npy", "c.npy.gz"}) {
        EXPECT_EQ(valuesOf(readVolume(name)), ramp<double>(24)) << name;
        EXPECT_EQ(readVolume(name).name(), std::string(1, name[0]));
    }
    writeGzip("d.npy.gz", sample().substr(0, 20));
    expectRefused("d.npy.gz: got a header that is cut short; expected a whole one", "d.npy.gz");
}

TEST(ReadNpy, FirstIndexIsXInFortranOrder) {
    const TempFolder folder;
    writeBytes("a.npy",
               npy(dictionary("<u2", "(4, 3, 2)", true), bytesOf(ramp<std::uint16_t>(24))));
    const Volume volume = readVolume("a.npy");
    EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 2));
    EXPECT_EQ(valuesOf(volume), ramp<double>(24));
}

template <typename T>
void expectType(const std::string& name, const std::string& type, bool turned = false) {
    writeBytes("a.npy", npy(dictionary(name, "(2, 3, 4)"), bytesOf(ramp<T>(24), turned)));
    const Volume volume = readVolume("a.npy");
    EXPECT_EQ(volume.type(), type) << name;
    EXPECT_EQ(valuesOf(volume), ramp<double>(24)) << name;
}

TEST(ReadNpy, Types) {
    const TempFolder folder;
    expectType<std::uint8_t>("|u1", "uint8");
    expectType<std::int8_t>("|i1", "int8");
    expectType<std::int16_t>("<i2", "int16");
    expectType<std::int16_t>(">i2", "int16", true);
    expectType<std::uint32_t>("<u4", "uint32");
    expectType<std::int32_t>(">i4", "int32", true);
    expectType<std::uint64_t>("<u8", "uint64");
    expectType<std::int64_t>("<i8", "int64");
    expectType<float>("<f4", "float32");
    expectType<float>(">f4", "float32", true);
    expectType<double>("<f8", "float64");
    // Halves: 0, 1, -2 and 65504.
    for (const bool big : {false, true}) {
        writeBytes("a.npy",
                   npy(dictionary(big ? ">f2" : "<f2", "(6,)"),
                       bytesOf<std::uint16_t>({0, 0x3c00, 0xc000, 0x7bff, 1, 0x83ff}, big)));
        EXPECT_EQ(valuesOf(readVolume("a.npy")),
                  (std::vector<double>{0, 1, -2, 65504, 0x1p-24, -1023 * 0x1p-24}));
    }
    writeBytes("a.npy", npy(dictionary("|b1", "(3,)"), std::string("\1\0\1", 3)));
    EXPECT_EQ(valuesOf(readVolume("a.npy")), (std::vector<double>{1, 0, 1}));
}

// Whole numbers, near each other, that no 64-bit integer holds.
TEST(ReadNpy, ConstantsBeyondIntegers) {
    const TempFolder folder;
    for (const double constant : {9.2e18, 9.3e18, -1e20, 1e300}) {
        writeBytes("a.npy", npy(dictionary("<f8", "(1, 1, 2)"),
                                bytesOf(std::vector<double>{constant, constant})));
        EXPECT_EQ(valuesOf(readVolume("a.npy")), std::vector<double>(2, constant));
    }
}

TEST(ReadNpy, SpacingAndOrigin) {
    const TempFolder folder;
    writeBytes("a.npy", sample());
    ReadOptions options;
    options.raw.spacing = {2, 3, 4};
    options.raw.origin = {10, 20, 30};
    EXPECT_EQ(readVolume("a.npy", options).worldFromIndex(),
              glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
}

TEST(ReadNpy, AxesOfOne) {
    const TempFolder folder;
    writeBytes("a.npy", npy(dictionary("<u2", "(1, 2, 3, 4)"), bytesOf(ramp<std::uint16_t>(24))));
    EXPECT_EQ(valuesOf(readVolume("a.npy")), ramp<double>(24));
    writeBytes("a.npy", npy(dictionary("<u2", "(4, 1, 3, 2)"), bytesOf(ramp<std::uint16_t>(24))));
    expectRefused(
        "a.npy: got 4 volumes (shape (4, 1, 3, 2)); expected one, chosen by `volume` 0 to 3",
        "a.npy");
}

// The index that counts fastest is the last one, in Fortran order the first; volumes are the other
// end.
TEST(ReadNpy, VolumesAreChosen) {
    const TempFolder folder;
    const std::string data = bytesOf(ramp<std::uint16_t>(144));
    writeBytes("a.npy", npy(dictionary("<u2", "(6, 2, 3, 4)"), data));
    writeBytes("b.npy", npy(dictionary("<u2", "(2, 3, 2, 3, 4)"), data));
    writeBytes("c.npy", npy(dictionary("<u2", "(4, 3, 2, 6)", true), data));
    for (const std::string name : {"a.npy", "b.npy", "c.npy"}) {
        ReadOptions options;
        for (int volume = 0; volume < 6; ++volume) {
            options.volume = volume;
            const Volume got = readVolume(name, options);
            EXPECT_EQ(got.box().dims(), glm::ivec3(4, 3, 2));
            EXPECT_EQ(valuesOf(got), ramp<double>(24, 24 * volume));
        }
    }
    ReadOptions beyond;
    beyond.volume = 6;
    expectRefused(
        "b.npy: got no volume 6 among 6 volumes (shape (2, 3, 2, 3, 4)); expected `volume` 0 to 5",
        "b.npy", beyond);
    writeBytes("b.npy", npy(dictionary("<f2", "(2, 3)"), data.substr(0, 12)));
    beyond.volume = 0;
    EXPECT_EQ(readVolume("b.npy", beyond).type(), "float32");
}

TEST(ReadNpyError, VolumesBeyondTheData) {
    const TempFolder folder;
    const std::string data = bytesOf(ramp<std::uint16_t>(144));
    ReadOptions first;
    first.volume = 0;
    writeBytes("a.npy", npy(dictionary("<u2", "(7, 2, 3, 4)"), data));
    expectRefused("a.npy: got 416 bytes; expected 464 (128 skipped + 7 volumes of 4x3x2 uint16)",
                  "a.npy", first);
    writeBytes("a.npy", npy(dictionary("<u2", "(5, 2, 3, 4)"), data));
    expectRefused("a.npy: got 416 bytes; expected 368 (128 skipped + 5 volumes of 4x3x2 uint16)",
                  "a.npy", first);
    writeBytes("a.npy", npy(dictionary("<u2", "(1073741824, 1073741824, 2, 3, 4)"), data));
    expectRefused(
        "a.npy: got shape (1073741824, 1073741824, 2, 3, 4); expected at most 4611686018427387904 "
        "bytes",
        "a.npy", first);
}

TEST(ReadNpyError, EveryCutAndMore) {
    const TempFolder folder;
    const std::string whole = sample();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        writeBytes("b.npy", whole.substr(0, size));
        expectInputError("b.npy");
    }
    writeBytes("b.npy", whole + "x");
    expectRefused("b.npy: got 177 bytes; expected 176 (128 skipped + 4x3x2 uint16)", "b.npy");
}

TEST(ReadNpyError, Headers) {
    const TempFolder folder;
    const std::string data = bytesOf(ramp<std::uint16_t>(24));
    const auto expectHeader = [&](const std::string& message, const std::string& text) {
        writeBytes("a.npy", npy(text, data));
        expectRefused("a.npy: got " + message, "a.npy");
    };
    expectHeader("values of type <c8; expected whole or real numbers", dictionary("<c8", "(2, 3)"));
    expectHeader("values of type |O; expected whole or real numbers", dictionary("|O", "(24,)"));
    expectHeader("values of type <\xc3\xa4?; expected whole or real numbers",
                 dictionary("<\xc3\xa4\xe4", "(24,)"));
    expectHeader("shape (0, 3, 4); expected each 1..1073741824", dictionary("<u2", "(0, 3, 4)"));
    expectHeader("shape (-1, 3, 4); expected each 1..1073741824", dictionary("<u2", "(-1, 3, 4)"));
    for (const std::string text :
         {"{}", "", "{'descr': '<u2'}", "{'descr': [('a', '<u2')], 'shape': (24,)}",
          "{'descr': '<u2', 'fortran_order': Maybe, 'shape': (24,), }",
          "{'descr': '<u2', 'fortran_order': False, 'shape': (2 3), }",
          "{'descr': '<u2', 'fortran_order': False, 'shape': (99999999999999999999,), }",
          "{'descr': '<u2', 'fortran_order': False, 'shape': (2, 3, 4), }; import os",
          "{'descr': '<u2', 'fortran_order': False, 'shape': (2, 3, 4), } }",
          "{'descr': '<u2', 'fortran_order': False, 'shape': (2, 3, 4), }\n{}"}) {
        writeBytes("a.npy", npy(text, data));
        expectInputError("a.npy");
    }
    writeBytes("a.npy", "no array");
    expectRefused("a.npy: got no NumPy header; expected a .npy file of version 1 to 3", "a.npy");
}

// Byte for byte what numpy.save writes.
TEST(WriteNpy, AsNumPyDoes) {
    const TempFolder folder;
    writeBytes("a.npy", sample());
    ReadOptions options;
    options.keepSource = true;
    std::vector<Volume> volumes;
    volumes.push_back(readVolume("a.npy", options));
    const WriteReport report = writeVolumes("b.npy", std::move(volumes));
    EXPECT_TRUE(report.lossless);
    EXPECT_EQ(report.notes, std::vector<std::string>{});
    EXPECT_EQ(readBytes("b.npy"), sample());
}

TEST(WriteNpy, PlaceIsNoted) {
    const TempFolder folder;
    writeBytes("a.npy", sample());
    ReadOptions options;
    options.raw.spacing = {2, 3, 4};
    std::vector<Volume> volumes;
    volumes.push_back(readVolume("a.npy", options));
    EXPECT_EQ(
        writeVolumes("b.npy", std::move(volumes)).notes,
        std::vector<std::string>{"b.npy: no place in its header; read it with `spacing` 2,3,4"});
}

}  // namespace
}  // namespace deltasplat
