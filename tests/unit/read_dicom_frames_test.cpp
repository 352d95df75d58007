// SPDX-License-Identifier: Apache-2.0
// DICOM files of several frames, big endian or without order, and what is said of many slices.
#include <gtest/gtest.h>

#include <filesystem>

#include "deltasplat/memory_limit.h"
#include "support/memory_beyond.h"
#include "unit/dicom_helpers.h"
#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

using Lines = std::vector<std::string>;

Volume readFile(const DicomFile& file, const Listener& listener = {}) {
    writeBytes("a.dcm", file.bytes());
    return readVolume("a.dcm", {}, listener);
}

std::string pairsTurned(std::string bytes) {
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
    return bytes;
}

// Turns words round, and the heads of elements: a data set with types and without sequences.
std::string bigEndian(const DicomFile& file) {
    const std::string set = file.dataSet();
    std::string turned;
    for (std::size_t i = 0; i < set.size();) {
        const std::string type = set.substr(i + 4, 2);
        const bool isLong = type == "OW" || type == "OB";
        const std::size_t head = isLong ? 12 : 8;
        std::size_t length = 0;
        for (std::size_t b = head; b-- > (isLong ? 8u : 6u);)
            length = length << 8 | static_cast<unsigned char>(set[i + b]);
        const std::string size = set.substr(i + (isLong ? 8 : 6), isLong ? 4 : 2);
        const std::string value = set.substr(i + head, length);
        turned += pairsTurned(set.substr(i, 4)) + type + std::string(isLong ? 2 : 0, '\0') +
                  std::string(size.rbegin(), size.rend()) +
                  (type == "US" || type == "OW" ? pairsTurned(value) : value);
        i += head + length;
    }
    return file.header() + turned;
}

std::vector<double> bigEndianValues(DicomFile file) {
    file.syntax = "1.2.840.10008.1.2.2";
    writeBytes("a.dcm", bigEndian(file));
    return valuesOf(readVolume("a.dcm"));
}

DicomFile framesOf(int count, int bits, const std::string& pixels, const std::string& kind) {
    DicomFile file;
    file.columns = file.rows = 3;
    file.bits = bits;
    file.more[0x7fe00010] = {kind, pixels};
    if (count == 1) return file;
    file.frames = std::to_string(count);
    std::string offsets = "0";
    for (int i = 1; i < count; ++i) offsets += "\\" + std::to_string(i);
    file.more[0x3004000c] = decimalText(offsets);
    return file;
}

// Frames of an odd size begin and end within words, of which the first pixel is the lower byte.
TEST(DicomFrames, BigEndianWords) {
    const TempFolder folder;
    for (const int count : {1, 2, 3}) {
        const auto size = std::size_t(9 * count);
        const std::vector<double> expected = ramp<double>(size, 1);
        for (const std::string kind : {"OW", "OB"}) {
            const std::string bytes = bytesOf(ramp<std::uint8_t>(size, 1));
            EXPECT_EQ(bigEndianValues(framesOf(count, 8, bytes, kind)), expected) << kind << count;
            EXPECT_EQ(valuesOf(readFile(framesOf(count, 8, bytes, kind))), expected) << kind;
        }
        EXPECT_EQ(
            bigEndianValues(framesOf(count, 16, bytesOf(ramp<std::uint16_t>(size, 250, 3)), "OW")),
            ramp<double>(size, 250, 3));
        // Of a cell of four bytes the lower word is the first.
        EXPECT_EQ(bigEndianValues(
                      framesOf(count, 32, bytesOf(ramp<std::uint32_t>(size, 65530, 70001)), "OW")),
                  ramp<double>(size, 65530, 70001));
    }
    Warnings warnings;
    readVolume("a.dcm", {}, warnings.listener());
    EXPECT_EQ(
        warnings.lines,
        Lines{"a.dcm: big endian numbers of 32 bits have the lower word first, as DICOM says"});
}

// The byte that makes a length even is no picture.
TEST(DicomFrames, PicturesOfOnePixel) {
    const TempFolder folder;
    for (const int count : {1, 2, 3}) {
        DicomFile file =
            framesOf(count, 8, bytesOf(ramp<std::uint8_t>(std::size_t(count), 5)), "OB");
        file.columns = file.rows = 1;
        EXPECT_EQ(valuesOf(readFile(file)), ramp<double>(std::size_t(count), 5));
        file.more[0x7fe00010].value.resize(std::size_t(count) + 2);
        writeBytes("a.dcm", file.bytes());
        expectInputError("a.dcm");
    }
}

// The first of the offsets is 0, or the z of the first frame: then they are z of the patient.
TEST(DicomFrames, OffsetsOfDoses) {
    const TempFolder folder;
    struct Case {
        std::string orientation, z, offsets;
        std::vector<int> places;  // of the three frames
    };
    const std::string up = "1\\0\\0\\0\\1\\0", down = "1\\0\\0\\0\\-1\\0";
    for (const Case& one : std::vector<Case>{{up, "10", "0\\2\\4", {10, 12, 14}},
                                             {up, "10", "0\\-2\\-4", {10, 8, 6}},
                                             {up, "10", "10\\12\\14", {10, 12, 14}},
                                             {up, "10", "10\\8\\6", {10, 8, 6}},
                                             {up, "-4", "-4\\-2\\0", {-4, -2, 0}},
                                             {down, "10", "0\\2\\4", {10, 8, 6}},
                                             {down, "10", "0\\-2\\-4", {10, 12, 14}},
                                             {down, "10", "10\\12\\14", {10, 12, 14}},
                                             {down, "10", "10\\8\\6", {10, 8, 6}},
                                             {down, "0", "0\\2\\4", {0, -2, -4}}}) {
        DicomFile file;
        file.columns = file.rows = 1;
        file.frames = "3";
        file.pixels = {0, 1, 2};
        file.orientation = one.orientation;
        file.position = "5\\6\\" + one.z;
        file.more[0x3004000c] = decimalText(one.offsets);
        const Volume volume = readFile(file);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec4 place = volume.worldFromIndex() * glm::dvec4(0, 0, i, 1);
            const auto frame = std::size_t(valueAt(volume, 0, 0, i));
            EXPECT_EQ(place, glm::dvec4(5, 6, one.places.at(frame), 1))
                << one.orientation << " " << one.z << " " << one.offsets;
        }
    }
}

// Of planes that are not across z no offset is a z.
TEST(DicomFrames, OffsetsOfDosesAlongOtherAxes) {
    const TempFolder folder;
    DicomFile file;
    file.columns = file.rows = 1;
    file.frames = "2";
    file.pixels = {0, 1};
    file.orientation = "0\\1\\0\\0\\0\\-1";
    file.position = "5\\6\\10";
    file.more[0x3004000c] = decimalText("10\\12");
    const Volume volume = readFile(file);
    EXPECT_EQ(volume.worldFromIndex()[2], glm::dvec4(-2, 0, 0, 0));
    EXPECT_EQ(valuesOf(volume), (std::vector<double>{0, 1}));
}

// An element behind the pixels that is cut may have said what they mean. One that is missing as a
// whole nobody can know of.
TEST(DicomFrames, ElementsCutBehindThePixels) {
    const TempFolder folder;
    DicomFile file;
    file.slope = file.intercept = "";
    for (const bool explicitTypes : {true, false}) {
        file.explicitTypes = explicitTypes;
        const std::string patient = dicomElement(0x00100010, {"PN", "Somebody"}, explicitTypes);
        const std::string intercept = dicomElement(0x00281052, decimalText("-1024"), explicitTypes);
        const std::string slope = dicomElement(0x00281053, decimalText("3"), explicitTypes);
        const std::string whole = file.bytes() + intercept + slope;
        writeBytes("a.dcm", whole);
        EXPECT_EQ(valuesOf(readVolume("a.dcm")), ramp<double>(6, -1024, 3));
        for (std::size_t cut = 1; cut + 2 <= slope.size(); ++cut) {
            writeBytes("a.dcm", whole.substr(0, whole.size() - cut));
            expectInputError("a.dcm");
            writeBytes("a.dcm", whole.substr(0, whole.size() - slope.size() - cut));
            expectInputError("a.dcm");
        }
        if (!explicitTypes) continue;
        // What follows one of any group is lost as well.
        writeBytes("a.dcm", file.bytes() + patient.substr(0, 11));
        expectRefused("a.dcm: got DICOM whose elements are cut short at byte " +
                          std::to_string(file.bytes().size() + 8) + "; expected a sound file",
                      "a.dcm");
    }
    // Padding of the data set may be cut.
    file.explicitTypes = true;
    writeBytes("a.dcm", file.bytes() +
                            dicomElement(0xfffcfffc, {"OB", std::string(64, '\0')}).substr(0, 40));
    EXPECT_EQ(valuesOf(readVolume("a.dcm")), ramp<double>(6));
}

TEST(DicomFrames, HalfARescale) {
    const TempFolder folder;
    DicomFile file;
    file.slope = "";
    file.intercept = "7";
    Warnings warnings;
    EXPECT_EQ(valuesOf(readFile(file, warnings.listener())), ramp<double>(6, 7));
    file.slope = "2";
    file.intercept = "";
    EXPECT_EQ(valuesOf(readFile(file, warnings.listener())), ramp<double>(6, 0, 2));
    EXPECT_EQ(warnings.lines, (Lines{"a.dcm: RescaleIntercept without RescaleSlope; 1 is taken",
                                     "a.dcm: RescaleSlope without RescaleIntercept; 0 is taken"}));
}

// Cells of 8 bits hold the lower byte of the word that padding is.
TEST(DicomFrames, PaddingOfOneByte) {
    const TempFolder folder;
    DicomFile file;
    file.bits = 8;
    file.more[0x7fe00010] = {"OB", bytesOf<std::uint8_t>({255, 1, 2, 128, 127, 200})};
    const auto padded = [&](bool isSigned, std::uint16_t value, std::uint16_t limit) {
        file.isSigned = isSigned;
        file.more[0x00280120] = wordsOf({value});
        file.more[0x00280121] = wordsOf({limit});
        const Volume volume = readFile(file);
        std::string empty;  // the places of voxels that are nothing
        for (int i = 0; i < 6; ++i) {
            const bool isOn = volume.codes()->tree().isValueOn(openvdb::Coord(i % 3, i / 3, 0));
            if (!isOn) empty += std::to_string(i);
        }
        return empty;
    };
    for (const bool isSigned : {false, true}) {
        EXPECT_EQ(padded(isSigned, 255, 255), "0") << isSigned;
        EXPECT_EQ(padded(isSigned, 0xffff, 0xffff), "0") << isSigned;
        EXPECT_EQ(padded(isSigned, 128, 200), "35") << isSigned;
        EXPECT_EQ(padded(isSigned, 0xffc8, 0xff80), "35") << isSigned;
        EXPECT_EQ(padded(isSigned, 1, 2), "12") << isSigned;
        EXPECT_EQ(padded(isSigned, 0xf830, 0xf830), "") << isSigned;  // -2000
    }
    EXPECT_EQ(padded(false, 200, 300), "05");
    EXPECT_EQ(padded(true, 0xff00, 0xffc8), "35");
    EXPECT_EQ(padded(true, 0xffff, 1), "01");
}

void writeSlices(int count, const std::function<void(int, DicomFile&)>& change) {
    std::filesystem::create_directory("scan");
    for (int i = 0; i < count; ++i) {
        DicomFile file;
        file.slope = file.intercept = "";
        file.position = "0\\0\\" + std::to_string(i);
        change(i, file);
        writeBytes("scan/" + std::to_string(i), file.bytes());
    }
}

TEST(DicomFrames, OneLineOfManySlices) {
    const TempFolder folder;
    const auto linesOf = [] {
        Warnings warnings;
        readVolume("scan", {}, warnings.listener());
        return warnings.lines;
    };
    const auto slopeOf = [](int i, DicomFile& file) {
        file.more[0x00409096] = sequenceOf({{{0x00409211, wordsOf({100})},
                                             {0x00409216, wordsOf({0})},
                                             {0x00409224, doublesOf({1})},
                                             {0x00409225, doublesOf({0.5 + i})}}});
    };
    const std::string mapped =
        "scan: values are those of its real world value mapping, for there is no other (";
    writeSlices(4, slopeOf);
    EXPECT_EQ(linesOf(), Lines{mapped + "each slice has its own)"});
    EXPECT_EQ(valueAt(readVolume("scan"), 1, 0, 3), 4.5);
    writeSlices(4, [&](int, DicomFile& file) { slopeOf(1, file); });
    EXPECT_EQ(linesOf(), Lines{mapped + "1.5 * stored + 1)"});
    writeSlices(4, [&](int i, DicomFile& file) {
        file.slope = "1e-30";
        file.intercept = std::to_string(i + 1);
    });
    EXPECT_EQ(linesOf(), Lines{"scan: slopes that make all values of a slice one"});
}

TEST(DicomFramesError, ASeriesTwice) {
    const TempFolder folder;
    for (const std::string at : {"study/a", "study/b"}) {
        std::filesystem::create_directories(at);
        for (int i = 0; i < 2; ++i) {
            DicomFile file;
            file.position = "0\\0\\" + std::to_string(i);
            writeBytes(at + "/" + std::to_string(i), file.bytes());
        }
    }
    const std::string twice =
        ": got a/0 and b/0 at the same place; expected one slice at each "
        "place";
    for (const std::string name : {"study", "study/", "./study"}) expectRefused(name + twice, name);
    DicomFile other;
    other.columns = 2;
    other.rows = 3;
    other.position = "0\\0\\7";
    writeBytes("study/b/0", other.bytes());
    expectRefused("study/b/0: got a slice of 2x3; expected 3x2, as in a/0", "study");
}

// A table of half a megabyte that all frames have, in which each looks up its pixel.
void expectOneTable(DicomFile file, double scale) {
    constexpr int kFrames = 2500;
    setMemoryLimit(test::memoryBeyond(std::uint64_t{1} << 30));
    file.columns = file.rows = 1;
    file.slope = file.intercept = "";
    file.frames = std::to_string(kFrames);
    file.pixels = ramp<std::uint16_t>(kFrames);
    file.syntax = "1.2.840.10008.1.2";
    file.explicitTypes = false;
    EXPECT_EQ(valuesOf(readFile(file)), ramp<double>(kFrames, 0, scale));
    setMemoryLimit(0);
}

TEST(DicomFrames, OneTableOfManyFrames) {
    const TempFolder folder;
    DicomFile file;
    std::string offsets = "0";
    std::vector<DicomTags> frames;
    for (int i = 0; i < 2500; ++i) {
        const std::string z = std::to_string(i);
        if (i > 0) offsets += "\\" + z;
        frames.push_back(
            {{0x00209113, sequenceOf({{{0x00200032, decimalText("1\\2\\" + z)}}}, false)},
             {0x00289145, sequenceOf({{}}, false)}});
    }
    DicomFile doses = file;
    doses.more[0x3004000c] = decimalText(offsets);
    doses.more[0x00283000] =
        sequenceOf({{{0x00283002, wordsOf({0, 0, 16})},
                     {0x00283006, {"OW", bytesOf(ramp<std::uint16_t>(65536))}}}},
                   false);
    expectOneTable(doses, 1);
    // Frames with items of their own that say nothing.
    file.more[0x52009229] =
        sequenceOf({{{0x00409096, sequenceOf({{{0x00409211, wordsOf({65535})},
                                               {0x00409212, doublesOf(ramp<double>(65536, 0, 0.5))},
                                               {0x00409216, wordsOf({0})}}},
                                             false)}}},
                   false);
    file.more[0x52009230] = sequenceOf(frames, false);
    expectOneTable(file, 0.5);
}

// Frames of one byte take hundreds in memory.
TEST(DicomFramesError, FramesBeyondMemory) {
    const TempFolder folder;
    constexpr int kFrames = 500000;
    DicomFile file;
    file.columns = file.rows = 1;
    file.bits = 8;
    file.frames = std::to_string(kFrames);
    file.syntax = "1.2.840.10008.1.2";
    file.explicitTypes = false;
    file.more[0x7fe00010] = {"OB", std::string(kFrames, '\0')};
    std::string offsets = "0";
    while (offsets.size() < 2 * kFrames - 1) offsets += "\\1";
    file.more[0x3004000c] = decimalText(offsets);
    writeBytes("a.dcm", file.bytes());
    setMemoryLimit(test::memoryBeyond(std::uint64_t{200} << 20));
    try {
        readVolume("a.dcm");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kFailed);
        EXPECT_EQ(std::string(error.what()).rfind("a.dcm: needs ", 0), 0u) << error.what();
    }
    setMemoryLimit(0);
}

}  // namespace
}  // namespace deltasplat
