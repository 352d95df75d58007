// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

const std::vector<double> kRamp = ramp<double>(24);

// Fields of a header; a field given again replaces the first.
std::string nrrd(std::vector<std::pair<std::string, std::string>> changes = {}) {
    std::vector<std::pair<std::string, std::string>> fields{
        {"type", "ushort"},
        {"dimension", "3"},
        {"space", "left-posterior-superior"},
        {"sizes", "4 3 2"},
        {"space directions", "(2,0,0) (0,3,0) (0,0,4)"},
        {"encoding", "raw"},
        {"endian", "little"},
        {"space origin", "(10,20,30)"}};
    for (const auto& [name, value] : changes) {
        const auto same = std::find_if(fields.begin(), fields.end(),
                                       [&](const auto& field) { return field.first == name; });
        if (same == fields.end()) {
            fields.emplace_back(name, value);
        } else {
            same->second = value;
        }
    }
    std::string text = "NRRD0004\n# made by a test\n";
    for (const auto& [name, value] : fields) {
        if (!value.empty()) text += name + ": " + value + "\n";
    }
    return text + "key:=value\n";
}

std::string data(bool bigEndian = false) {
    return bytesOf(ramp<std::uint16_t>(24), bigEndian);
}

void expectSample(const Volume& volume) {
    EXPECT_EQ(volume.type, "uint16");
    EXPECT_EQ(volume.space, "LPS");
    EXPECT_EQ(volume.box.dims(), glm::ivec3(4, 3, 2));
    EXPECT_EQ(volume.worldFromIndex, glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
    EXPECT_EQ(valuesOf(volume), kRamp);
}

TEST(ReadNrrd, Attached) {
    const TempFolder folder;
    writeBytes("a.nrrd", nrrd() + "\n" + data());
    const Volume volume = readVolume("a.nrrd");
    EXPECT_EQ(volume.name, "a");
    expectSample(volume);
    writeBytes("b.NRRD", nrrd({{"endian", "big"}}) + "\n" + data(true));
    expectSample(readVolume("b.NRRD"));
}

TEST(ReadNrrd, Detached) {
    const TempFolder folder;
    std::filesystem::create_directory("sub");
    writeBytes("sub/values.raw", data());
    writeBytes("sub/a.nhdr", nrrd({{"data file", "values.raw"}}));
    expectSample(readVolume("sub/a.nhdr"));
    writeBytes("b.nhdr", nrrd({{"data file", "sub/values.raw"}}));
    expectSample(readVolume("b.nhdr"));
    writeBytes("skip.raw", "12345" + data());
    writeBytes("c.nhdr", nrrd({{"data file", "skip.raw"}, {"byte skip", "5"}}));
    expectSample(readVolume("c.nhdr"));
}

TEST(ReadNrrd, Gzip) {
    const TempFolder folder;
    writeGzip("values.raw.gz", data(true));
    const std::string header = nrrd({{"encoding", "gzip"}, {"endian", "big"}});
    writeBytes("a.nrrd", header + "\n" + readBytes("values.raw.gz"));
    expectSample(readVolume("a.nrrd"));
    writeBytes("b.nhdr", header + "data file: values.raw.gz\n");
    expectSample(readVolume("b.nhdr"));
}

TEST(ReadNrrd, Text) {
    const TempFolder folder;
    std::string numbers;
    for (int i = 0; i < 24; ++i) numbers += std::to_string(i) + (i % 4 == 3 ? "\n" : " ");
    writeBytes("a.nrrd", nrrd({{"encoding", "ascii"}, {"endian", ""}}) + "\n" + numbers);
    expectSample(readVolume("a.nrrd"));
}

template <typename T>
void expectType(const std::string& nrrdName, const std::string& name) {
    const std::string header = nrrd({{"type", nrrdName}, {"endian", "big"}});
    writeBytes("a.nrrd", header + "\n" + bytesOf(ramp<T>(24, 2, 3), true));
    const Volume volume = readVolume("a.nrrd");
    EXPECT_EQ(volume.type, name);
    EXPECT_EQ(valuesOf(volume), ramp<double>(24, 2, 3)) << name;
}

TEST(ReadNrrd, Types) {
    const TempFolder folder;
    expectType<std::uint8_t>("uchar", "uint8");
    expectType<std::int8_t>("int8", "int8");
    expectType<std::uint16_t>("unsigned short", "uint16");
    expectType<std::int16_t>("short", "int16");
    expectType<std::uint32_t>("uint", "uint32");
    expectType<std::int32_t>("int", "int32");
    expectType<std::uint64_t>("uint64", "uint64");
    expectType<std::int64_t>("longlong", "int64");
    expectType<float>("float", "float32");
    expectType<double>("double", "float64");
}

// World is what the file says, not what ITK makes of it.
TEST(ReadNrrd, Spaces) {
    const TempFolder folder;
    const glm::dmat4 world(0, 2, 0, 0, -3, 0, 0, 0, 0, 0.5, 4, 0, 10, 20, 30, 1);
    for (const auto& [space, name] :
         {std::pair<std::string, std::string>{"left-posterior-superior", "LPS"},
          {"LPS", "LPS"},
          {"right-anterior-superior", "RAS"},
          {"RAS", "RAS"},
          {"LAS", ""},
          {"scanner-xyz", ""},
          {"3D-right-handed", ""}}) {
        SCOPED_TRACE(space);
        const std::string header =
            nrrd({{"space", space}, {"space directions", "(0,2,0) (-3,0,0) (0,0.5,4)"}});
        writeBytes("a.nrrd", header + "\n" + data());
        const Volume volume = readVolume("a.nrrd");
        EXPECT_EQ(volume.space, name);
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                EXPECT_NEAR(volume.worldFromIndex[i][j], world[i][j], 1e-12);
            }
        }
    }
}

TEST(ReadNrrd, SpacingsWithoutSpace) {
    const TempFolder folder;
    const std::string header = nrrd(
        {{"space", ""}, {"space directions", ""}, {"space origin", ""}, {"spacings", "2 3 4"}});
    writeBytes("a.nrrd", header + "\n" + data());
    const Volume volume = readVolume("a.nrrd");
    EXPECT_EQ(volume.space, "");
    EXPECT_EQ(volume.worldFromIndex, glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1));
}

TEST(ReadNrrd, AxesOfOneVoxel) {
    const TempFolder folder;
    const std::vector<std::pair<std::string, std::string>> plain{
        {"space", ""}, {"space directions", ""}, {"space origin", ""}};
    for (const auto& [count, sizes, spacings, dims] :
         {std::tuple{"4", "1 4 3 2", "9 2 3 4", glm::ivec3(4, 3, 2)},
          {"4", "4 3 2 1", "2 3 4 9", glm::ivec3(4, 3, 2)},
          {"2", "4 6", "2 3", glm::ivec3(4, 6, 1)},
          {"1", "24", "2", glm::ivec3(24, 1, 1)}}) {
        auto changes = plain;
        changes.emplace_back("dimension", count);
        changes.emplace_back("sizes", sizes);
        changes.emplace_back("spacings", spacings);
        writeBytes("a.nrrd", nrrd(changes) + "\n" + data());
        const Volume volume = readVolume("a.nrrd");
        EXPECT_EQ(volume.box.dims(), dims);
        EXPECT_EQ(volume.voxelSize().x, 2);
        EXPECT_EQ(valuesOf(volume), kRamp);
    }
}

TEST(ReadNrrd, NaNIsReplaced) {
    const TempFolder folder;
    std::vector<float> values = ramp<float>(24);
    values[7] = NAN;
    writeBytes("a.nrrd", nrrd({{"type", "float"}}) + "\n" + bytesOf(values));
    expectRefused(
        "a.nrrd: got 1 NaN or infinite values, the first at (3, 1, 0); expected finite values "
        "(`nanValue` VALUE replaces them)",
        "a.nrrd");
    ReadOptions options;
    options.nanValue = -1;
    EXPECT_EQ(valueAt(readVolume("a.nrrd", options), 3, 1, 0), -1);
}

TEST(ReadNrrdError, Headers) {
    const TempFolder folder;
    const auto refused = [](const std::string& message, const std::string& bytes) {
        writeBytes("a.nrrd", bytes);
        expectRefused("a.nrrd: " + message, "a.nrrd");
    };
    refused("got no NRRD header; expected a file that begins with NRRD0001 to NRRD0005", "");
    refused("got no NRRD header; expected a file that begins with NRRD0001 to NRRD0005",
            "NRRX" + nrrd().substr(4) + "\n" + data());
    refused("got sizes 4 -3 2; expected whole numbers from 1 to 1073741824",
            nrrd({{"sizes", "4 -3 2"}}) + "\n" + data());
    refused("got sizes 4 three 2; expected whole numbers from 1 to 1073741824",
            nrrd({{"sizes", "4 three 2"}}) + "\n" + data());
    refused("got sizes 4294967300 3 2; expected whole numbers from 1 to 1073741824",
            nrrd({{"sizes", "4294967300 3 2"}}) + "\n" + data());
    refused("got a header without sizes; expected a whole one", nrrd({{"sizes", ""}}) + "\n");
    refused("got what ITK refuses (parsed 2 values, but dimension is 3); expected a sound file",
            nrrd({{"sizes", "4 6"}}) + "\n" + data());
    refused("got the header line \"no colon\"; expected \"field: value\"",
            nrrd() + "no colon\n\n" + data());
    refused(
        "got the header line \"content: xxxxxxxxxxx...\"; expected at most 200 characters of "
        "text",
        nrrd() + "content: " + std::string(5000, 'x') + "\n\n" + data());
}

// NrrdIO ends a line at a lone CR too, knows fields in few spellings, and passes over a last line
// without an end: each of these would have it read another file than was checked, or standard
// input.
TEST(ReadNrrdError, WhatNrrdIoReadsOtherwise) {
    const TempFolder folder;
    writeBytes("b.raw", data());
    const auto refused = [](const std::string& got, const std::string& expected,
                            const std::string& lines) {
        writeBytes("a.nrrd", nrrd() + lines + "\n" + data());
        expectRefused("a.nrrd: got " + got + "; expected " + expected, "a.nrrd");
    };
    for (const std::string before : {"# x", "key:=x", "content: x"}) {
        for (const std::string field : {"data file: b.raw", "data file: -", "labels: x"}) {
            refused("control characters in the header line \"" + before + "?" + field + "\"",
                    "lines of text", before + "\r" + field + "\n");
        }
    }
    refused("control characters in the header line \"# a?\"", "lines of text",
            std::string("# a\0\n", 5));
    for (const std::string line : {"data  file: b.raw", " data file: b.raw", "data\tfile: b.raw",
                                   "Data File:b.raw", "data file:=b.raw", "DATA FILE : b.raw"}) {
        const std::string shown = line[4] == '\t' ? "data?file: b.raw" : line;
        refused("the header line \"" + shown + "\"", "\"data file: value\"", line + "\n");
    }
    refused("the header line \" \"", "\"field: value\"", " \n");
    refused("data in \"c:b.raw\"", "the name of one data file", "data file: c:b.raw\n");
    refused("no data file \"b.raw \"", "a readable file", "data file: b.raw \n");
    for (const std::string magic : {"NRRD0004 ", "NRRD0006", "NRRDabcd"}) {
        writeBytes("a.nrrd", magic + nrrd().substr(8) + "\n" + data());
        expectRefused(
            "a.nrrd: got no NRRD header; expected a file that begins with NRRD0001 to NRRD0005",
            "a.nrrd");
    }
    writeBytes("a.nhdr", nrrd() + "data file: b.raw\nspace units: \"a\" \"b\" \"c\"");
    expectRefused(
        "a.nhdr: got the header line \"space units: \"a\" \"b\" \"c\"\"; expected an end of line "
        "behind it",
        "a.nhdr");
}

TEST(ReadNrrd, LinesEndWithCrLf) {
    const TempFolder folder;
    std::string text;
    const std::string long_value =
        "# " + std::string(5000, 'c') + "\nlong:=" + std::string(5000, 'v');
    for (const char c : nrrd() + long_value + "\nData File: b.raw\nSpaceUnits: \"a\" \"b\" \"c\"\n")
        text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    writeBytes("a.nhdr", text);
    writeBytes("b.raw", data());
    expectSample(readVolume("a.nhdr"));
    writeBytes("c.nrrd", text.substr(0, text.find("Data File")) + "\r\n" + data());
    expectSample(readVolume("c.nrrd"));
}

TEST(ReadNrrdError, SeveralValuesOrVolumes) {
    const TempFolder folder;
    const std::vector<std::pair<std::string, std::string>> four{
        {"space", ""}, {"space directions", ""}, {"space origin", ""}, {"dimension", "4"}};
    auto changes = four;
    changes.emplace_back("sizes", "2 2 3 2");
    writeBytes("a.nrrd", nrrd(changes) + "\n" + data());
    expectRefused("a.nrrd: got sizes 2x2x3x2; expected one volume of three axes", "a.nrrd");
    changes.emplace_back("kinds", "vector domain domain domain");
    writeBytes("b.nrrd", nrrd(changes) + "\n" + data());
    expectRefused("b.nrrd: got 2 values a voxel (vector); expected one", "b.nrrd");
}

TEST(ReadNrrdError, Data) {
    const TempFolder folder;
    writeBytes("a.nrrd", nrrd() + "\n" + data().substr(0, 40));
    expectRefused("a.nrrd: got 40 bytes of data; expected enough for 4x3x2 uint16", "a.nrrd");
    writeBytes("b.nrrd", nrrd({{"sizes", "16384 8192 8192"}}) + "\n" + data());
    expectRefused("b.nrrd: got 48 bytes of data; expected enough for 16384x8192x8192 uint16",
                  "b.nrrd");
    writeBytes("c.nrrd", nrrd({{"sizes", "1024 1024 1024"}, {"encoding", "gzip"}}) + "\n" + data());
    expectRefused("c.nrrd: got 48 bytes of data; expected enough gzip for 1024x1024x1024 uint16",
                  "c.nrrd");
    writeBytes("d.nhdr", nrrd({{"data file", "none.raw"}}));
    expectRefused("d.nhdr: got no data file \"none.raw\"; expected a readable file", "d.nhdr");
    writeBytes("e.nhdr", nrrd({{"data file", "LIST"}}) + "x.raw\n");
    expectRefused("e.nhdr: got the header line \"x.raw\"; expected \"field: value\"", "e.nhdr");
    writeBytes("f.nhdr", nrrd({{"data file", "%s%d.raw 1 2 1"}}));
    expectRefused("f.nhdr: got data in \"%s%d.raw 1 2 1\"; expected the name of one data file",
                  "f.nhdr");
    writeBytes("g.nhdr", nrrd({{"data file", "-"}}));
    expectRefused("g.nhdr: got data in \"-\"; expected the name of one data file", "g.nhdr");
}

TEST(ReadNrrdError, DamagedGzip) {
    const TempFolder folder;
    writeGzip("values.gz", data());
    const std::string packed = readBytes("values.gz");
    const std::string header = nrrd({{"encoding", "gzip"}}) + "\n";
    for (std::size_t size = 0; size < packed.size(); ++size) {
        writeBytes("a.nrrd", header + packed.substr(0, size));
        expectInputError("a.nrrd");
    }
    writeBytes("a.nrrd", header + packed.substr(0, packed.size() - 8));
    expectRefused("a.nrrd: got a gzip stream that is cut short; expected a whole one", "a.nrrd");

    // The ten bytes of the gzip header, of which only the time and the system may be anything.
    for (const std::size_t place : {0, 1, 2, 3}) {
        std::string damaged = packed;
        damaged[place] = char(damaged[place] ^ 4);
        writeBytes("b.nrrd", header + damaged);
        expectInputError("b.nrrd");
    }
    std::string damaged = packed;
    damaged[0] = char(damaged[0] ^ 1);
    writeBytes("b.nrrd", header + damaged);
    expectRefused("b.nrrd: got no gzip stream; expected a gzip file", "b.nrrd");
    damaged = packed;
    damaged[packed.size() - 6] = char(damaged[packed.size() - 6] ^ 1);
    writeBytes("b.nrrd", header + damaged);
    expectRefused("b.nrrd: got a corrupt gzip stream (incorrect data check); expected a sound one",
                  "b.nrrd");

    writeGzip("values.gz", data() + "x");
    writeBytes("c.nrrd", header + readBytes("values.gz"));
    expectRefused("c.nrrd: got more than 48 bytes unpacked; expected 48 (4x3x2 uint16)", "c.nrrd");
    writeGzip("values.gz", data().substr(0, 47));
    writeBytes("c.nrrd", header + readBytes("values.gz"));
    expectRefused("c.nrrd: got 47 bytes unpacked; expected 48 (4x3x2 uint16)", "c.nrrd");
}

TEST(ReadNrrd, SkipsInGzip) {
    const TempFolder folder;
    writeGzip("values.gz", "abc" + data());
    const std::string fields = nrrd({{"encoding", "gzip"}}) + "line skip: 2\nbyte skip: 3\n\n";
    writeBytes("a.nrrd", fields + "one\ntwo\n" + readBytes("values.gz"));
    EXPECT_EQ(valuesOf(readVolume("a.nrrd")), ramp<double>(24));
}

TEST(ReadNrrdError, FlatDirections) {
    const TempFolder folder;
    writeBytes("a.nrrd", nrrd({{"space directions", "(1,0,0) (2,0,0) (0,0,1)"}}) + "\n" + data());
    expectRefused(
        "a.nrrd: got spacing and directions that cannot be inverted; expected finite numbers that "
        "give "
        "each voxel a place of its own",
        "a.nrrd");
}

}  // namespace
}  // namespace deltasplat
