// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <zlib.h>
#include <random>

#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

const std::vector<double> kRamp = ramp<double>(24);

struct Meta {
    int axes = 3;
    std::string binary = "True";
    std::string msb = "False";
    std::string packed = "False";
    std::string matrix = "1 0 0 0 1 0 0 0 1";
    std::string offset = "10 20 30";
    std::string spacing = "2 3 4";
    std::string sizes = "4 3 2";
    std::string type = "MET_USHORT";
    std::string more;
    std::string dataFile = "LOCAL";

    std::string text() const {
        return "ObjectType = Image\nNDims = " + std::to_string(axes) + "\nBinaryData = " + binary +
               "\nBinaryDataByteOrderMSB = " + msb + "\nCompressedData = " + packed +
               "\nTransformMatrix = " + matrix + "\nOffset = " + offset +
               "\nElementSpacing = " + spacing + "\nDimSize = " + sizes +
               "\nElementType = " + type + "\n" + more + "ElementDataFile = " + dataFile + "\n";
    }
};

std::string data(bool bigEndian = false) {
    return bytesOf(ramp<std::uint16_t>(24), bigEndian);
}

std::string packed(const std::string& bytes) {
    std::string out(bytes.size() + 100, '\0');
    uLongf size = out.size();
    compress(reinterpret_cast<Bytef*>(out.data()), &size,
             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    out.resize(size);
    return out;
}

void expectSample(const Volume& volume) {
    EXPECT_EQ(volume.type(), "uint16");
    EXPECT_EQ(volume.space(), "");
    EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 2));
    EXPECT_EQ(volume.worldFromIndex(),
              glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
    EXPECT_EQ(valuesOf(volume), kRamp);
}

TEST(ReadMeta, LocalAndDetached) {
    const TempFolder folder;
    Meta meta;
    writeBytes("a.mha", meta.text() + data());
    expectSample(readVolume("a.mha"));
    std::filesystem::create_directory("sub");
    writeBytes("sub/values.raw", data());
    meta.dataFile = "values.raw";
    writeBytes("sub/b.mhd", meta.text());
    const Volume volume = readVolume("sub/b.mhd");
    EXPECT_EQ(volume.name(), "b");
    expectSample(volume);
    for (const auto& [size, bytes] : {std::pair{"5", "12345" + data()}, {"-1", "abc" + data()}}) {
        writeBytes("sub/values.raw", bytes);
        meta.more = "HeaderSize = " + std::string(size) + "\n";
        writeBytes("sub/c.mhd", meta.text());
        expectSample(readVolume("sub/c.mhd"));
    }
}

TEST(ReadMeta, BigEndian) {
    const TempFolder folder;
    Meta meta;
    meta.msb = "True";
    writeBytes("a.mha", meta.text() + data(true));
    expectSample(readVolume("a.mha"));
}

TEST(ReadMeta, PackedAndText) {
    const TempFolder folder;
    Meta meta;
    meta.packed = "True";
    meta.dataFile = "values.zraw";
    writeBytes("values.zraw", packed(data()));
    writeBytes("c.mhd", meta.text());
    expectSample(readVolume("c.mhd"));
    meta.more = "CompressedDataSize = " + std::to_string(packed(data()).size()) + "\n";
    meta.dataFile = "LOCAL";
    writeBytes("a.mha", meta.text() + packed(data()));
    expectSample(readVolume("a.mha"));
    meta = {};
    meta.binary = "False";
    std::string numbers;
    for (int i = 0; i < 24; ++i) numbers += std::to_string(i) + "\n";
    writeBytes("b.mha", meta.text() + numbers);
    expectSample(readVolume("b.mha"));
}

template <typename T>
void expectType(const std::string& metaName, const std::string& name) {
    for (const bool bigEndian : {false, true}) {
        Meta meta;
        meta.type = metaName;
        meta.msb = bigEndian ? "True" : "False";
        writeBytes("a.mha", meta.text() + bytesOf(ramp<T>(24, 2, 3), bigEndian));
        const Volume volume = readVolume("a.mha");
        EXPECT_EQ(volume.type(), name);
        EXPECT_EQ(valuesOf(volume), ramp<double>(24, 2, 3)) << name;
    }
}

TEST(ReadMeta, Types) {
    const TempFolder folder;
    expectType<std::uint8_t>("MET_UCHAR", "uint8");
    expectType<std::int8_t>("MET_CHAR", "int8");
    expectType<std::uint16_t>("MET_USHORT", "uint16");
    expectType<std::int16_t>("MET_SHORT", "int16");
    expectType<std::uint32_t>("MET_UINT", "uint32");
    expectType<std::int32_t>("MET_INT", "int32");
    expectType<std::uint64_t>("MET_ULONG_LONG", "uint64");
    expectType<std::int64_t>("MET_LONG_LONG", "int64");
    expectType<float>("MET_FLOAT", "float32");
    expectType<double>("MET_DOUBLE", "float64");
}

TEST(ReadMeta, Directions) {
    const TempFolder folder;
    Meta meta;
    meta.matrix = "0 1 0 -1 0 0 0 0 -1";
    writeBytes("a.mha", meta.text() + data());
    EXPECT_EQ(readVolume("a.mha").worldFromIndex(),
              glm::dmat4(0, 2, 0, 0, -3, 0, 0, 0, 0, 0, -4, 0, 10, 20, 30, 1));
}

// Layers of 8 slices are read one by one.
TEST(ReadMeta, ManySlices) {
    const TempFolder folder;
    for (const bool bigEndian : {false, true}) {
        Meta meta;
        meta.sizes = "9 7 37";
        meta.msb = bigEndian ? "True" : "False";
        writeBytes("a.mha", meta.text() + bytesOf(ramp<std::uint16_t>(9 * 7 * 37), bigEndian));
        EXPECT_EQ(valuesOf(readVolume("a.mha")), ramp<double>(9 * 7 * 37));
    }
}

TEST(ReadMeta, TwoAndFourAxes) {
    const TempFolder folder;
    Meta meta;
    meta.axes = 2;
    meta.matrix = "1 0 0 1";
    meta.offset = "10 20";
    meta.spacing = "2 3";
    meta.sizes = "4 6";
    writeBytes("a.mha", meta.text() + data());
    EXPECT_EQ(readVolume("a.mha").box().dims(), glm::ivec3(4, 6, 1));
    EXPECT_EQ(valuesOf(readVolume("a.mha")), kRamp);
    meta.axes = 4;
    meta.matrix = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    meta.offset = "10 20 30 40";
    meta.spacing = "2 3 4 5";
    meta.sizes = "4 3 2 1";
    writeBytes("b.mha", meta.text() + data());
    expectSample(readVolume("b.mha"));
}

void expectRefusedMeta(const std::string& message, const Meta& meta, const std::string& bytes) {
    writeBytes("a.mha", meta.text() + bytes);
    expectRefused("a.mha: " + message, "a.mha");
}

// Axes behind the third that is longer than a voxel count volumes.
TEST(ReadMeta, SeveralVolumes) {
    const TempFolder folder;
    Meta meta;
    meta.axes = 6;
    meta.sizes = "4 3 1 2 3 2";
    meta.offset = "10 20 0 30 40 50";
    meta.spacing = "2 3 9 4 5 6";
    meta.matrix = "1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1";
    const std::vector<std::uint16_t> values = ramp<std::uint16_t>(24 * 6);
    std::string numbers;
    for (const int value : values) numbers += std::to_string(value) + " ";
    writeBytes("raw.mha", meta.text() + bytesOf(values));
    meta.packed = "True";
    writeBytes("packed.mha", meta.text() + packed(bytesOf(values)));
    meta.packed = "False";
    meta.binary = "False";
    writeBytes("text.mha", meta.text() + numbers);
    for (const std::string file : {"raw.mha", "packed.mha", "text.mha"}) {
        SCOPED_TRACE(file);
        expectRefused(file +
                          ": got 6 volumes (sizes 4x3x1x2x3x2); expected one, chosen by "
                          "`volume` 0 to 5",
                      file);
        ReadOptions options;
        for (const int chosen : {0, 1, 5}) {
            options.volume = chosen;
            const Volume volume = readVolume(file, options);
            EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 2));
            EXPECT_EQ(volume.worldFromIndex(),
                      glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
            EXPECT_EQ(valuesOf(volume), ramp<double>(24, 24 * chosen));
        }
        writeBytes("cut" + file, readBytes(file).substr(0, readBytes(file).size() - 20));
        options.volume = 5;
        expectInputError("cut" + file, options);
    }
    meta = {};
    meta.axes = 5;
    meta.sizes = "2 2 2 1073741824 1073741824";
    expectRefusedMeta("got sizes 2x2x2x1073741824x1073741824; expected at most 1073741824 volumes",
                      meta, "");
}

TEST(ReadMetaError, Headers) {
    const TempFolder folder;
    Meta meta;
    meta.sizes = "4 -3 2";
    expectRefusedMeta("got sizes 4 -3 2; expected whole numbers from 1 to 1073741824", meta,
                      data());
    meta.sizes = "4 x 2";
    expectRefusedMeta("got sizes 4 x 2; expected whole numbers from 1 to 1073741824", meta, data());
    meta = {};
    for (const int axes : {30, 1000000, 2147483647, 0, -1, 2}) {
        meta.axes = axes;
        expectRefusedMeta(
            "got NDims = " + std::to_string(axes) + "; expected 3, as many as there are sizes",
            meta, data());
    }
    meta = {};
    meta.type = "MET_FOO";
    expectRefusedMeta("got values of type MET_FOO; expected whole or real numbers", meta, data());
    meta = {};
    meta.more = "ElementNumberOfChannels = 3\n";
    expectRefusedMeta("got 3 values a voxel (vector); expected one", meta,
                      data() + data() + data());
    meta = {};
    meta.more = "NDims = 3\n";
    expectRefusedMeta("got the field ndims twice; expected each field once", meta, data());
    meta = {};
    meta.matrix = "1 0 0 0 1 0";
    expectRefusedMeta("got transformmatrix 1 0 0 0 1 0; expected 9 numbers", meta, data());
    writeBytes("b.mha", "garbage");
    expectRefused("b.mha: got the header line \"garbage\"; expected \"Name = value\"", "b.mha");
    writeBytes("c.mha", std::string(1100000, 'x'));
    expectRefused("c.mha: got a header without end; expected a text header", "c.mha");
    writeBytes("d.mha", "");
    expectRefused("d.mha: got no ElementDataFile; expected a MetaImage header that ends with one",
                  "d.mha");
}

// Fields are known by their exact names; what is spelled otherwise is read by some programs.
TEST(ReadMetaError, FieldsThatProgramsReadDifferently) {
    const TempFolder folder;
    writeBytes("a.raw", data());
    writeBytes("b.raw", data(true));
    const auto refused = [](const std::string& got, const std::string& expected,
                            const std::string& lines) {
        Meta meta;
        meta.more = lines;
        meta.dataFile = "b.raw";
        expectRefusedMeta("got " + got + "; expected " + expected, meta, "");
    };
    const auto misspelled = [&](const std::string& line, const std::string& name) {
        refused("the header line \"" + line + "\"", "\"" + name + " = value\"", line + "\n");
    };
    misspelled("elementdatafile = a.raw", "ElementDataFile");
    misspelled("Element Data File = a.raw", "ElementDataFile");
    misspelled("ELEMENTDATAFILE = LOCAL", "ElementDataFile");
    misspelled("ndims = 3", "NDims");
    misspelled("Dim Size = 4 3 2", "DimSize");
    misspelled("HeaderSize = = 0", "HeaderSize");
    misspelled("ElementDataFile: a.raw", "Name");
    misspelled(" = a.raw", "Name");
    refused("control characters in the header line \"Position = 1 2 3?ElementDataFile = a.raw\"",
            "lines of text", "Position = 1 2 3\rElementDataFile = a.raw\n");
}

TEST(ReadMetaError, DataElsewhere) {
    const TempFolder folder;
    Meta meta;
    writeBytes("lOcal", data());
    meta.dataFile = "lOcal";
    expectRefusedMeta("got data in \"lOcal\"; expected LOCAL or the name of one data file", meta,
                      data());
    std::filesystem::create_directory("in");
    for (const char* const name : {"~a.raw", "c:a.raw", ":a.raw"}) {
        writeBytes(name, data());
        meta.dataFile = name;
        writeBytes("in/a.mhd", meta.text());
        EXPECT_THROW(readVolume("in/a.mhd"), Error) << name;
    }
    for (const char* const name : {"Local", "local"}) {
        meta.dataFile = name;
        writeBytes("a.mha", meta.text() + data());
        expectSample(readVolume("a.mha"));
    }
    writeBytes("a.raw\xc3\xa9", data());
    meta.dataFile = "a.raw\xc3\xa9";
    writeBytes("b.mhd", meta.text());
    expectSample(readVolume("b.mhd"));
}

// What anybody may add does not matter: tags of scanners, long lines, fields twice.
TEST(ReadMeta, LinesOfOthers) {
    const TempFolder folder;
    Meta meta;
    meta.more = "0008|103e = Thorax: routine = 3\nComment = " + std::string(1000000, 'c') +
                "\nComment = = again\nTag_65027 = \x1b(B\rx\nObjectSubType = x\nfoo:bar = 1\n";
    writeBytes("a.mha", meta.text() + data());
    expectSample(readVolume("a.mha"));
    // The last line of a header alone need not end.
    meta.dataFile = "a.raw";
    writeBytes("a.raw", data());
    const std::string text = meta.text();
    writeBytes("b.mhd", text.substr(0, text.size() - 1));
    expectSample(readVolume("b.mhd"));
    // Nor the last line of text.
    meta = {};
    meta.binary = "False";
    std::string numbers;
    for (int i = 0; i < 24; ++i) numbers += std::to_string(i) + (i < 23 ? " " : "");
    writeBytes("c.mha", meta.text() + numbers);
    expectSample(readVolume("c.mha"));
    writeBytes("c.mha", meta.text() + numbers.substr(0, numbers.size() - 3));
    expectRefused("c.mha: got too few numbers; expected enough numbers for 4x3x2 uint16", "c.mha");
    writeBytes("c.mha", meta.text() + "x" + numbers.substr(1));
    expectRefused("c.mha: got \"x\" among numbers; expected values of type uint16", "c.mha");
}

// Lengths of a patient's space are millimetres, others what the file says.
TEST(ReadMeta, Units) {
    const TempFolder folder;
    const glm::dvec3 size(2, 3, 4), place(10, 20, 30);
    for (const auto& [said, unit, factor] : {std::tuple{"mm", "mm", 1.0},
                                             {"um", "um", 1e-3},
                                             {"cm", "cm", 10.0},
                                             {"MM", "mm", 1.0},
                                             {"?", "", 1.0}}) {
        for (const bool patient : {false, true}) {
            Meta meta;
            meta.more = "DistanceUnits = " + std::string(said) + "\n" +
                        (patient ? "AnatomicalOrientation = RAI\n" : "");
            writeBytes("a.mha", meta.text() + data());
            const Volume volume = readVolume("a.mha");
            EXPECT_EQ(volume.lengthUnit(), patient && *unit != '\0' ? "mm" : unit);
            for (int axis = 0; axis < 3; ++axis) {
                const double scale = patient ? factor : 1;
                EXPECT_DOUBLE_EQ(volume.voxelSize()[axis], scale * size[axis]) << said;
                EXPECT_DOUBLE_EQ(volume.worldFromIndex()[3][axis], scale * place[axis]) << said;
            }
        }
    }
}

// World space is LPS wherever an orientation is told; one that the directions do not have is not
// believed, and said.
TEST(ReadMeta, Orientation) {
    const TempFolder folder;
    for (const auto& [text, matrix, space, warned] :
         {std::tuple{"RAI", "1 0 0 0 1 0 0 0 1", "LPS", false},
          {"rai", "1 0 0 0 1 0 0 0 1", "LPS", false},
          {"LPS", "1 0 0 0 1 0 0 0 1", "LPS", true},
          {"RAS", "1 0 0 0 1 0 0 0 1", "LPS", true},
          {"???", "1 0 0 0 1 0 0 0 1", "", false},
          {"RRR", "1 0 0 0 1 0 0 0 1", "", false}}) {
        Meta meta;
        meta.matrix = matrix;
        meta.more = "AnatomicalOrientation = " + std::string(text) + "\n";
        writeBytes("a.mha", meta.text() + data());
        Warnings warnings;
        const Volume volume = readVolume("a.mha", {}, warnings.listener());
        EXPECT_EQ(volume.space(), space) << text;
        EXPECT_EQ(warnings.lines.size(), warned ? 1u : 0u) << text;
        EXPECT_EQ(volume.worldFromIndex()[0].x, 2);
    }
    // As it is written: i goes back, j to the right, k down.
    Meta meta;
    meta.matrix = "0 1 0 -1 0 0 0 0 -1";
    meta.more = "AnatomicalOrientation = ALS\n";
    writeBytes("b.mha", meta.text() + data());
    Warnings warnings;
    EXPECT_EQ(readVolume("b.mha", {}, warnings.listener()).space(), "LPS");
    EXPECT_EQ(warnings.lines, std::vector<std::string>());
}

// What is to be made of the stored numbers is made of them.
TEST(ReadMeta, SlopeAndOffset) {
    const TempFolder folder;
    for (const auto& [slope, offset] :
         {std::pair{"ElementToIntensityFunctionSlope = 2", "ElementToIntensityFunctionOffset = -5"},
          {"RescaleSlope = 2", "RescaleIntercept = -5"}}) {
        Meta meta;
        meta.more = std::string(slope) + "\n" + offset + "\n";
        writeBytes("a.mha", meta.text() + data());
        EXPECT_EQ(valuesOf(readVolume("a.mha")), ramp<double>(24, -5, 2));
        meta.more = std::string(offset) + "\n";
        writeBytes("a.mha", meta.text() + data());
        EXPECT_EQ(valuesOf(readVolume("a.mha")), ramp<double>(24, -5, 1));
    }
    // A slope of 0 is none.
    Meta meta;
    meta.more = "ElementToIntensityFunctionSlope = 0\nElementToIntensityFunctionOffset = 3\n";
    writeBytes("a.mha", meta.text() + data());
    EXPECT_EQ(valuesOf(readVolume("a.mha")), kRamp);
}

TEST(ReadMeta, PackedByContent) {
    const TempFolder folder;
    Meta meta;
    writeGzip("a.mha.gz", meta.text() + data());
    writeGzip("b.mha", meta.text() + data());
    writeBytes("c.mha.gz", meta.text() + data());
    meta.packed = "True";
    writeGzip("d.mha.gz", meta.text() + packed(data()));
    // Said to be packed, and not.
    writeBytes("e.mha", meta.text() + data());
    meta.packed = "False";
    meta.dataFile = "f.raw";
    writeGzip("f.raw", data());
    writeBytes("f.mhd", meta.text());
    for (const char* const name : {"a.mha.gz", "b.mha", "c.mha.gz", "d.mha.gz", "e.mha", "f.mhd"}) {
        SCOPED_TRACE(name);
        expectSample(readVolume(name));
    }
}

// What is said to be packed, and begins so, is not read as plain values that are as long.
TEST(ReadMeta, PackedAsLongAsPlain) {
    const TempFolder folder;
    Meta meta;
    meta.packed = "True";
    meta.type = "MET_UCHAR";
    // Noise, and as many equal bytes as save what packing adds.
    std::string values;
    std::minstd_rand random(5);
    for (int i = 0; i < 200; ++i) values += char(random() % 256);
    while (packed(values).size() != values.size()) {
        ASSERT_LT(values.size(), 400u);
        values += '\7';
    }
    meta.sizes = std::to_string(values.size()) + " 1 1";
    writeBytes("a.mha", meta.text() + packed(values));
    const std::vector<double> got = valuesOf(readVolume("a.mha"));
    ASSERT_EQ(got.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_EQ(got[i], double(static_cast<unsigned char>(values[i]))) << i;
}

TEST(ReadMeta, ASliceHasAThickness) {
    const TempFolder folder;
    Meta meta;
    meta.spacing = "2 3 0";
    meta.sizes = "4 6 1";
    writeBytes("a.mha", meta.text() + data());
    EXPECT_EQ(readVolume("a.mha").voxelSize(), glm::dvec3(2, 3, 1));
}

// As editors on Windows leave it, with what other programs add.
TEST(ReadMeta, LinesEndWithCrLf) {
    const TempFolder folder;
    Meta meta;
    meta.more = "Comment =\nName = a b: c\n0008|0060 = MR\nNRRD_measurement frame = (1,0,0)\n";
    meta.dataFile = "a.raw";
    std::string text;
    for (const char c : meta.text()) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    writeBytes("a.raw", data());
    writeBytes("a.mhd", text);
    expectSample(readVolume("a.mhd"));
}

TEST(ReadMetaError, Data) {
    const TempFolder folder;
    Meta meta;
    expectRefusedMeta("got 40 bytes of data; expected enough for 4x3x2 uint16", meta,
                      data().substr(0, 40));
    meta.sizes = "16384 8192 8192";
    expectRefusedMeta("got 48 bytes of data; expected enough for 16384x8192x8192 uint16", meta,
                      data());
    meta = {};
    meta.dataFile = "none.raw";
    expectRefusedMeta("got no data file \"none.raw\"; expected a readable file", meta, "");
    meta.dataFile = "LIST";
    expectRefusedMeta("got data in \"LIST\"; expected the name of one data file", meta, "a\nb\n");
    meta.dataFile = "slice%03d.raw 1 2 1";
    expectRefusedMeta("got data in \"slice%03d.raw 1 2 1\"; expected the name of one data file",
                      meta, "");
    meta = {};
    meta.more = "HeaderSize = 5\n";
    expectRefusedMeta("got HeaderSize 5 for data in the same file; expected 0", meta, data());
    meta.more = "HeaderSize = -1\n";
    meta.packed = "True";
    expectRefusedMeta(
        "got HeaderSize -1 for values that are packed or text; expected a number from 0 on", meta,
        packed(data()));
}

TEST(ReadMetaError, PackedData) {
    const TempFolder folder;
    Meta meta;
    meta.packed = "True";
    const std::string bytes = packed(data());
    expectRefusedMeta("got packed data that are cut short; expected sound data", meta,
                      bytes.substr(0, bytes.size() - 6));
    std::string damaged = bytes;
    damaged[damaged.size() - 2] = char(damaged[damaged.size() - 2] ^ 1);
    expectRefusedMeta("got corrupt packed data; expected sound data", meta, damaged);
    meta.sizes = "4 3 3";
    expectRefusedMeta("got 48 bytes unpacked; expected 72 (4x3x3 uint16)", meta, bytes);
    meta.sizes = "4 3 1";
    expectRefusedMeta("got 48 bytes unpacked; expected 24 (4x3x1 uint16)", meta, bytes);
    meta.sizes = "1024 1024 1024";
    expectRefusedMeta("got " + std::to_string(bytes.size()) +
                          " bytes of data; expected enough gzip for 1024x1024x1024 uint16",
                      meta, bytes);
    meta.sizes = "4 3 2";
    // Where packed data end is told by themselves.
    writeBytes("a.mha", meta.text() + bytes);
    expectSample(readVolume("a.mha"));
    meta.more = "CompressedDataSize = 1000000000000\n";
    writeBytes("a.mha", meta.text() + bytes);
    expectSample(readVolume("a.mha"));
}

TEST(ReadMetaError, NoPlaceInTheWorld) {
    const TempFolder folder;
    Meta meta;
    meta.spacing = "2 0 4";
    expectRefusedMeta(
        "got spacing and directions that cannot be inverted; expected finite numbers that give "
        "each voxel a place of its own",
        meta, data());
}

}  // namespace
}  // namespace deltasplat
