// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <vector>

#include "deltasplat/ingest/list_grids.h"
#include "formats/dicom/dicom_pixels.h"
#include "support/error_of.h"
#include "unit/dicom_helpers.h"
#include "unit/format_helpers.h"
#include "unit/lossless_jpeg.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

// Writes slices one unit apart along z into the folder `scan`, each with values of its own. Their
// names are in no order.
std::vector<DicomFile> slices(int count) {
    std::vector<DicomFile> files;
    for (int i = 0; i < count; ++i) {
        DicomFile file;
        file.position = "10\\20\\" + std::to_string(30 + 2 * i);
        for (std::uint16_t& pixel : file.pixels) pixel = std::uint16_t(pixel + 100 * i);
        files.push_back(file);
    }
    return files;
}

std::string nameOf(int number) {
    return "scan/" + std::string(1, char('a' + number * 7 % 26)) + ".dcm";
}

void write(const std::vector<DicomFile>& files) {
    std::filesystem::remove_all("scan");
    std::filesystem::create_directory("scan");
    for (std::size_t i = 0; i < files.size(); ++i) writeBytes(nameOf(int(i)), files[i].bytes());
}

std::vector<double> expected(int count, double slope = 1, double intercept = 0) {
    std::vector<double> values;
    for (int i = 0; i < count * 6; ++i) {
        values.push_back(slope * (100 * (i / 6) + i % 6) + intercept);
    }
    return values;
}

TEST(ReadDicom, SortedByPlace) {
    const TempFolder folder;
    write(slices(11));
    for (const std::string name : {"scan", "scan/"}) {
        const Volume volume = readVolume(name);
        EXPECT_EQ(volume.name(), "scan");
        EXPECT_EQ(volume.type(), "uint16");
        EXPECT_EQ(volume.space(), "LPS");
        EXPECT_EQ(volume.box().dims(), glm::ivec3(3, 2, 11));
        EXPECT_EQ(volume.worldFromIndex(),
                  glm::dmat4(0.25, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1));
        EXPECT_EQ(valuesOf(volume), expected(11));
    }
}

TEST(ReadDicom, AlongAnyNormal) {
    const TempFolder folder;
    auto files = slices(3);
    for (int i = 0; i < 3; ++i) {
        // Rows run along y, columns along -z: the normal is -x.
        files[std::size_t(i)].orientation = "0\\1\\0\\0\\0\\-1";
        files[std::size_t(i)].position = std::to_string(50 - 3 * i) + "\\20\\30";
    }
    write(files);
    const Volume volume = readVolume("scan");
    EXPECT_EQ(volume.worldFromIndex(),
              glm::dmat4(0, 0.25, 0, 0, 0, 0, -0.5, 0, -3, 0, 0, 0, 50, 20, 30, 1));
    EXPECT_EQ(valuesOf(volume), expected(3));
}

TEST(ReadDicom, TiltedGantry) {
    const TempFolder folder;
    auto files = slices(3);
    for (int i = 0; i < 3; ++i) {
        files[std::size_t(i)].position =
            "10\\" + std::to_string(20 + i) + "\\" + std::to_string(30 + 2 * i);
    }
    write(files);
    EXPECT_EQ(readVolume("scan").worldFromIndex()[2], glm::dvec4(0, 1, 2, 0));
}

TEST(ReadDicom, Rescale) {
    const TempFolder folder;
    auto files = slices(3);
    for (DicomFile& file : files) file.intercept = "-1000";
    write(files);
    const Volume volume = readVolume("scan");
    EXPECT_EQ(volume.type(), "int32");  // uint16 - 1000
    EXPECT_EQ(valuesOf(volume), expected(3, 1, -1000));
    for (DicomFile& file : files) file.slope = "0.5";
    write(files);
    EXPECT_EQ(valuesOf(readVolume("scan")), expected(3, 0.5, -1000));
}

// As in PET: every slice is scaled on its own.
TEST(ReadDicom, RescaleOfEachSlice) {
    const TempFolder folder;
    auto files = slices(3);
    files[1].slope = "0.5";
    files[2].slope = "0.25";
    write(files);
    const Volume volume = readVolume("scan");
    EXPECT_EQ(volume.type(), "float64");
    EXPECT_EQ(valueAt(volume, 1, 0, 0), 1);
    EXPECT_EQ(valueAt(volume, 1, 0, 1), 50.5);
    EXPECT_EQ(valueAt(volume, 1, 0, 2), 50.25);
}

TEST(ReadDicom, SignedPixels) {
    const TempFolder folder;
    auto files = slices(2);
    for (DicomFile& file : files) file.isSigned = true;
    files[0].pixels[0] = 0xffff;
    write(files);
    EXPECT_EQ(readVolume("scan").type(), "int16");
    EXPECT_EQ(valueAt(readVolume("scan"), 0, 0, 0), -1);
}

// DICOM's run lengths: a table of segments, high bytes first, then each segment's rows.
std::string runLengths(const std::vector<std::uint16_t>& pixels) {
    std::string segments[2];
    for (const std::uint16_t pixel : pixels) {
        // Each byte as a run of one.
        segments[0] += std::string(1, '\0') + char(pixel >> 8);
        segments[1] += std::string(1, '\0') + char(pixel & 0xff);
    }
    std::vector<std::uint32_t> table(16, 0);
    table[0] = 2;
    table[1] = 64;
    table[2] = std::uint32_t(64 + segments[0].size());
    return bytesOf(table) + segments[0] + segments[1];
}

std::vector<DicomFile> packedSlices(int count) {
    auto files = slices(count);
    for (DicomFile& file : files) {
        file.syntax = "1.2.840.10008.1.2.5";
        file.fragments = {runLengths(file.pixels)};
    }
    return files;
}

TEST(ReadDicom, PackedPixels) {
    const TempFolder folder;
    auto files = packedSlices(3);
    for (DicomFile& file : files) file.intercept = "-7";
    write(files);
    EXPECT_EQ(valuesOf(readVolume("scan")), expected(3, 1, -7));
    files[1].fragments[0].resize(70);
    write(files);
    expectInputError("scan");
}

// Each has a helper of its own, which is gone with the reading.
TEST(ReadDicom, PackedPixelsInManyThreads) {
    const TempFolder folder;
    write(packedSlices(9));
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([] { EXPECT_EQ(valuesOf(readVolume("scan")), expected(9)); });
    threads.clear();
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
}

TEST(ReadDicom, PackedPixelsBehindDamagedOnes) {
    const TempFolder folder;
    const std::string packed = runLengths({0, 1, 2, 3, 4, 5});
    writeBytes("whole", packed);
    writeBytes("cut", packed.substr(0, 70));
    DicomReader reader;
    const auto read = [&](const std::string& file) {
        DicomSlice slice;
        slice.file = file;
        slice.columns = slice.pixels.columns = 3;
        slice.rows = slice.pixels.rows = 2;
        slice.pixels.syntax = "1.2.840.10008.1.2.5";
        slice.pixels.packed = true;
        slice.pixels.pieces = {{0, std::filesystem::file_size(file)}};
        std::vector<std::uint16_t> values(6);
        reader.read(slice, {RawType::kUint16, 0}, reinterpret_cast<std::byte*>(values.data()));
        return values;
    };
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(read("whole"), (std::vector<std::uint16_t>{0, 1, 2, 3, 4, 5}));
        EXPECT_EQ(test::errorOf([&] { read("cut"); }),
                  "input: cut: got pixels that GDCM cannot unpack, or not all of them; expected "
                  "the pixels that the header names");
    }
}

// Not the file is to blame.
TEST(ReadDicom, PackedPixelsWithoutTheHelper) {
    const TempFolder folder;
    write(packedSlices(2));
    ::setenv("DELTASPLAT_HELPER", "none", 1);
    EXPECT_EQ(test::errorOf([] { readVolume("scan"); }),
              "failed: deltasplat-helper: got no file none; expected the program that "
              "DELTASPLAT_HELPER names");
    ::unsetenv("DELTASPLAT_HELPER");
}

TEST(ReadDicom, OneSlice) {
    const TempFolder folder;
    auto files = slices(1);
    files[0].thickness = "3";
    write(files);
    for (const std::string& name : {std::string("scan"), nameOf(0)}) {
        const Volume volume = readVolume(name);
        EXPECT_EQ(volume.voxelSize(), glm::dvec3(0.25, 0.5, 3));
        EXPECT_EQ(volume.name(), name == "scan" ? "scan" : "a");
    }
}

TEST(ReadDicom, OtherFilesInTheFolder) {
    const TempFolder folder;
    write(slices(2));
    writeBytes("scan/DICOMDIR", slices(1)[0].bytes());
    writeBytes("scan/readme.txt", "text");
    writeBytes("scan/.hidden", "text");
    std::filesystem::create_directory("scan/more");
    Warnings warnings;
    EXPECT_EQ(valuesOf(readVolume("scan", {}, warnings.listener())), expected(2));
    EXPECT_EQ(warnings.lines,
              std::vector<std::string>{
                  "scan: 2 files that are no DICOM are passed over, the first DICOMDIR"});
}

template <typename Change>
void expectRefusedWith(const std::string& message, const Change& change) {
    auto files = slices(5);
    change(files);
    write(files);
    expectRefused(message, "scan");
}

TEST(ReadDicomError, MissingAndDoubledSlices) {
    const TempFolder folder;
    expectRefusedWith(
        "scan: got h.dcm and o.dcm 4 mm apart; expected 2 mm as between the others (a slice may be "
        "missing)",
        [](auto& files) { files.erase(files.begin() + 2); });
    expectRefusedWith(
        "scan: got o.dcm and v.dcm at the same place; expected one slice at each place",
        [](auto& files) { files[3].position = files[2].position; });
    expectRefusedWith("scan: got o.dcm 30 mm aside of the others; expected slices in one row",
                      [](auto& files) { files[2].position = "40\\20\\34"; });
}

TEST(ReadDicomError, SlicesThatDiffer) {
    const TempFolder folder;
    expectRefusedWith("scan/v.dcm: got a slice of 2x3; expected 3x2, as in a.dcm",
                      [](auto& files) { std::swap(files[3].columns, files[3].rows); });
    expectRefusedWith(
        "scan/v.dcm: got a slice of another direction or pixel spacing; expected one parallel to "
        "a.dcm",
        [](auto& files) { files[3].orientation = "0\\1\\0\\1\\0\\0"; });
    expectRefusedWith(
        "scan: got 2 DICOM series: 1.2.3 (CT, 3x2x3), 1.2.4 (CT, 3x2x2); expected one, chosen by "
        "`series` UID",
        [](auto& files) { files[3].series = files[1].series = "1.2.4"; });
}

TEST(ReadDicomError, Headers) {
    const TempFolder folder;
    const std::string place = "; expected 3 numbers that say where the slice lies";
    expectRefusedWith("scan/o.dcm: got no usable ImagePositionPatient" + place,
                      [](auto& files) { files[2].position = ""; });
    expectRefusedWith("scan/o.dcm: got no usable ImagePositionPatient" + place,
                      [](auto& files) { files[2].position = "1\\two\\3"; });
    expectRefusedWith(
        "scan/o.dcm: got no usable ImageOrientationPatient; expected 6 numbers that "
        "say where the slice lies",
        [](auto& files) { files[2].orientation = "1\\0\\0"; });
    expectRefusedWith(
        "scan/o.dcm: got directions or spacing that are impossible; expected unit "
        "vectors at a right angle and spacing above 0",
        [](auto& files) { files[2].orientation = "1\\0\\0\\1\\0\\0"; });
    expectRefusedWith(
        "scan/o.dcm: got directions or spacing that are impossible; expected unit "
        "vectors at a right angle and spacing above 0",
        [](auto& files) { files[2].pixelSpacing = "0\\1"; });
    expectRefusedWith(
        "scan/o.dcm: got 7 frames in one file; expected one slice in each file, or frames that say "
        "where each lies",
        [](auto& files) { files[2].frames = "7"; });
    expectRefusedWith("scan/o.dcm: got no image; expected a DICOM slice with rows and columns",
                      [](auto& files) { files[2].rows = 0; });
    expectRefusedWith("scan/o.dcm: got pixels of kind RGB; expected one grey value a pixel",
                      [](auto& files) {
                          files[2].samples = 3;
                          files[2].photometric = "RGB";
                      });
}

TEST(ReadDicomError, PixelsThatAreNotThere) {
    const TempFolder folder;
    auto files = slices(1);
    files[0].columns = files[0].rows = 60000;
    write(files);
    expectRefused("scan/a.dcm: got 12 bytes of pixels; expected enough for 60000x60000", "scan");
    files = slices(1);
    files[0].pixels.resize(4);
    write(files);
    expectRefused("scan/a.dcm: got 8 bytes of pixels; expected enough for 3x2", "scan");
    write(slices(2));
    const std::string whole = readBytes("scan/a.dcm");
    writeBytes("scan/a.dcm", whole.substr(0, whole.size() - 1));
    expectRefused("scan/a.dcm: got DICOM whose elements are cut short at byte " +
                      std::to_string(whole.size() - 12) + "; expected a sound file",
                  "scan");
    for (std::size_t size = 132; size < whole.size(); ++size) {
        writeBytes("scan/a.dcm", whole.substr(0, size));
        expectInputError("scan");
    }
}

// Pixels that need many bytes of any code stream.
std::vector<std::uint16_t> roughPixels(int count) {
    std::vector<std::uint16_t> pixels;
    for (int i = 0; i < count; ++i) pixels.push_back(std::uint16_t(i * 37 % 5000 + i * i % 777));
    return pixels;
}

// Two series in one folder, of which the second has slices of another shape, and a report.
void writeSeveral() {
    write(slices(5));
    std::vector<DicomFile> others = slices(3);
    for (std::size_t i = 0; i < others.size(); ++i) {
        others[i].series = "1.2.99";
        others[i].description = "Scout";
        others[i].columns = 6;
        others[i].rows = 1;
        writeBytes("scan/other" + std::to_string(i) + ".dcm", others[i].bytes());
    }
    DicomFile report;
    report.series = "1.2.100";
    report.description = "Dose report";
    report.rows = report.columns = 0;
    writeBytes("scan/report.dcm", report.bytes());
}

TEST(ReadDicom, SeriesAreChosen) {
    const TempFolder folder;
    writeSeveral();
    ReadOptions options;
    options.series = "1.2.3";
    EXPECT_EQ(valuesOf(readVolume("scan", options)), expected(5));
    options.series = "1.2.99";
    const Volume second = readVolume("scan", options);
    EXPECT_EQ(second.box().dims(), glm::ivec3(6, 1, 3));
    EXPECT_EQ(valuesOf(second), expected(3));
    const std::string all =
        "1.2.100 (CT, Dose report, 1 file), 1.2.3 (CT, 3x2x5), 1.2.99 (CT, Scout, 6x1x3)";
    options.series = "1.2.9";
    expectRefused("scan: got no DICOM series 1.2.9; expected `series` of " + all, "scan", options);
    options.series = "";
    expectRefused("scan: got no DICOM series \"\"; expected `series` of " + all, "scan", options);
    options.series = "1.2.100";
    expectRefused("scan/report.dcm: got no image; expected a DICOM slice with rows and columns",
                  "scan", options);
    expectRefused("scan: got 3 DICOM series: " + all + "; expected one, chosen by `series` UID",
                  "scan");
}

TEST(ReadDicomError, EverySeriesIsNamed) {
    const TempFolder folder;
    std::vector<DicomFile> files = slices(24);
    std::string all;
    for (int i = 0; i < 24; ++i) {
        files[std::size_t(i)].series =
            "1.2.840.113704.1.111.5104.1396.20261121100000." + std::to_string(1000 + i);
        all += (i == 0 ? "" : ", ") + files[std::size_t(i)].series + " (CT, 3x2x1)";
    }
    write(files);
    expectRefused("scan: got 24 DICOM series: " + all + "; expected one, chosen by `series` UID",
                  "scan");
}

// One series is read without being named, or by its name, be that none.
TEST(ReadDicom, TheOnlySeries) {
    const TempFolder folder;
    for (const std::string uid : {"1.2.3", ""}) {
        std::vector<DicomFile> files = slices(3);
        for (DicomFile& file : files) file.series = uid;
        write(files);
        EXPECT_EQ(valuesOf(readVolume("scan")), expected(3));
        ReadOptions options;
        options.series = uid;
        EXPECT_EQ(valuesOf(readVolume("scan", options)), expected(3));
        EXPECT_EQ(readVolume(nameOf(0), options).box().dims(), glm::ivec3(3, 2, 1));
        options.series = "1.2";
        expectInputError("scan", options);
        expectInputError(nameOf(0), options);
    }
}

// The slice may be of the series that is asked for. Only the elements before the UID are left of
// it.
TEST(ReadDicomError, ASliceCutBeforeItsSeries) {
    const TempFolder folder;
    write(slices(5));
    const std::string bytes = slices(6)[5].bytes();
    const std::size_t uid = bytes.find("1.2.3", bytes.find("CT")) - 8;
    for (const std::string series : {"1.2.3", "", "1.2.9"}) {
        ReadOptions options;
        if (!series.empty()) options.series = series;
        writeBytes("scan/cut", bytes.substr(0, uid));
        const std::string message =
            "scan/cut: got a file that does not say its series; expected a SeriesInstanceUID, as "
            "others in the folder have it (the file may be cut)";
        expectRefused(message, "scan", options);
        expectError(ErrorCode::kInput, message, [&] { listVolumes("scan", options); });
    }
    for (std::size_t end = 132; end < bytes.size(); ++end) {
        ReadOptions options;
        options.series = "1.2.3";
        writeBytes("scan/cut", bytes.substr(0, end));
        EXPECT_THROW(readVolume("scan", options), Error) << end;
    }
}

TEST(ReadDicomError, ASliceThatIsALinkToNothing) {
    const TempFolder folder;
    write(slices(5));
    std::filesystem::create_symlink("nowhere", "scan/another");
    expectRefused("scan/another: got no such file; expected a readable file", "scan");
}

// A terminal gets UTF-8, whatever alphabet the file is in.
TEST(ReadDicom, DescriptionsAreUtf8) {
    const TempFolder folder;
    std::vector<DicomFile> files = slices(2);
    for (DicomFile& file : files)
        file.description =
            "Sch\xe4"
            "del \xc3\xa4";
    write(files);
    EXPECT_EQ(listVolumes("scan")[0].description, "CT, Sch?del \xc3\xa4");
}

TEST(ReadDicom, ATableOfContents) {
    const TempFolder folder;
    write(slices(5));
    std::string bytes = slices(1)[0].bytes();
    const std::string kind = "1.2.840.10008.5.1.4.1.1.2";
    std::string table = "1.2.840.10008.1.3.10";
    table.resize(kind.size() + 1);
    bytes.replace(bytes.find(kind), table.size(), table);
    const std::size_t uid = bytes.find("1.2.3", bytes.find("CT")) - 8;
    writeBytes("scan/contents.dcm", bytes.substr(0, uid));
    EXPECT_EQ(valuesOf(readVolume("scan")), expected(5));
    expectRefused("scan/contents.dcm: got no image; expected DICOM slices", "scan/contents.dcm");
}

// What is wrong with one series does not keep the others from being listed and read.
TEST(ReadDicom, SeriesAreListed) {
    const TempFolder folder;
    writeSeveral();
    std::filesystem::remove("scan/other1.dcm");
    DicomFile gap = slices(6)[5];
    gap.series = "1.2.99";
    gap.columns = 6;
    gap.rows = 1;
    writeBytes("scan/other1.dcm", gap.bytes());
    const std::vector<VolumeEntry> entries = listVolumes("scan");
    ASSERT_EQ(entries.size(), 3u);
    EXPECT_EQ(entries[0].series, "1.2.100");
    EXPECT_EQ(entries[0].description, "CT, Dose report");
    EXPECT_EQ(entries[0].type, kNoImages);
    EXPECT_FALSE(entries[0].scalar);
    EXPECT_EQ(entries[1].series, "1.2.3");
    EXPECT_EQ(entries[1].description, "CT");
    EXPECT_EQ(entries[1].type, "uint16");
    EXPECT_EQ(entries[1].box->dims(), glm::ivec3(3, 2, 5));
    EXPECT_TRUE(entries[1].scalar);
    EXPECT_FALSE(entries[1].preferred);
    EXPECT_EQ(entries[2].series, "1.2.99");
    EXPECT_FALSE(entries[2].scalar);
    EXPECT_FALSE(entries[2].box);
    ReadOptions options;
    options.series = "1.2.3";
    EXPECT_EQ(listVolumes("scan", options).size(), 1u);
    EXPECT_EQ(valuesOf(readVolume("scan", options)), expected(5));
    options.series = "1.2.99";
    expectRefused(
        "scan: got other2.dcm and other1.dcm 6 mm apart; expected 4 mm as between the others (a "
        "slice may be missing)",
        "scan", options);
}

TEST(ReadDicom, LosslessJpeg) {
    const TempFolder folder;
    DicomFile file;
    file.columns = 40;
    file.rows = 30;
    file.syntax = "1.2.840.10008.1.2.4.70";
    const std::vector<std::uint16_t> pixels = roughPixels(1200);
    file.fragments = {losslessJpeg(40, 30, pixels)};
    writeBytes("a.dcm", file.bytes());
    EXPECT_EQ(valuesOf(readVolume("a.dcm")), std::vector<double>(pixels.begin(), pixels.end()));
}

// The end of the file and of the image are there, and the header is right.
TEST(ReadDicomError, LosslessJpegWithoutMuchOfItsCodes) {
    const TempFolder folder;
    DicomFile file;
    file.columns = 40;
    file.rows = 30;
    file.syntax = "1.2.840.10008.1.2.4.70";
    const std::string whole = losslessJpeg(40, 30, roughPixels(1200));
    const std::size_t start = scanStart(whole);
    const std::size_t codes = whole.size() - 2 - start;
    for (const double kept : {0.0, 0.1, 0.3, 0.5, 0.9, 0.99}) {
        for (const std::string end : {"\xff\xd9", ""}) {
            file.fragments = {whole.substr(0, start + std::size_t(kept * double(codes))) + end};
            writeBytes("a.dcm", file.bytes());
            expectRefused(
                "a.dcm: got pixels that GDCM cannot unpack, or not all of them; expected "
                "the pixels that the header names",
                "a.dcm");
        }
    }
    // From the middle, so that even the last codes are there.
    file.fragments = {whole.substr(0, start + 200) + whole.substr(start + 600)};
    writeBytes("a.dcm", file.bytes());
    expectInputError("a.dcm");
}

TEST(ReadDicomError, CutRuns) {
    const TempFolder folder;
    DicomFile file;
    file.columns = 40;
    file.rows = 30;
    file.syntax = "1.2.840.10008.1.2.5";
    std::string runs;  // twelve of a hundred equal bytes
    for (int i = 0; i < 12; ++i) runs += std::string(1, char(-99)) + char(i);
    std::vector<std::uint32_t> table(16, 0);
    table[0] = 2;
    table[1] = 64;
    table[2] = 64 + std::uint32_t(runs.size());
    const std::string whole = bytesOf(table) + runs + runs;
    file.fragments = {whole};
    writeBytes("a.dcm", file.bytes());
    EXPECT_EQ(valuesOf(readVolume("a.dcm")).back(), 11 * 257.0);
    for (std::size_t size = 0; size < whole.size(); size += 2) {
        file.fragments = {whole.substr(0, size)};
        writeBytes("a.dcm", file.bytes());
        expectInputError("a.dcm");
    }
}

// A first or last slice that has lost its header leaves no gap behind.
TEST(ReadDicomError, CutSliceInAFolder) {
    const TempFolder folder;
    for (const std::string extension : {".dcm", "", ".IMA"}) {
        for (const int cut : {0, 3}) {
            for (const std::size_t left : {0, 20, 131, 200}) {
                std::filesystem::remove_all("scan");
                std::filesystem::create_directory("scan");
                const std::vector<DicomFile> files = slices(4);
                for (int i = 0; i < 4; ++i) {
                    const std::string bytes = files[std::size_t(i)].bytes();
                    writeBytes("scan/IM" + std::to_string(8 + i) + extension,
                               i == cut ? bytes.substr(0, left) : bytes);
                }
                expectInputError("scan");
            }
        }
    }
    write(slices(3));
    writeBytes("scan/zz.dcm", "");
    expectRefused(
        "scan: got zz.dcm, which is named as its slices are but is no DICOM; expected "
        "whole slices",
        "scan");
}

TEST(ReadDicomError, Structure) {
    const TempFolder folder;
    write(slices(1));
    const std::string whole = readBytes("scan/a.dcm");
    const auto refusedWith = [&](const std::string& message, const std::string& from,
                                 const std::string& to) {
        std::string bytes = whole;
        bytes.replace(bytes.find(from), from.size(), to);
        writeBytes("scan/a.dcm", bytes);
        try {
            readVolume("scan");
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kInput);
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
        }
    };
    refusedWith("element has the unknown type \"X?\"", "OW", "X\n");
    refusedWith("DICOM with the transfer syntax \"1.2.840.90008.1.2.1\"", "1.2.840.10008.1.2.1",
                "1.2.840.90008.1.2.1");
    refusedWith("DICOM with the transfer syntax \"1.2.840.10008.1.2.1.99\"",
                std::string("\x14\0"
                            "1.2.840.10008.1.2.1\0",
                            22),
                std::string("\x16\0"
                            "1.2.840.10008.1.2.1.99",
                            24));
    refusedWith("pixels of 17 bits up to bit 15 in 16", std::string("\x01\x01US\x02\0\x10", 7),
                std::string("\x01\x01US\x02\0\x11", 7));
}

}  // namespace
}  // namespace deltasplat
