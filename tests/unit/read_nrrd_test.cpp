// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <sstream>

#include "deltasplat/ingest/label_list.h"

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
    EXPECT_EQ(volume.type(), "uint16");
    EXPECT_EQ(volume.space(), "LPS");
    EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 2));
    EXPECT_EQ(volume.worldFromIndex(),
              glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
    EXPECT_EQ(valuesOf(volume), kRamp);
}

TEST(ReadNrrd, Attached) {
    const TempFolder folder;
    writeBytes("a.nrrd", nrrd() + "\n" + data());
    const Volume volume = readVolume("a.nrrd");
    EXPECT_EQ(volume.name(), "a");
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
    EXPECT_EQ(volume.type(), name);
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

// Every space that the format names, long and short, in any case: the same markers lie at the same
// places of the patient. What is no patient's is no patient's, and never mirrored.
TEST(ReadNrrd, Spaces) {
    const TempFolder folder;
    struct Case {
        std::string name;
        glm::dvec3 sign;    // of the file's x, y, z along left, back and up (no patient: its own)
        std::string space;  // as it is read
        bool time = false;
    };
    const glm::dvec3 lps(1), ras(-1, -1, 1), las(1, -1, 1);
    const std::vector<Case> cases{{"left-posterior-superior", lps, "LPS"},
                                  {"LPS", lps, "LPS"},
                                  {"lps", lps, "LPS"},
                                  {"Left-Posterior-Superior", lps, "LPS"},
                                  {"right-anterior-superior", ras, "RAS"},
                                  {"RAS", ras, "RAS"},
                                  {"left-anterior-superior", las, "LPS"},
                                  {"LAS", las, "LPS"},
                                  {"scanner-xyz", lps, ""},
                                  {"3D-right-handed", lps, ""},
                                  {"3d-right-handed", lps, ""},
                                  {"3D-left-handed", {1, 1, -1}, ""},
                                  {"left-posterior-superior-time", lps, "LPS", true},
                                  {"RAST", ras, "RAS", true},
                                  {"LAST", las, "LPS", true},
                                  {"scanner-xyz-time", lps, "", true},
                                  {"3D-left-handed-time", {1, 1, -1}, "", true}};
    const glm::dmat4 world(0, 2, 0, 0, -3, 0, 0, 0, 0, 0.5, 4, 0, 10, 20, 30, 1);
    for (const Case& one : cases) {
        SCOPED_TRACE(one.name);
        std::string vectors;
        const auto vector = [&](const glm::dvec4& v) {
            std::string text = "(";
            for (int row = 0; row < 3; ++row)
                text += (row > 0 ? "," : "") + std::to_string(one.sign[row] * v[row]);
            return text + (one.time ? ",0)" : ")");
        };
        for (int axis = 0; axis < 3; ++axis) vectors += vector(world[axis]) + " ";
        std::vector<std::pair<std::string, std::string>> changes{
            {"space", one.name},
            {"space directions", vectors + (one.time ? "(0,0,0,1)" : "")},
            {"space origin", vector(world[3])}};
        if (one.time) {
            changes.emplace_back("dimension", "4");
            changes.emplace_back("sizes", "4 3 2 1");
        }
        writeBytes("a.nrrd", nrrd(changes) + "\n" + data());
        Warnings warnings;
        const Volume volume = readVolume("a.nrrd", {}, warnings.listener());
        EXPECT_EQ(volume.space(), one.space);
        EXPECT_EQ(valuesOf(volume), kRamp);
        const glm::dvec3 own = one.space == "RAS" ? glm::dvec3(-1, -1, 1) : glm::dvec3(1);
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 3; ++j)
                EXPECT_NEAR(own[j] * volume.worldFromIndex()[i][j], world[i][j], 1e-12);
        }
        const bool turned = one.sign == las || one.sign.z < 0;
        EXPECT_EQ(warnings.lines.size(), turned ? 1u : 0u);
        if (!turned) continue;
        EXPECT_TRUE(warnings.lines[0].ends_with(
            one.sign == las ? " is turned into LPS: y changes its sign"
                            : " is turned into a right-handed space: z changes its sign"))
            << warnings.lines[0];
    }
    for (const std::string name : {"RAI", "left-posterior", "LPSX", ""}) {
        writeBytes("a.nrrd", nrrd({{"space", name.empty() ? " " : name}}) + "\n" + data());
        expectRefused("a.nrrd: got the space " + name +
                          "; expected one that NRRD defines, such as left-posterior-superior or "
                          "3D-right-handed",
                      "a.nrrd");
    }
    // A dimension alone names no axes.
    writeBytes("a.nrrd", nrrd({{"space", ""}, {"space dimension", "3"}}) + "\n" + data());
    EXPECT_EQ(readVolume("a.nrrd").space(), "");
    EXPECT_EQ(readVolume("a.nrrd").voxelSize(), glm::dvec3(2, 3, 4));
}

// A patient's space is in millimetres, others in what the file says; where that differs from axis
// to axis, in millimetres; what is not known is said to be so.
TEST(ReadNrrd, Units) {
    const TempFolder folder;
    struct Case {
        std::string units, unit;
        glm::dvec3 scale{1.0};
        bool warned = false;
    };
    for (const auto& [space, cases] :
         {std::pair<std::string, std::vector<Case>>{
              "LPS",
              {{"\"mm\" \"mm\" \"mm\"", "mm"},
               {"\"um\" \"um\" \"um\"", "mm", glm::dvec3(1e-3)},
               {"\"microns\" \"microns\" \"microns\"", "mm", glm::dvec3(1e-3)},
               {"\"\xc2\xb5m\" \"\xc2\xb5m\" \"\xc2\xb5m\"", "mm", glm::dvec3(1e-3)},
               {"\"cm\" \"cm\" \"cm\"", "mm", glm::dvec3(10)},
               {"\"m\" \"cm\" \"mm\"", "mm", {1e3, 10, 1}},
               {"\"\" \"\" \"\"", ""},
               {"\"pixel\" \"pixel\" \"pixel\"", "", glm::dvec3(1), true},
               {"\"mm\" \"mm\" \"\"", "", glm::dvec3(1), true}}},
          {"3D-right-handed",
           {{"\"um\" \"um\" \"um\"", "um"},
            {"\"nm\" \"nm\" \"um\"", "mm", {1e-6, 1e-6, 1e-3}},
            {"\"Meters\" \"m\" \"metre\"", "m"}}}}) {
        for (const Case& one : cases) {
            SCOPED_TRACE(space + " " + one.units);
            writeBytes("a.nrrd",
                       nrrd({{"space", space}, {"space units", one.units}}) + "\n" + data());
            Warnings warnings;
            const Volume volume = readVolume("a.nrrd", {}, warnings.listener());
            EXPECT_EQ(volume.lengthUnit(), one.unit);
            const glm::dvec3 size = volume.voxelSize(), place(volume.worldFromIndex()[3]);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_DOUBLE_EQ(size[axis], one.scale[axis] * (axis + 2));
                EXPECT_DOUBLE_EQ(place[axis], one.scale[axis] * 10 * (axis + 1));
            }
            EXPECT_EQ(warnings.lines.size(), one.warned ? 1u : 0u);
        }
    }
    // Of axes, where there is no space.
    const std::string header = nrrd({{"space", ""},
                                     {"space directions", ""},
                                     {"space origin", ""},
                                     {"spacings", "2 3 4"},
                                     {"units", "\"um\" \"um\" \"um\""}});
    writeBytes("b.nrrd", header + "\n" + data());
    EXPECT_EQ(readVolume("b.nrrd").lengthUnit(), "um");
    EXPECT_EQ(readVolume("b.nrrd").voxelSize(), glm::dvec3(2, 3, 4));
    // Without quotes, and of a space whose axes have no directions.
    writeBytes(
        "c.nrrd",
        nrrd({{"space directions", ""}, {"spacings", "2 3 4"}, {"space units", "um um um"}}) +
            "\n" + data());
    EXPECT_EQ(readVolume("c.nrrd").lengthUnit(), "mm");
    EXPECT_DOUBLE_EQ(readVolume("c.nrrd").voxelSize().z, 4e-3);
}

TEST(ReadNrrd, SpacingsWithoutSpace) {
    const TempFolder folder;
    const std::string header = nrrd(
        {{"space", ""}, {"space directions", ""}, {"space origin", ""}, {"spacings", "2 3 4"}});
    writeBytes("a.nrrd", header + "\n" + data());
    const Volume volume = readVolume("a.nrrd");
    EXPECT_EQ(volume.space(), "");
    EXPECT_EQ(volume.worldFromIndex(), glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1));
    // Axes along those of a space, which has an origin.
    writeBytes("b.nrrd", nrrd({{"space directions", ""}, {"spacings", "2 3 4"}}) + "\n" + data());
    expectSample(readVolume("b.nrrd"));
}

// Lines are passed over before values, in whatever file they are.
TEST(ReadNrrd, LinesBeforeValues) {
    const TempFolder folder;
    const std::string lines = std::string(200000, 'x') + "\n\n" + std::string(65535, 'y') + "\n";
    writeBytes("a.raw", lines + data());
    writeBytes("a.nhdr", nrrd({{"line skip", "3"}, {"data file", "a.raw"}}));
    expectSample(readVolume("a.nhdr"));
    writeBytes("a.nhdr", nrrd({{"line skip", "300"}, {"data file", "a.raw"}}));
    expectRefused("a.raw: got fewer lines than are to be skipped; expected all of them", "a.nhdr");
    writeBytes("a.nhdr",
               nrrd({{"byte skip", "-1"}, {"encoding", "ascii"}, {"data file", "a.raw"}}));
    expectRefused(
        "a.nhdr: got line skip 0 and byte skip -1; expected whole numbers from 0 on "
        "(byte skip -1: raw values that end the file)",
        "a.nhdr");
}

// Numbers as other programs read them, or none: a long one is not two.
TEST(ReadNrrd, NumbersOfText) {
    const TempFolder folder;
    const std::string header =
        nrrd({{"type", "double "}, {"sizes", "3 1 1"}, {"encoding", "ascii"}, {"endian", ""}}) +
        "\n";
    writeBytes("a.nrrd", header + "1e-50000 -1e-400 2." + std::string(300, '0'));
    EXPECT_EQ(valuesOf(readVolume("a.nrrd")), (std::vector<double>{0, 0, 2}));
    writeBytes("a.nrrd", header + "1." + std::string(500, '0') + " 2 3 4");
    expectRefused(
        "a.nrrd: got a number of more than 400 characters; expected enough numbers for "
        "3x1x1 float64",
        "a.nrrd");
    writeBytes("a.nrrd", header + "1 1e999 3");
    expectRefused("a.nrrd: got \"1e999\" among numbers; expected values of type float64", "a.nrrd");
    writeBytes("a.nrrd",
               nrrd({{"sizes", "3 1 1"}, {"encoding", "ascii"}, {"endian", ""}}) + "\n1 9e999 3");
    expectRefused("a.nrrd: got \"9e999\" among numbers; expected values of type uint16", "a.nrrd");
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
        EXPECT_EQ(volume.box().dims(), dims);
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
        "a.nrrd: got 1 NaN or infinite value, the first at (3, 1, 0); expected finite values "
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
    refused("got 2 sizes of dimension 3; expected as many sizes as dimensions",
            nrrd({{"sizes", "4 6"}}) + "\n" + data());
    refused("got values of type block; expected whole or real numbers",
            nrrd({{"type", "block"}}) + "\n" + data());
    refused("got the encoding bzip2; expected raw, gzip, ascii or hex",
            nrrd({{"encoding", "bzip2"}}) + "\n" + data());
    refused("got a header without endian; expected a whole one",
            nrrd({{"endian", ""}}) + "\n" + data());
    refused("got the vector (1,0); expected 3 numbers in brackets",
            nrrd({{"space directions", "(1,0) (0,1,0) (0,0,1)"}}) + "\n" + data());
    refused("got space directions (1,0,0) (0,1,0); expected 3 vectors or none",
            nrrd({{"space directions", "(1,0,0) (0,1,0)"}}) + "\n" + data());
    refused("got space directions without a space; expected a space or a space dimension",
            nrrd({{"space", ""}, {"space origin", ""}}) + "\n" + data());
    refused("got the header line \"no colon\"; expected \"field: value\"",
            nrrd() + "no colon\n\n" + data());
    refused("got a header without end; expected a text header",
            nrrd() + "content: " + std::string(1100000, 'x') + "\n\n" + data());
}

// What is spelled otherwise than the format has it is read differently by different programs, and
// so are control characters in a field.
TEST(ReadNrrdError, FieldsThatProgramsReadDifferently) {
    const TempFolder folder;
    writeBytes("b.raw", data());
    const auto refused = [](const std::string& got, const std::string& expected,
                            const std::string& lines) {
        writeBytes("a.nrrd", nrrd() + lines + "\n" + data());
        expectRefused("a.nrrd: got " + got + "; expected " + expected, "a.nrrd");
    };
    refused("control characters in the header line \"content: x?data file: b.raw\"",
            "lines of text", "content: x\rdata file: b.raw\n");
    for (const std::string line : {"data  file: b.raw", " data file: b.raw", "data\tfile: b.raw",
                                   "Data File:b.raw", "DATA FILE : b.raw"}) {
        const std::string shown = line[4] == '\t' ? "data?file: b.raw" : line;
        refused("the header line \"" + shown + "\"", "\"data file: value\"", line + "\n");
    }
    refused("the field content twice", "each field once", "content: a\ncontent: b\n");
    refused("the header line \" \"", "\"field: value\"", " \n");
    refused("data in \"c:b.raw\"", "the name of one data file", "data file: c:b.raw\n");
    refused("no data file \"b.raw \"", "a readable file", "data file: b.raw \n");
    for (const std::string magic : {"NRRD0004 ", "NRRD0006", "NRRDabcd"}) {
        writeBytes("a.nrrd", magic + nrrd().substr(8) + "\n" + data());
        expectRefused(
            "a.nrrd: got no NRRD header; expected a file that begins with NRRD0001 to NRRD0005",
            "a.nrrd");
    }
}

// What anybody may add does not matter: keys named like fields, long lines, odd characters.
TEST(ReadNrrd, LinesOfOthers) {
    const TempFolder folder;
    const std::string million(1000000, 'm');
    writeBytes("a.nrrd", nrrd() + "content: " + million + "\n# " + million +
                             "\nhistory:=" + million + "\n\n" + data());
    expectSample(readVolume("a.nrrd"));
    for (const std::string line :
         {"type:=double", "sizes:=9 9 9", "space:=RAS", "space directions:=(1,0,0): no", "kinds:=a",
          "data file:=b.raw", "encoding:=gzip", "Data File:=b.raw", "a key: with a sign:=x",
          "key:=x\rdata file: b.raw", "# x\rdata file: b.raw", "key:=\x1b(B"}) {
        writeBytes("a.nrrd", nrrd() + line + "\n\n" + data());
        expectSample(readVolume("a.nrrd"));
    }
    // The last line of a header alone need not end.
    writeBytes("b.raw", data());
    writeBytes("b.nhdr", nrrd() + "data file: b.raw");
    expectSample(readVolume("b.nhdr"));
}

// Packed or plain is what the bytes are, for the whole file and for the values.
TEST(ReadNrrd, PackedByContent) {
    const TempFolder folder;
    writeGzip("values.gz", data());
    const std::string packed = nrrd({{"encoding", "gzip"}}) + "\n" + readBytes("values.gz");
    writeGzip("a.nrrd.gz", nrrd() + "\n" + data());
    writeGzip("b.nrrd.gz", packed);
    writeGzip("c.nrrd", nrrd() + "\n" + data());
    writeBytes("d.nrrd.gz", packed);
    std::string numbers;
    for (int i = 0; i < 24; ++i) numbers += std::to_string(i) + "\n";
    writeGzip("e.nrrd.gz", nrrd({{"encoding", "ascii"}}) + "\n" + numbers);
    writeGzip("f.raw", data());
    writeBytes("f.nhdr", nrrd({{"data file", "f.raw"}}));
    writeBytes("g.raw.gz", data());
    writeBytes("g.nhdr", nrrd({{"encoding", "gzip"}, {"data file", "g.raw.gz"}}));
    for (const char* const name :
         {"a.nrrd.gz", "b.nrrd.gz", "c.nrrd", "d.nrrd.gz", "e.nrrd.gz", "f.nhdr", "g.nhdr"}) {
        SCOPED_TRACE(name);
        expectSample(readVolume(name));
        EXPECT_EQ(readVolume(name).name(), std::string(1, name[0]));
    }
    const std::string whole = readBytes("a.nrrd.gz");
    writeBytes("h.nrrd.gz", whole.substr(0, whole.size() - 6));
    expectRefused("h.nrrd.gz: got a gzip stream that is cut short; expected a whole one",
                  "h.nrrd.gz");
}

TEST(ReadNrrd, Hex) {
    const TempFolder folder;
    std::string digits;
    for (int i = 0; i < 24; ++i) {
        char text[8];
        std::snprintf(text, sizeof text, i % 5 == 0 ? "%04X\n" : "%04x", i);
        digits += text;
    }
    writeBytes("a.nrrd", nrrd({{"encoding", "hex"}, {"endian", "big"}}) + "\n" + digits);
    expectSample(readVolume("a.nrrd"));
    writeBytes("a.nrrd", nrrd({{"encoding", "hex"}, {"endian", "big"}}) + "\n" +
                             digits.substr(0, digits.size() - 1) + "x");
    expectRefused("a.nrrd: got \"x\" among hex digits; expected enough numbers for 4x3x2 uint16",
                  "a.nrrd");
}

// Places of axes: ranges and centres as the format's definition has them.
TEST(ReadNrrd, AxisRanges) {
    const TempFolder folder;
    const std::vector<std::pair<std::string, std::string>> plain{{"space", ""},
                                                                 {"space directions", ""},
                                                                 {"space origin", ""},
                                                                 {"axis mins", "0 10 100"},
                                                                 {"axis maxs", "8 16 104"}};
    for (const auto& [centers, sizes, first] :
         {std::tuple{"cell cell cell", glm::dvec3(2, 2, 2), glm::dvec3(1, 11, 101)},
          {"node node node", glm::dvec3(8.0 / 3, 3, 4), glm::dvec3(0, 10, 100)},
          {"", glm::dvec3(2, 2, 2), glm::dvec3(1, 11, 101)}}) {
        auto changes = plain;
        changes.emplace_back("centers", centers);
        writeBytes("a.nrrd", nrrd(changes) + "\n" + data());
        EXPECT_EQ(readVolume("a.nrrd").voxelSize(), sizes);
        EXPECT_EQ(glm::dvec3(readVolume("a.nrrd").worldFromIndex()[3]), first);
    }
}

std::string segment(int number, const std::string& fields) {
    std::string lines;
    std::istringstream in(fields);
    for (std::string field; std::getline(in, field, ';');)
        lines += "Segment" + std::to_string(number) + "_" + field + "\n";
    return lines;
}

TEST(ReadNrrd, SegmentsAreLabels) {
    const TempFolder folder;
    // In the order of their numbers, whatever the order of their lines.
    writeBytes("a.seg.nrrd", nrrd() + segment(10, "ID:=c;LabelValue:=7;Layer:=0") +
                                 segment(0,
                                         "ID:=a;Name:=liver, left\\nlobe;Color:=0.5 0.25 1;"
                                         "LabelValue:=3;Extent:=0 3 0 2 0 1") +
                                 segment(2, "ID:=b;Name:=kidney;LabelValue:=1") + "\n" + data());
    const Volume volume = readVolume("a.seg.nrrd");
    EXPECT_EQ(volume.name(), "a.seg");
    ASSERT_TRUE(volume.labels());
    EXPECT_EQ(
        volume.labels()->entries,
        (std::vector<LabelEntry>{
            {3, "liver, left\nlobe", glm::dvec3(0.5, 0.25, 1)}, {1, "kidney", {}}, {7, "c", {}}}));
    EXPECT_EQ(valuesOf(volume), kRamp);
    writeBytes("b.nrrd", nrrd() + "\n" + data());
    EXPECT_FALSE(readVolume("b.nrrd").labels());
    writeBytes("c.nrrd", nrrd() + "intent_code:=1002\n\n" + data());
    ASSERT_TRUE(readVolume("c.nrrd").labels());
    EXPECT_TRUE(readVolume("c.nrrd").labels()->entries.empty());
    // Shares of voxels are amounts.
    writeBytes("d.seg.nrrd", nrrd() + segment(0, "ID:=a") +
                                 "Segmentation_MasterRepresentation:=Fractional labelmap\n\n" +
                                 data());
    EXPECT_FALSE(readVolume("d.seg.nrrd").labels());
}

// Two layers of 2x2x2 voxels, side by side; later segments lie on top.
TEST(ReadNrrd, LayersOfSegments) {
    const TempFolder folder;
    const std::vector<std::pair<std::string, std::string>> four{
        {"type", "uchar"},
        {"dimension", "4"},
        {"sizes", "2 2 2 2"},
        {"kinds", "list domain domain domain"},
        {"space directions", "none (2,0,0) (0,3,0) (0,0,4)"}};
    const std::string first("\0\1\2\1\0\2\1\0", 8), second("\0\0\1\1\1\0\2\3", 8);
    std::string both;
    for (int i = 0; i < 8; ++i) both += {first[std::size_t(i)], second[std::size_t(i)]};
    const std::string liver = segment(0, "ID:=a;Name:=liver;LabelValue:=1;Layer:=0");
    const std::string vein = segment(1, "ID:=b;Name:=vein;LabelValue:=1;Layer:=1");
    const std::string tumor = segment(2, "ID:=c;Name:=tumor;LabelValue:=2;Layer:=0");
    const std::string other = segment(3, "ID:=d;Name:=other;LabelValue:=2;Layer:=1");
    const std::string header = nrrd(four) + liver + vein + tumor + other;
    for (const bool packed : {false, true}) {
        writeGzip("values.gz", both);
        auto changes = four;
        if (packed) changes.emplace_back("encoding", "gzip");
        writeBytes("a.seg.nrrd", nrrd(changes) + liver + vein + tumor + other + "\n" +
                                     (packed ? readBytes("values.gz") : both));
        Warnings warnings;
        const Volume volume = readVolume("a.seg.nrrd", {}, warnings.listener());
        // Numbers of segments; the 3 of the second layer is no segment's.
        EXPECT_EQ(valuesOf(volume), (std::vector<double>{0, 1, 3, 2, 2, 3, 4, 0}));
        EXPECT_EQ(volume.labels()->entries,
                  (std::vector<LabelEntry>{
                      {1, "liver", {}}, {2, "vein", {}}, {3, "tumor", {}}, {4, "other", {}}}));
        EXPECT_EQ(warnings.lines,
                  (std::vector<std::string>{
                      "a.seg.nrrd: 2 layers of segments are read as one, with later segments on "
                      "top, numbered from 1 to 4 as layers share numbers (one layer: `volume` 0 to "
                      "1)",
                      "a.seg.nrrd: 1 value of layers has no segment, and counts as nothing"}));
        EXPECT_EQ(volume.worldFromIndex(),
                  glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
        for (const std::int64_t layer : {0, 1}) {
            ReadOptions options;
            options.volume = layer;
            const Volume one = readVolume("a.seg.nrrd", options);
            std::vector<double> values;
            for (const char c : layer == 0 ? first : second) values.push_back(double(c));
            EXPECT_EQ(valuesOf(one), values);
            EXPECT_EQ(one.labels()->entries,
                      layer == 0 ? (std::vector<LabelEntry>{{1, "liver", {}}, {2, "tumor", {}}})
                                 : (std::vector<LabelEntry>{{1, "vein", {}}, {2, "other", {}}}));
        }
    }
    // Numbers of which each means one label stay.
    writeBytes("b.seg.nrrd", nrrd(four) + liver + tumor +
                                 segment(7, "ID:=d;Name:=bone;LabelValue:=3;Layer:=1") + "\n" +
                                 both);
    EXPECT_EQ(valuesOf(readVolume("b.seg.nrrd")), (std::vector<double>{0, 1, 2, 1, 0, 2, 1, 3}));
    ReadOptions third;
    third.volume = 2;
    expectRefused(
        "b.seg.nrrd: got no volume 2 among 2 volumes (sizes 2x2x2x2); expected `volume` "
        "0 to 1",
        "b.seg.nrrd", third);
    // A list that is none of segments has one chosen.
    writeBytes("c.nrrd", nrrd(four) + "\n" + both);
    expectRefused("c.nrrd: got 2 volumes (sizes 2x2x2x2); expected one, chosen by `volume` 0 to 1",
                  "c.nrrd");
    // As the slowest axis: volumes one behind the other.
    auto behind = four;
    behind[3] = {"kinds", "domain domain domain list"};
    behind[4] = {"space directions", "(2,0,0) (0,3,0) (0,0,4) none"};
    writeBytes("d.nrrd", nrrd(behind) + "\n" + first + second);
    ReadOptions options;
    options.volume = 1;
    EXPECT_EQ(valuesOf(readVolume("d.nrrd", options)),
              (std::vector<double>{0, 0, 1, 1, 1, 0, 2, 3}));
    behind.emplace_back("encoding", "ascii");
    writeBytes("e.nrrd", nrrd(behind) + "\n0 1 2 1 0 2 1 0 0 0 1 1 1 0 2 3\n");
    EXPECT_EQ(valuesOf(readVolume("e.nrrd", options)),
              (std::vector<double>{0, 0, 1, 1, 1, 0, 2, 3}));
}

TEST(ReadNrrd, LinesEndWithCrLf) {
    const TempFolder folder;
    std::string text;
    const std::string long_value =
        "# " + std::string(5000, 'c') + "\nlong:=" + std::string(5000, 'v');
    for (const char c :
         nrrd() + long_value + "\nData File: b.raw\nSpaceUnits: \"mm\" \"mm\" \"mm\"\n")
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
    expectRefused("c.nrrd: got 49 bytes unpacked; expected 48 (4x3x2 uint16)", "c.nrrd");
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
