// SPDX-License-Identifier: Apache-2.0
// What the stored numbers of DICOM files mean.
#include <gtest/gtest.h>

#include <filesystem>

#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/make_volume.h"
#include "deltasplat/memory_limit.h"
#include "unit/dicom_helpers.h"
#include "unit/format_helpers.h"
#include "unit/lossless_jpeg.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

constexpr double kEmpty = -12345;  // stands for an inactive voxel below

// Returns all values, x fastest, those of inactive voxels as kEmpty.
std::vector<double> activeValues(const Volume& volume) {
    std::vector<double> values(std::size_t(volume.box().voxels()));
    std::vector<std::uint8_t> active(values.size());
    readVoxels(volume, volume.box(), values, active);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (active[i] == 0) values[i] = kEmpty;
    return values;
}

Volume readFile(const DicomFile& file, const Listener& listener = {},
                const ReadOptions& options = {}) {
    writeBytes("a.dcm", file.bytes());
    return readVolume("a.dcm", options, listener);
}

// A file whose values have to come from elsewhere than from a slope.
DicomFile withoutSlope() {
    DicomFile file;
    file.slope = file.intercept = "";
    return file;
}

using Lines = std::vector<std::string>;

DicomElement tableOf(std::vector<std::uint16_t> shape, const std::vector<std::uint16_t>& values) {
    return sequenceOf({{{0x00283002, wordsOf(shape)},
                        {0x00283004, {"LO", "OD"}},
                        {0x00283006, wordsOf(values)}}});
}

TEST(DicomValues, ModalityTable) {
    const TempFolder folder;
    DicomFile file = withoutSlope();
    file.more[0x00283000] = tableOf({3, 2, 16}, {100, 400, 60000});
    const Volume volume = readFile(file);
    EXPECT_EQ(volume.type(), "uint16");
    // Stored are 0 to 5; what lies before and behind the table has its ends' values.
    EXPECT_EQ(valuesOf(volume), (std::vector<double>{100, 100, 100, 400, 60000, 60000}));

    Warnings warnings;
    file.slope = "2";
    EXPECT_EQ(valuesOf(readFile(file, warnings.listener())), valuesOf(volume));
    EXPECT_EQ(warnings.lines,
              Lines{"a.dcm: values are those of its modality table; its rescale is not used"});
}

TEST(DicomValues, ModalityTableWithoutTypes) {
    const TempFolder folder;
    DicomFile file = withoutSlope();
    file.syntax = "1.2.840.10008.1.2";
    file.explicitTypes = false;
    file.more[0x00283000] = sequenceOf(
        {{{0x00283002, wordsOf({3, 2, 16})}, {0x00283006, wordsOf({100, 400, 60000})}}}, false);
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{100, 100, 100, 400, 60000, 60000}));
}

// The first number of a table has the sign of stored ones.
TEST(DicomValues, ModalityTableOfSignedNumbers) {
    const TempFolder folder;
    DicomFile file = withoutSlope();
    file.isSigned = true;
    file.pixels = {0xfffd, 0xfffe, 0xffff, 0, 1, 2};  // -3 to 2
    file.more[0x00283000] = tableOf({3, 0xfffe, 16}, {10, 20, 30});
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{10, 10, 20, 30, 30, 30}));
}

// Entries of 8 bits come in bytes or in words; 0 entries are 65536.
TEST(DicomValues, ModalityTableShapes) {
    const TempFolder folder;
    DicomFile file = withoutSlope();
    const auto withData = [](const std::vector<std::uint16_t>& shape, const DicomElement& data) {
        return sequenceOf({{{0x00283002, wordsOf(shape)}, {0x00283006, data}}});
    };
    const std::vector<double> six{9, 8, 7, 6, 5, 4};
    file.more[0x00283000] = withData({6, 0, 8}, {"OW", "\x09\x08\x07\x06\x05\x04"});
    EXPECT_EQ(valuesOf(readFile(file)), six);
    EXPECT_EQ(readVolume("a.dcm").type(), "int16");
    file.more[0x00283000] = withData({6, 0, 8}, wordsOf({9, 8, 7, 6, 5, 4}));
    EXPECT_EQ(valuesOf(readFile(file)), six);
    std::vector<std::uint16_t> all(65536);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = std::uint16_t(65535 - i);
    file.more[0x00283000] = withData({0, 0, 16}, {"OW", bytesOf(all)});
    EXPECT_EQ(valuesOf(readFile(file)),
              (std::vector<double>{65535, 65534, 65533, 65532, 65531, 65530}));
    file.more[0x00283000] = tableOf({7, 0, 16}, {1, 2, 3});
    writeBytes("a.dcm", file.bytes());
    expectRefused("a.dcm: got a table of 3 values; expected 7, as its LUTDescriptor says", "a.dcm");
    file.more[0x00283000] = tableOf({7, 0}, {1, 2, 3});
    writeBytes("a.dcm", file.bytes());
    expectRefused("a.dcm: got a table of values whose LUTDescriptor has 2 numbers; expected three",
                  "a.dcm");
}

TEST(DicomValues, DoseGridScaling) {
    const TempFolder folder;
    DicomFile file = withoutSlope();
    file.more[0x3004000e] = decimalText("0.25");
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{0, 0.25, 0.5, 0.75, 1, 1.25}));
}

// A dose is in frames, which lie along the normal as their offsets say, wherever those begin.
TEST(DicomValues, DoseOfSeveralFrames) {
    const TempFolder folder;
    DicomFile file = withoutSlope();
    file.frames = "3";
    file.pixels = ramp<std::uint16_t>(18);
    file.more[0x3004000e] = decimalText("2e-1");
    for (const std::string offsets : {"0\\2.5\\5", "30\\32.5\\35"}) {
        file.more[0x3004000c] = decimalText(offsets);
        const Volume volume = readFile(file);
        EXPECT_EQ(volume.box().dims(), glm::ivec3(3, 2, 3));
        EXPECT_EQ(volume.worldFromIndex(),
                  glm::dmat4(0.25, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 2.5, 0, 10, 20, 30, 1));
        EXPECT_EQ(valueAt(volume, 2, 1, 2), 17 * 0.2);
    }
    file.more[0x3004000c] = decimalText("0\\2.5");
    writeBytes("a.dcm", file.bytes());
    expectRefused(
        "a.dcm: got 3 frames in one file; expected one slice in each file, or frames that say "
        "where each lies",
        "a.dcm");
}

DicomTags realWorld(std::uint16_t first, std::uint16_t last) {
    return {{0x00409211, wordsOf({last})},
            {0x00409216, wordsOf({first})},
            {0x00409224, doublesOf({-3})},
            {0x00409225, doublesOf({0.5})}};
}

// Numbers outside of what is mapped mean nothing.
TEST(DicomValues, RealWorldValuesWhereThereIsNoOther) {
    const TempFolder folder;
    DicomFile file = withoutSlope();
    file.more[0x00409096] = sequenceOf({realWorld(1, 4)});
    Warnings warnings;
    const Volume volume = readFile(file, warnings.listener());
    EXPECT_EQ(activeValues(volume), (std::vector<double>{kEmpty, -2.5, -2, -1.5, -1, kEmpty}));
    EXPECT_EQ(warnings.lines,
              (Lines{"a.dcm: values are those of its real world value mapping, for there is no "
                     "other (0.5 * stored + -3)",
                     "a.dcm: 2 voxels hold what fills pictures up and count as nothing"}));
    file.slope = "1";
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{0, 1, 2, 3, 4, 5}));
}

TEST(DicomValues, RealWorldTable) {
    const TempFolder folder;
    DicomFile file = withoutSlope();
    DicomTags item = realWorld(0, 5);
    item.erase(0x00409224);
    item.erase(0x00409225);
    item[0x00409212] = doublesOf({1.5, 0, -1, 7, 8, 9});
    file.more[0x00409096] = sequenceOf({item});
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{1.5, 0, -1, 7, 8, 9}));
    item[0x00409212] = doublesOf({1.5, 0, -1});
    file.more[0x00409096] = sequenceOf({item});
    writeBytes("a.dcm", file.bytes());
    expectRefused("a.dcm: got a table of 3 real world values; expected 6", "a.dcm");
}

TEST(DicomValues, SlopesThatMakeAllValuesOne) {
    const TempFolder folder;
    DicomFile file;
    file.slope = "0";
    file.intercept = "-5";
    Warnings warnings;
    EXPECT_EQ(valuesOf(readFile(file, warnings.listener())),
              (std::vector<double>{-5, -4, -3, -2, -1, 0}));
    EXPECT_EQ(warnings.lines,
              Lines{"a.dcm: RescaleSlope is 0, which makes all values one; 1 is taken"});
    file = withoutSlope();
    file.more[0x3004000e] = decimalText("0.0");
    Warnings others;
    EXPECT_EQ(valuesOf(readFile(file, others.listener())), (std::vector<double>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(others.lines,
              Lines{"a.dcm: DoseGridScaling is 0, which makes all values one; 1 is taken"});
}

TEST(DicomValues, SlopesThatAreLostBesideTheirIntercept) {
    const TempFolder folder;
    DicomFile file;
    file.slope = "1e-30";
    file.intercept = "7";
    Warnings warnings;
    EXPECT_EQ(valuesOf(readFile(file, warnings.listener())), std::vector<double>(6, 7));
    EXPECT_EQ(warnings.lines, Lines{"a.dcm: its slope 1e-30 makes all values 7"});
}

TEST(DicomValues, PaddingIsNothing) {
    const TempFolder folder;
    DicomFile file;
    file.isSigned = true;
    file.intercept = "-24";
    file.slope = "2";
    file.pixels = {0xf830, 0xfc18, 40, 0xf830, 100, 60};  // -2000, -1000, ...
    file.more[0x00280120] = wordsOf({0xf830});
    Warnings warnings;
    const Volume volume = readFile(file, warnings.listener());
    EXPECT_EQ(volume.type(), "int32");
    EXPECT_EQ(activeValues(volume), (std::vector<double>{kEmpty, -2024, 56, kEmpty, 176, 96}));
    EXPECT_EQ(volume.activeCount(), 4u);
    EXPECT_EQ(volume.valueMin(), -2024);
    EXPECT_EQ(volume.valueMax(), 176);
    EXPECT_TRUE(volume.hasBackground());
    EXPECT_EQ(volume.background(), -2024);
    EXPECT_EQ(volume.box().dims(), glm::ivec3(3, 2, 1));
    EXPECT_EQ(volume.space(), "LPS");
    EXPECT_EQ(warnings.lines,
              Lines{"a.dcm: 2 voxels hold what fills pictures up and count as nothing"});
    EXPECT_EQ(listVolumes("a.dcm")[0].type, "int32");
    // Without types of values it is the pixels' sign that says what the padding is.
    file.syntax = "1.2.840.10008.1.2";
    file.explicitTypes = false;
    EXPECT_EQ(activeValues(readFile(file)), activeValues(volume));
}

// Declared but not there: a volume as any other.
TEST(DicomValues, PaddingThatNoVoxelHas) {
    const TempFolder folder;
    DicomFile file;
    file.more[0x00280120] = wordsOf({63536});
    Warnings warnings;
    const Volume volume = readFile(file, warnings.listener());
    EXPECT_EQ(volume.type(), "uint16");
    EXPECT_EQ(activeValues(volume), (std::vector<double>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(warnings.lines, Lines{});
}

TEST(DicomValues, PaddingAboveAllValues) {
    const TempFolder folder;
    DicomFile file;
    file.intercept = "-1024";
    file.pixels = {65535, 0, 1024, 65535, 2000, 3};
    file.more[0x00280120] = wordsOf({65535});
    const Volume volume = readFile(file);
    EXPECT_EQ(activeValues(volume), (std::vector<double>{kEmpty, -1024, 0, kEmpty, 976, -1021}));
    EXPECT_EQ(volume.valueMax(), 976);
}

// The limit of a range may lie above the value or below it.
TEST(DicomValues, PaddingRange) {
    const TempFolder folder;
    DicomFile file;
    file.isSigned = true;
    file.pixels = {0xfff6, 0xfff7, 0xfffb, 0xfffc, 0, 7};  // -10, -9, -5, -4, 0, 7
    const std::vector<double> expected{kEmpty, kEmpty, kEmpty, -4, 0, 7};
    file.more[0x00280120] = wordsOf({0xfff6});
    file.more[0x00280121] = wordsOf({0xfffb});
    EXPECT_EQ(activeValues(readFile(file)), expected);
    std::swap(file.more[0x00280120], file.more[0x00280121]);
    EXPECT_EQ(activeValues(readFile(file)), expected);
}

// Old files fill up with a number that has more bits than the pixels.
TEST(DicomValues, PaddingBeyondTheStoredBits) {
    const TempFolder folder;
    DicomFile file;
    file.more[0x00280101] = wordsOf({12});
    file.more[0x00280102] = wordsOf({11});
    file.more[0x00280120] = wordsOf({63536});  // 0xf830, of which 12 bits are 2096
    file.pixels = {63536, 2096, 0, 4095, 7, 63536};
    EXPECT_EQ(activeValues(readFile(file)),
              (std::vector<double>{kEmpty, 2096, 0, 4095, 7, kEmpty}));
}

// As in PET: each slice has a slope of its own, and padding is none of its values.
TEST(DicomValues, PaddingUnderSlopesOfEachSlice) {
    const TempFolder folder;
    std::filesystem::create_directory("scan");
    for (int i = 0; i < 2; ++i) {
        DicomFile file;
        file.position = "0\\0\\" + std::to_string(i);
        file.slope = i == 0 ? "0.5" : "0.125";
        file.more[0x00280120] = wordsOf({2});
        writeBytes("scan/" + std::to_string(i), file.bytes());
    }
    const Volume volume = readVolume("scan");
    EXPECT_EQ(volume.type(), "float64");
    EXPECT_EQ(activeValues(volume), (std::vector<double>{0, 0.5, kEmpty, 1.5, 2, 2.5, 0, 0.125,
                                                         kEmpty, 0.375, 0.5, 0.625}));
}

TEST(DicomValues, NothingButPadding) {
    const TempFolder folder;
    DicomFile file;
    file.pixels.assign(6, 9);
    file.more[0x00280120] = wordsOf({9});
    Warnings warnings;
    EXPECT_TRUE(readFile(file, warnings.listener()).empty());
    EXPECT_EQ(warnings.lines,
              (Lines{"a.dcm: no active voxels",
                     "a.dcm: 6 voxels hold what fills pictures up and count as nothing"}));
}

// What else is in a cell, as overlays are, is no part of a number.
TEST(DicomValues, StoredBits) {
    const TempFolder folder;
    DicomFile file;
    file.more[0x00280101] = wordsOf({12});
    file.more[0x00280102] = wordsOf({11});
    file.pixels = {0xf800, 0x0f0f, 0xafff, 0x5000, 0x0001, 0xf7ff};
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{2048, 3855, 4095, 0, 1, 2047}));
    file.isSigned = true;
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{-2048, -241, -1, 0, 1, 2047}));
    file.more[0x00280102] = wordsOf({15});
    file.pixels = {0x8000, 0xf0f5, 0xfffa, 0x0000, 0x0013, 0x7ff1};
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{-2048, -241, -1, 0, 1, 2047}));
}

std::string fromHex(const std::string& text) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2)
        bytes += char(std::stoi(text.substr(i, 2), nullptr, 16));
    return bytes;
}

// JPEG 2000 of 4x4 numbers of 13 bits, lossless: of 0 1 2 3 6192 8191 4095 4096 100 200 and six
// times 7 without a sign, or of what those bits are with one.
std::string wavelets(bool isSigned) {
    return fromHex(
        "ff4fff51002900000000000400000004000000000000000000000004000000040000000000000000"
        "0001" +
        std::string(isSigned ? "8c" : "0c") +
        "0101ff52000c00000001000004040001ff5c00044068ff90000a00000000" +
        std::string(
            isSigned ? "00240001ff93dff8009020259fe2c7b6578b5453b1035c9918aa29d8ffd9"
                     : "00290001ff93dff800b8120566349937dc7b8bb9c5a1bf44bee2f77e7950cce2adffd9"));
}

DicomFile packedFile(int bits, bool isSigned, const std::string& stream) {
    DicomFile file;
    file.columns = file.rows = 4;
    file.syntax = "1.2.840.10008.1.2.4.90";
    file.isSigned = isSigned;
    file.more[0x00280101] = wordsOf({std::uint16_t(bits)});
    file.more[0x00280102] = wordsOf({std::uint16_t(bits - 1)});
    file.fragments = {stream};
    return file;
}

TEST(DicomValues, SignOfPackedPixels) {
    const TempFolder folder;
    std::vector<double> plain{0, 1, 2, 3, 6192, 8191, 4095, 4096, 100, 200, 7, 7, 7, 7, 7, 7};
    std::vector<double> withSign = plain;
    for (double& value : withSign)
        if (value >= 4096) value -= 8192;
    for (const bool streamSigned : {false, true}) {
        // The header may give numbers more bits than the packed picture has.
        for (const int bits : {13, 16}) {
            EXPECT_EQ(valuesOf(readFile(packedFile(bits, true, wavelets(streamSigned)))), withSign)
                << streamSigned << bits;
            EXPECT_EQ(valuesOf(readFile(packedFile(bits, false, wavelets(streamSigned)))), plain)
                << streamSigned << bits;
        }
    }
}

// Sixteen bits in a picture, of which the header knows fourteen.
TEST(DicomValues, PackedPicturesOfMoreBits) {
    const TempFolder folder;
    DicomFile file;
    file.columns = 2;
    file.rows = 2;
    file.syntax = "1.2.840.10008.1.2.4.70";
    file.more[0x00280101] = wordsOf({14});
    file.more[0x00280102] = wordsOf({13});
    file.fragments = {losslessJpeg(2, 2, {0xfff0, 0x1fff, 7, 0xe000})};
    file.isSigned = true;
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{-16, 8191, 7, -8192}));
}

// A decoder would take the size at its word.
TEST(DicomValuesError, PackedPicturesOfOtherSizes) {
    const TempFolder folder;
    const auto refusedWith = [](DicomFile file, const std::string& got, const std::string& size) {
        writeBytes("a.dcm", file.bytes());
        expectRefused("a.dcm: got a packed picture of " + got + "; expected " + size +
                          " of one number, as the header says",
                      "a.dcm");
    };
    std::string stream = wavelets(false);
    stream.replace(8, 8, std::string("\x03\xe7\xff\x18\x03\xe7\xff\x18", 8));
    refusedWith(packedFile(13, false, stream), "65535768x65535768 pixels of 1 numbers of 13 bits",
                "4x4");
    // The same within the boxes of a file.
    const std::string box = std::string("\0\0\0\x0cjP  \r\n\x87\n\0\0\0\0jp2c", 20);
    refusedWith(packedFile(13, false, box + stream),
                "65535768x65535768 pixels of 1 numbers of 13 bits", "4x4");
    DicomFile file = packedFile(16, false, losslessJpeg(40, 30, ramp<std::uint16_t>(1200)));
    file.syntax = "1.2.840.10008.1.2.4.70";
    refusedWith(file, "40x30 pixels of 1 numbers of 16 bits", "4x4");
    file.fragments = {"no picture"};
    writeBytes("a.dcm", file.bytes());
    expectRefused(
        "a.dcm: got packed pixels that do not begin as a JPEG picture does; expected the pixels "
        "that the header names",
        "a.dcm");
}

TEST(DicomValues, LowIsBright) {
    const TempFolder folder;
    DicomFile file;
    file.photometric = "MONOCHROME1";
    Warnings warnings;
    EXPECT_EQ(valuesOf(readFile(file, warnings.listener())),
              (std::vector<double>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(warnings.lines,
              Lines{"a.dcm: MONOCHROME1, low values meant to be bright: values stay as they are"});
}

// What fills a file up is no picture; another picture would be lost.
TEST(DicomValuesError, MorePicturesThanFrames) {
    const TempFolder folder;
    DicomFile file;
    file.pixels = ramp<std::uint16_t>(11);
    EXPECT_EQ(valuesOf(readFile(file)), (std::vector<double>{0, 1, 2, 3, 4, 5}));
    file.pixels = ramp<std::uint16_t>(18);
    const std::string expected = " by the header, which does not say what the others are";
    writeBytes("a.dcm", file.bytes());
    expectRefused("a.dcm: got 3 pictures of 3x2; expected 1" + expected, "a.dcm");
    file = packedFile(13, false, wavelets(false));
    file.fragments.push_back(wavelets(false));
    writeBytes("a.dcm", file.bytes());
    expectRefused("a.dcm: got 2 pictures of 4x4; expected 1" + expected, "a.dcm");
    // A picture in two pieces.
    const std::string whole = wavelets(false);
    file.fragments = {whole.substr(0, 60), whole.substr(60)};
    EXPECT_EQ(valueAt(readFile(file), 0, 1, 0), 6192);
}

// An entry of the table of texts that Siemens writes.
// @param added  what the first version of tables adds to lengths
std::string entryOf(const std::string& name, const std::vector<std::string>& items,
                    std::uint32_t added = 0) {
    std::string entry = name + std::string(64 - name.size(), '\0');
    entry += bytesOf<std::uint32_t>({1}) + std::string("FD\0\0", 4) +
             bytesOf<std::uint32_t>({4, std::uint32_t(items.size()), 77});
    for (std::string item : items) {
        const auto length = std::uint32_t(item.size());
        item.resize((item.size() + 3) / 4 * 4);
        entry += bytesOf<std::uint32_t>({length + added, length, 77, length}) + item;
    }
    return entry;
}

std::string firstTableOfTexts(const std::string& normalZ) {
    return bytesOf<std::uint32_t>({3, 77}) + entryOf("EchoLinePosition", {"1", "22"}, 2) +
           entryOf("NumberOfImagesInMosaic", {"3"}, 2) +
           entryOf("SliceNormalVector", {"0.0", "0.0", normalZ}, 2);
}

std::string tableOfTexts(int slices, const std::string& normalZ) {
    return "SV10" + std::string("\4\3\2\1", 4) + bytesOf<std::uint32_t>({2, 77}) +
           entryOf("NumberOfImagesInMosaic", {std::to_string(slices) + "      "}) +
           entryOf("SliceNormalVector", {"0.0", "0.0", normalZ});
}

// Three slices of 2x2 in 4x4: 0 1 | 2 3 over 4 5 | 6 7, ...
DicomFile mosaic(const std::string& normalZ) {
    DicomFile file;
    file.columns = file.rows = 4;
    file.pixels = ramp<std::uint16_t>(16);
    file.more[0x00080008] = {"CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC"};
    file.more[0x00180088] = decimalText("3");
    file.more[0x00290010] = {"LO", "SIEMENS CSA HEADER"};
    file.more[0x00291010] = {"OB", tableOfTexts(3, normalZ)};
    return file;
}

TEST(DicomValues, MosaicsAreTakenApart) {
    const TempFolder folder;
    const std::vector<double> up{0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13};
    Volume volume = readFile(mosaic("1.0"));
    EXPECT_EQ(volume.box().dims(), glm::ivec3(2, 2, 3));
    EXPECT_EQ(valuesOf(volume), up);
    // In the middle of 4x4 voxels of 0.25 x 0.5 from (10, 20, 30) on.
    EXPECT_EQ(volume.worldFromIndex(),
              glm::dmat4(0.25, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 3, 0, 10.25, 20.5, 30, 1));
    // Slices that follow against the normal of rows and columns.
    volume = readFile(mosaic("-1.0"));
    EXPECT_EQ(volume.worldFromIndex()[2], glm::dvec4(0, 0, 3, 0));
    EXPECT_EQ(volume.worldFromIndex()[3], glm::dvec4(10.25, 20.5, 24, 1));
    EXPECT_EQ(valuesOf(volume), (std::vector<double>{8, 9, 12, 13, 2, 3, 6, 7, 0, 1, 4, 5}));
    DicomFile file = mosaic("1.0");
    file.more[0x00291010] = {"OB", firstTableOfTexts("-1.0")};
    const Volume first = readFile(file);
    EXPECT_EQ(first.worldFromIndex(), volume.worldFromIndex());
    EXPECT_EQ(valuesOf(first), valuesOf(volume));
    // The count alone, in a block of its own number.
    file.more.erase(0x00290010);
    file.more.erase(0x00291010);
    file.more[0x00190011] = {"LO", "SIEMENS MR HEADER"};
    file.more[0x0019110a] = wordsOf({3});
    Warnings warnings;
    EXPECT_EQ(valuesOf(readFile(file, warnings.listener())), up);
    EXPECT_EQ(warnings.lines,
              Lines{"a.dcm: a mosaic that does not say which way its slices follow; the normal of "
                    "rows and columns is taken"});
}

TEST(DicomValuesError, Mosaics) {
    const TempFolder folder;
    DicomFile file = mosaic("1.0");
    file.more.erase(0x00291010);
    writeBytes("a.dcm", file.bytes());
    expectRefused(
        "a.dcm: got a mosaic (ImageType MOSAIC) that does not say of how many slices; expected "
        "NumberOfImagesInMosaic of a \"SIEMENS MR HEADER\" or \"SIEMENS CSA HEADER\"",
        "a.dcm");
    file.more[0x00291010] = {"OB", tableOfTexts(5, "1.0")};
    writeBytes("a.dcm", file.bytes());
    expectRefused("a.dcm: got a mosaic of 5 slices in 4x4; expected tiles of one size, 3 in a row",
                  "a.dcm");
    for (std::size_t size = 0; size < 400; ++size) {
        const std::string table = size % 2 == 0 ? tableOfTexts(3, "1.0") : firstTableOfTexts("1.0");
        file.more[0x00291010] = {"OB", table.substr(0, size / 2)};
        writeBytes("a.dcm", file.bytes());
        try {
            readVolume("a.dcm");
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kInput);
        }
    }
}

// Frames with places and slopes of their own, and what they share.
DicomFile severalFrames() {
    DicomFile file = withoutSlope();
    file.position = file.orientation = file.pixelSpacing = "";
    file.frames = "2";
    file.pixels = ramp<std::uint16_t>(12);
    std::vector<DicomTags> frames;
    for (int i = 0; i < 2; ++i) {
        const std::string z = std::to_string(30 + 2 * i);
        frames.push_back(
            {{0x00209113, sequenceOf({{{0x00200032, decimalText("10\\20\\" + z)}}})},
             {0x00289145, sequenceOf({{{0x00281052, decimalText("1")},
                                       {0x00281053, decimalText(i == 0 ? "10" : "100")}}})}});
    }
    file.more[0x52009229] =
        sequenceOf({{{0x00209116, sequenceOf({{{0x00200037, decimalText("1\\0\\0\\0\\1\\0")}}})},
                     {0x00289110, sequenceOf({{{0x00180050, decimalText("9")},
                                               {0x00280030, decimalText("0.5\\0.25")}}})}}});
    file.more[0x52009230] = sequenceOf(frames);
    return file;
}

TEST(DicomValues, FramesWithPlacesAndSlopesOfTheirOwn) {
    const TempFolder folder;
    const Volume volume = readFile(severalFrames());
    EXPECT_EQ(volume.worldFromIndex(),
              glm::dmat4(0.25, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1));
    EXPECT_EQ(valuesOf(volume),
              (std::vector<double>{1, 11, 21, 31, 41, 51, 601, 701, 801, 901, 1001, 1101}));
    DicomFile packed = severalFrames();
    packed.columns = packed.rows = 4;
    packed.syntax = "1.2.840.10008.1.2.4.90";
    packed.fragments = {wavelets(false), wavelets(false)};
    const Volume unpacked = readFile(packed);
    EXPECT_EQ(unpacked.box().dims(), glm::ivec3(4, 4, 2));
    EXPECT_EQ(valueAt(unpacked, 3, 0, 0), 31);
    EXPECT_EQ(valueAt(unpacked, 3, 0, 1), 301);
}

}  // namespace
}  // namespace deltasplat
