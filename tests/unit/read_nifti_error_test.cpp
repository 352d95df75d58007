// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

NiftiFile sample() {
    NiftiFile file;
    file.data = bytesOf(ramp<std::int16_t>(24));
    return file;
}

template <typename Change>
void expectRefusedWith(const std::string& message, const Change& change) {
    for (const int version : {1, 2}) {
        NiftiFile file = sample();
        file.version = version;
        change(file);
        writeBytes("a.nii", file.bytes());
        expectRefused("a.nii: " + message, "a.nii");
    }
}

TEST(ReadNiftiError, NoHeader) {
    const TempFolder folder;
    const std::string message = "got no NIfTI header; expected a NIfTI-1 or NIfTI-2 file";
    for (const std::string& bytes :
         {std::string(), std::string(3, 'x'), std::string(1000, '\0'), std::string(1000, 'x')}) {
        writeBytes("a.nii", bytes);
        expectRefused("a.nii: " + message, "a.nii");
    }
    expectRefusedWith(message, [](NiftiFile& file) { file.magic = "n+9"; });
    writeBytes("b.nii", sample().bytes().substr(0, 347));
    expectRefused("b.nii: got 347 bytes; expected a whole NIfTI header", "b.nii");
    writeGzip("c.nii.gz", "");
    expectRefused("c.nii.gz: " + message, "c.nii.gz");
}

TEST(ReadNiftiError, PairOfFiles) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.magic = "ni1";
    writeBytes("a.nii", file.bytes());
    writeBytes("a.img", file.data);
    expectRefused(
        "a.nii: got the header of a pair, whose values are in another file; expected "
        "such a header in a file named .hdr",
        "a.nii");
    writeBytes("b.hdr", file.bytes().substr(0, 348));
    expectRefused("b.hdr: got no .img file beside it; expected both files of a NIfTI pair",
                  "b.hdr");
    writeBytes("c.img", file.data);
    expectRefused("c.img: got no .hdr file beside it; expected both files of a NIfTI pair",
                  "c.img");
    // Analyze knows no orientation.
    writeBytes("c.hdr", file.bytes().substr(0, 344) + std::string(4, '\0'));
    expectRefused(
        "c.hdr: got a header of Analyze 7.5, which does not say where the patient lies; expected a "
        "NIfTI-1 or NIfTI-2 file or pair",
        "c.img");
    writeBytes("b.img", file.data.substr(0, 40));
    expectRefused("b.img: got 40 bytes; expected at least 400 (352 skipped + 4x3x2 int16)",
                  "b.hdr");
}

TEST(ReadNiftiError, Dims) {
    const TempFolder folder;
    expectRefusedWith("got dims 4x-3x2; expected each 1..1073741824", [](NiftiFile& file) {
        file.dims = {4, -3, 2};
    });
    expectRefusedWith("got 2 volumes (dims 2x3x2x2); expected one, chosen by `volume` 0 to 1",
                      [](NiftiFile& file) {
                          file.dims = {2, 3, 2, 2};
                      });
    expectRefusedWith("got dims 4x3x2x-5; expected each 1..1073741824", [](NiftiFile& file) {
        file.dims = {4, 3, 2, -5};
    });
    expectRefusedWith("got 0 dimensions; expected 1 to 7 of them",
                      [](NiftiFile& file) { file.dims = {}; });
}

TEST(ReadNiftiError, DimsBeyondTheData) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {4, 3, 3};
    writeBytes("a.nii", file.bytes());
    expectRefused("a.nii: got 400 bytes; expected at least 424 (352 skipped + 4x3x3 int16)",
                  "a.nii");
    writeGzip("b.nii.gz", file.bytes());
    expectRefused(
        "b.nii.gz: got 400 bytes unpacked; expected at least 424 (352 skipped + 4x3x3 int16)",
        "b.nii.gz");
    file.dims = {16384, 8192, 8192};  // 2^40 voxels
    writeBytes("a.nii", file.bytes());
    expectRefused(
        "a.nii: got 400 bytes; expected at least 2199023255904 (352 skipped + 16384x8192x8192 "
        "int16)",
        "a.nii");
    writeGzip("b.nii.gz", file.bytes());
    expectRefused("b.nii.gz: got " + std::to_string(std::filesystem::file_size("b.nii.gz")) +
                      " bytes of gzip; expected at least 2199023255904 (352 skipped + "
                      "16384x8192x8192 int16)",
                  "b.nii.gz");
    NiftiFile second = sample();
    second.version = 2;
    second.dims = {1 << 30, 1 << 30, 1 << 30};
    writeBytes("c.nii", second.bytes());
    expectRefused(
        "c.nii: got dims 1073741824x1073741824x1073741824; expected at most 4611686018427387904 "
        "bytes",
        "c.nii");
}

// Whichever volume is asked for, all have to be there: sizes are checked before anything is taken.
TEST(ReadNiftiError, VolumesBeyondTheData) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {4, 3, 2, 2};
    ReadOptions first;
    first.volume = 0;
    for (const ReadOptions& options : {ReadOptions(), first}) {
        writeBytes("a.nii", file.bytes());
        expectRefused(
            "a.nii: got 400 bytes; expected at least 448 (352 skipped + 2 volumes of 4x3x2 int16)",
            "a.nii", options);
    }
    writeGzip("b.nii.gz", file.bytes());
    expectRefused(
        "b.nii.gz: got 400 bytes unpacked; expected at least 448 (352 skipped + 2 volumes of 4x3x2 "
        "int16)",
        "b.nii.gz", first);
    file.dims = {4, 3, 2, 32767, 32767};
    writeBytes("a.nii", file.bytes());
    expectRefused(
        "a.nii: got 400 bytes; expected at least 51536462224 (352 skipped + 1073676289 volumes of "
        "4x3x2 int16)",
        "a.nii", first);
    writeGzip("b.nii.gz", file.bytes());
    expectRefused("b.nii.gz: got " + std::to_string(std::filesystem::file_size("b.nii.gz")) +
                      " bytes of gzip; expected at least 51536462224 (352 skipped + 1073676289 "
                      "volumes of 4x3x2 int16)",
                  "b.nii.gz", first);
    file.dims = {32767, 32767, 32767, 32767, 32767, 32767, 32767};
    writeBytes("a.nii", file.bytes());
    expectRefused(
        "a.nii: got dims 32767x32767x32767x32767x32767x32767x32767; expected at most "
        "4611686018427387904 bytes",
        "a.nii", first);
}

// The checksum stands behind the last volume.
TEST(ReadNiftiError, DamagedGzipBehindTheVolume) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {4, 3, 2, 500};
    file.dataType = 16;  // read twice
    file.data = bytesOf(ramp<float>(24 * 500));
    writeGzip("a.nii.gz", file.bytes());
    std::string bytes = readBytes("a.nii.gz");
    ReadOptions first;
    first.volume = 0;
    EXPECT_EQ(valuesOf(readVolume("a.nii.gz", first)), ramp<double>(24));
    writeBytes("b.nii.gz", bytes.substr(0, bytes.size() - 4));
    expectRefused("b.nii.gz: got a gzip stream that is cut short; expected a whole one", "b.nii.gz",
                  first);
    bytes[bytes.size() - 6] = char(bytes[bytes.size() - 6] ^ 1);
    writeBytes("c.nii.gz", bytes);
    expectRefused(
        "c.nii.gz: got a corrupt gzip stream (incorrect data check); expected a sound one",
        "c.nii.gz", first);
}

TEST(ReadNiftiError, Types) {
    const TempFolder folder;
    expectRefusedWith("got values of type complex64; expected whole or real numbers",
                      [](NiftiFile& file) { file.dataType = 32; });
    expectRefusedWith("got values of type RGB; expected whole or real numbers",
                      [](NiftiFile& file) { file.dataType = 128; });
    expectRefusedWith("got data type 77; expected one that NIfTI defines",
                      [](NiftiFile& file) { file.dataType = 77; });
}

TEST(ReadNiftiError, PlaceOfTheData) {
    const TempFolder folder;
    NiftiFile file = sample();
    for (const auto& [start, text] : {std::pair{16.0, "16"}, {360.5, "360.5"}, {-1.0, "-1"}}) {
        file.dataStart = start;
        writeBytes("a.nii", file.bytes());
        expectRefused("a.nii: got data at byte " + std::string(text) + "; expected at least 352",
                      "a.nii");
    }
}

TEST(ReadNiftiError, NoPlaceInTheWorld) {
    const TempFolder folder;
    expectRefusedWith(
        "got a voxel size that cannot be inverted; expected finite numbers that give each voxel a "
        "place of its own",
        [](NiftiFile& file) {
            file.sformCode = 0;
            file.pixelSizes[2] = NAN;
        });
}

TEST(ReadNiftiError, DamagedGzip) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {32, 32, 20};
    file.data.resize(32 * 32 * 20 * 2);
    for (std::size_t i = 0; i < file.data.size(); ++i) file.data[i] = char(i * i >> 7);
    writeGzip("a.nii.gz", file.bytes());
    std::string bytes = readBytes("a.nii.gz");
    writeBytes("b.nii.gz", bytes.substr(0, bytes.size() - 4));
    expectRefused("b.nii.gz: got a gzip stream that is cut short; expected a whole one",
                  "b.nii.gz");
    bytes[bytes.size() - 6] = char(bytes[bytes.size() - 6] ^ 1);
    writeBytes("c.nii.gz", bytes);
    expectRefused(
        "c.nii.gz: got a corrupt gzip stream (incorrect data check); expected a sound one",
        "c.nii.gz");
}

}  // namespace
}  // namespace deltasplat
