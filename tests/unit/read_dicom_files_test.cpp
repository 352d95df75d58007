// SPDX-License-Identifier: Apache-2.0
// DICOM files as scanners, archives and discs write them.
#include <gtest/gtest.h>

#include <filesystem>

#include "deltasplat/ingest/list_grids.h"
#include "unit/dicom_helpers.h"
#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

const std::vector<double> kRamp{0, 1, 2, 3, 4, 5};

std::vector<double> valuesOfBytes(const std::string& bytes, const std::string& name = "a.dcm") {
    writeBytes(name, bytes);
    return valuesOf(readVolume(name));
}

TEST(DicomFiles, BytesBehindTheLastElement) {
    const TempFolder folder;
    const DicomFile file;
    for (const std::string& end : {std::string(1, '\0'), std::string(2, '\0'),
                                   std::string(254, '\0'), std::string("no elements at all")})
        EXPECT_EQ(valuesOfBytes(file.bytes() + end), kRamp) << end.size();
}

TEST(DicomFiles, ElementsInAnyOrder) {
    const TempFolder folder;
    const DicomFile file;
    const std::string slope = dicomElement(0x00281053, decimalText("1"));
    std::string set = file.dataSet();
    set.replace(set.find(slope), slope.size(), "");
    EXPECT_EQ(valuesOfBytes(file.header() + dicomElement(0x00281053, decimalText("3")) + set),
              (std::vector<double>{0, 3, 6, 9, 12, 15}));
    // Of two with one tag the first counts.
    EXPECT_EQ(
        valuesOfBytes(file.header() + dicomElement(0x00281053, decimalText("2")) + file.dataSet()),
        (std::vector<double>{0, 2, 4, 6, 8, 10}));
}

// The first header says how the data set is written.
TEST(DicomFiles, HeaderTwice) {
    const TempFolder folder;
    DicomFile file;
    for (const bool explicitTypes : {true, false}) {
        file.explicitTypes = explicitTypes;
        file.syntax = explicitTypes ? "1.2.840.10008.1.2.1" : "1.2.840.10008.1.2";
        const std::string again =
            dicomElement(0x00020010, {"UI", "1.2.840.10008.1.2.4.90"}, explicitTypes);
        EXPECT_EQ(valuesOfBytes(file.header() + again + file.dataSet()), kRamp) << explicitTypes;
    }
}

// Some headers say one way and the data set is written in the other.
TEST(DicomFiles, TypesWhereThereAreNone) {
    const TempFolder folder;
    DicomFile file;
    file.explicitTypes = false;
    EXPECT_EQ(valuesOfBytes(file.bytes()), kRamp);
    file.explicitTypes = true;
    file.syntax = "1.2.840.10008.1.2";
    EXPECT_EQ(valuesOfBytes(file.bytes()), kRamp);
}

TEST(DicomFiles, IconsInSequences) {
    const TempFolder folder;
    DicomFile file;
    const std::string icon = DicomFile::packedPixels({"\xff\xd8 an icon"});
    const std::string item = bytesOf<std::uint16_t>({0xfffe, 0xe000}) +
                             bytesOf<std::uint32_t>({std::uint32_t(icon.size())}) + icon;
    file.more[0x00880200] = {"SQ", item};
    EXPECT_EQ(valuesOfBytes(file.bytes()), kRamp);
}

TEST(DicomFiles, WithoutHeader) {
    const TempFolder folder;
    DicomFile file;
    const std::string header = file.header();
    for (const bool explicitTypes : {true, false}) {
        file.explicitTypes = explicitTypes;
        for (const std::string name : {"a.dcm", "IM000001"})
            EXPECT_EQ(valuesOfBytes(file.dataSet(), name), kRamp) << explicitTypes;
    }
    file.explicitTypes = true;
    EXPECT_EQ(valuesOfBytes(header.substr(128) + file.dataSet()), kRamp);
    EXPECT_EQ(valuesOfBytes(header.substr(132) + file.dataSet()), kRamp);
    // Nothing that names a class is no data set.
    writeBytes("b.dcm", std::string("\x08\0\x05\0CS\2\0ab", 10) + std::string(600, ' '));
    expectRefused("b.dcm: got no DICOM header; expected \"DICM\" behind 128 bytes", "b.dcm");
}

TEST(DicomFiles, NamesOfAllKinds) {
    const TempFolder folder;
    for (const std::string name :
         {"IM000001", "P1.MR.HEAD.0002.IMA", "slice.img", "1.2.840.113619.2", "MR.1.2.840"}) {
        writeBytes(name, DicomFile().bytes());
        EXPECT_EQ(valuesOf(readVolume(name)), kRamp) << name;
    }
    EXPECT_EQ(readVolume("1.2.840.113619.2").name(), "1.2.840.113619.2");
    EXPECT_EQ(readVolume("P1.MR.HEAD.0002.IMA").name(), "P1.MR.HEAD.0002");
    writeBytes("text.xyz", "text");
    expectInputError("text.xyz");
}

DicomFile sliceOf(const std::string& series, int z) {
    DicomFile file;
    file.series = series;
    file.position = "0\\0\\" + std::to_string(z);
    for (std::uint16_t& pixel : file.pixels) pixel = std::uint16_t(pixel + 10 * z);
    return file;
}

// A disc: a table of contents, a logo and a text beside folders of slices without extension.
void writeDisc(const std::vector<std::string>& series) {
    DicomFile contents;
    std::string table = contents.header();
    const std::string kind = "1.2.840.10008.5.1.4.1.1.2";
    std::string name = "1.2.840.10008.1.3.10";
    name.resize(kind.size() + 1);
    table.replace(table.find(kind), name.size(), name);
    std::filesystem::create_directory("disc");
    writeBytes("disc/DICOMDIR", table);
    writeBytes("disc/README.TXT", "text");
    writeBytes("disc/logo.png", "a logo");
    for (std::size_t s = 0; s < series.size(); ++s) {
        const std::string at = "disc/DICOM/PAT0/STU0/SER" + std::to_string(s);
        std::filesystem::create_directories(at);
        for (int z = 0; z < 2; ++z)
            writeBytes(at + "/IMG" + std::to_string(z), sliceOf(series[s], z).bytes());
    }
}

TEST(DicomFiles, Discs) {
    const TempFolder folder;
    writeDisc({"1.2.5"});
    const std::vector<double> expected{0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 14, 15};
    for (const std::string name : {"disc", "disc/DICOMDIR", "disc/DICOM"}) {
        Warnings warnings;
        const Volume volume = readVolume(name, {}, warnings.listener());
        EXPECT_EQ(valuesOf(volume), expected) << name;
        EXPECT_EQ(warnings.lines.size(), name == "disc/DICOM" ? 0u : 1u) << name;
    }
    Warnings warnings;
    readVolume("disc", {}, warnings.listener());
    EXPECT_EQ(warnings.lines,
              std::vector<std::string>{
                  "disc: 3 files that are no DICOM are passed over, the first DICOMDIR"});
}

TEST(DicomFiles, StudiesListTheirSeries) {
    const TempFolder folder;
    writeDisc({"1.2.5", "1.2.6"});
    const std::vector<VolumeEntry> entries = listVolumes("disc");
    ASSERT_EQ(entries.size(), 2u);
    EXPECT_EQ(entries[1].series, "1.2.6");
    EXPECT_EQ(entries[1].box->dims(), glm::ivec3(3, 2, 2));
    expectRefused(
        "disc: got 2 DICOM series: 1.2.5 (CT, 3x2x2), 1.2.6 (CT, 3x2x2); expected one, chosen by "
        "`series` UID",
        "disc");
    ReadOptions options;
    options.series = "1.2.6";
    EXPECT_EQ(readVolume("disc", options).box().dims(), glm::ivec3(3, 2, 2));
}

// On a disc slices may lie on top and below; in other folders those on top are what is meant.
TEST(DicomFiles, SlicesAboveOthers) {
    const TempFolder folder;
    writeDisc({"1.2.5"});
    writeBytes("disc/top", sliceOf("1.2.5", 2).bytes());
    EXPECT_EQ(readVolume("disc").box().dims(), glm::ivec3(3, 2, 3));
    std::filesystem::remove("disc/DICOMDIR");
    EXPECT_EQ(readVolume("disc").box().dims(), glm::ivec3(3, 2, 1));
}

// Slices that have lost their headers are missed on discs as well; a broken link elsewhere is not.
TEST(DicomFiles, CutSlicesOnDiscs) {
    const TempFolder folder;
    writeDisc({"1.2.5"});
    std::filesystem::create_directory("disc/viewer");
    std::filesystem::create_symlink("nowhere", "disc/viewer/library");
    EXPECT_EQ(readVolume("disc").box().dims(), glm::ivec3(3, 2, 2));
    writeBytes("disc/DICOM/PAT0/STU0/SER0/IMG2", "");
    expectRefused(
        "disc/DICOM/PAT0/STU0/SER0: got IMG2, which is named as its slices are but is no DICOM; "
        "expected whole slices",
        "disc");
}

// A stack of more images than there are slices below it is what is meant.
TEST(DicomFiles, PicturesBesideSlices) {
    const TempFolder folder;
    writeDisc({"1.2.5"});
    std::filesystem::remove("disc/DICOMDIR");
    EXPECT_EQ(readVolume("disc").box().dims(), glm::ivec3(3, 2, 2));
    for (int i = 0; i < 3; ++i) {
        writeBytes("disc/slice" + std::to_string(i) + ".pgm",
                   "P5\n2 2\n255\n" + std::string(4, char(i)));
    }
    std::filesystem::remove("disc/logo.png");
    EXPECT_EQ(readVolume("disc").box().dims(), glm::ivec3(2, 2, 3));
    std::filesystem::remove("disc/slice2.pgm");
    EXPECT_EQ(readVolume("disc").box().dims(), glm::ivec3(3, 2, 2));
}

}  // namespace
}  // namespace deltasplat
