// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/memory_limit.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

using testing::bytesOf;
using testing::expectError;
using testing::readBytes;
using testing::TempFolder;
using testing::writeBytes;
using testing::writeGzip;

void expectInput(const std::string& message, const std::string& file,
                 const ReadOptions& options = {}) {
    expectError(ErrorCode::kInput, message, [&] { readVolume(file, options); });
    expectError(ErrorCode::kInput, message, [&] { readAllVolumes(file, options); });
}

TEST(ReadRawError, NoSuchFile) {
    const TempFolder folder;
    expectInput("a_1x1x1_uint8.raw: got no such file; expected a readable file",
                "a_1x1x1_uint8.raw");
    expectInput("none/a.vdb: got no such file; expected a readable file", "none/a.vdb");
}

TEST(ReadRawError, NoRegularFile) {
    const TempFolder folder;
    std::filesystem::create_directory("f_1x1x1_uint8.raw");
    expectInput(
        "f_1x1x1_uint8.raw: got a folder without DICOM files and images; expected a DICOM folder, "
        "a folder of images, or a file",
        "f_1x1x1_uint8.raw");
    std::ofstream("f_1x1x1_uint8.raw/v_1x1x1_uint8.raw.gz") << "x";
    expectInput(
        "f_1x1x1_uint8.raw: got a folder without DICOM files and images; expected a DICOM folder, "
        "a folder of images, or a file such as f_1x1x1_uint8.raw/v_1x1x1_uint8.raw.gz",
        "f_1x1x1_uint8.raw");
    expectInput("/dev/null: got no regular file; expected a readable file", "/dev/null");
}

TEST(ReadRawError, UnknownExtension) {
    const TempFolder folder;
    writeBytes("a.xyz", "");
    writeBytes("a.tar.gz", "");
    writeBytes("a", "");
    const std::string readable =
        "; expected .vdb, .raw, .npy, .nrrd, .nhdr, .mhd, .mha, .nii, .hdr, .img (all of these "
        "also with .gz), .dcm, .tif, .tiff, .png, .jpg, .jpeg, .bmp, .pgm or .exr";
    expectInput("a.xyz: got extension \".xyz\"" + readable, "a.xyz");
    expectInput("a.tar.gz: got extension \".tar.gz\"" + readable, "a.tar.gz");
    expectInput("a: got extension \"\"" + readable, "a");
}

TEST(ReadRawError, WrongSize) {
    const TempFolder folder;
    writeBytes("a_4x4x20_uint16.raw", std::string(639, 'x'));
    expectInput("a_4x4x20_uint16.raw: got 639 bytes; expected 640 (4x4x20 uint16)",
                "a_4x4x20_uint16.raw");
    writeBytes("a_4x4x20_uint16.raw", std::string(641, 'x'));
    expectInput("a_4x4x20_uint16.raw: got 641 bytes; expected 640 (4x4x20 uint16)",
                "a_4x4x20_uint16.raw");
    writeBytes("a_4x4x20_uint16.raw", "");
    expectInput("a_4x4x20_uint16.raw: got 0 bytes; expected 640 (4x4x20 uint16)",
                "a_4x4x20_uint16.raw");
    ReadOptions options;
    options.raw.skipBytes = 5;
    writeBytes("a_4x4x20_uint16.raw", std::string(640, 'x'));
    expectInput("a_4x4x20_uint16.raw: got 640 bytes; expected 645 (5 skipped + 4x4x20 uint16)",
                "a_4x4x20_uint16.raw", options);
}

TEST(ReadRawError, WrongSizeUnpacked) {
    const TempFolder folder;
    const std::string file = "a_4x4x20_float32.raw.gz";
    const std::string expected = " bytes unpacked; expected 1280 (4x4x20 float32)";
    for (const int bytes : {0, 3, 512, 1279, 1281, 5000000}) {
        writeGzip(file, std::string(std::size_t(bytes), '\0'));
        expectInput(file + ": got " + std::to_string(bytes) + expected, file);
    }
    ReadOptions options;
    options.raw.skipBytes = 2000;
    writeGzip(file, std::string(1280, '\0'));
    expectInput(file + ": got 1280 bytes unpacked; expected 3280 (2000 skipped + 4x4x20 float32)",
                file, options);
}

TEST(ReadRawError, DamagedGzip) {
    const TempFolder folder;
    const std::string file = "a_32x32x32_uint8.raw.gz";
    std::string bytes(32768, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = char(i * i >> 7);
    writeGzip(file, bytes);
    const std::string whole = readBytes(file);
    writeBytes(file, whole.substr(0, whole.size() / 2));
    expectInput(file + ": got a gzip stream that is cut short; expected a whole one", file);
    writeBytes(file, whole.substr(0, whole.size() - 3));
    expectInput(file + ": got a gzip stream that is cut short; expected a whole one", file);

    // The last values are there, but not what says that they are right.
    for (std::size_t missing = 1; missing <= 8; ++missing) {
        writeBytes(file, whole.substr(0, whole.size() - missing));
        expectInput(file + ": got a gzip stream that is cut short; expected a whole one", file);
    }
    for (const std::string more : {"x", "\x1f\x8b", "\x1fxxxxxxxx"}) {
        writeBytes(file, whole + more);
        EXPECT_THROW(readVolume(file), Error) << more;
    }
    writeBytes(file, whole + "text");
    expectInput(file + ": got bytes behind the gzip stream; expected nothing there", file);
    writeBytes(file, whole + std::string(5, '\0') + whole);
    expectInput(file + ": got bytes behind the gzip stream; expected nothing there", file);

    std::string wrongSum = whole;
    wrongSum[whole.size() - 6] = char(wrongSum[whole.size() - 6] ^ 1);
    writeBytes(file, wrongSum);
    expectInput(file + ": got a corrupt gzip stream (incorrect data check); expected a sound one",
                file);
    // What is not packed is read where it has the size of values.
    writeBytes(file, bytes);
    EXPECT_NO_THROW(readVolume(file));
    writeBytes(file, bytes.substr(1));
    expectInput(file + ": got no gzip stream; expected a gzip file", file);
}

// What `cat a.gz b.gz` makes, and what a block device fills up.
TEST(ReadRaw, SeveralGzipMembersAndZeros) {
    const TempFolder folder;
    const std::string file = "a_4x4x4_uint8.raw.gz";
    writeGzip(file, std::string(40, '\1'));
    const std::string first = readBytes(file);
    writeGzip(file, std::string(24, '\2'));
    writeBytes(file, first + readBytes(file) + std::string(1000, '\0'));
    const Volume volume = readVolume(file);
    EXPECT_EQ(volume.histogram()[1], 40u);
    EXPECT_EQ(volume.histogram()[2], 24u);
}

TEST(ReadRawError, NonFiniteValues) {
    const TempFolder folder;
    const std::string file = "a_10x9x40_float32.raw";
    std::vector<float> values(3600, 1.0f);
    values[1234] = std::nanf("");
    values[1235] = INFINITY;
    values[3599] = -INFINITY;
    const std::string message =
        file +
        ": got 3 NaN or infinite values, the first at (4, 6, 13); expected finite values "
        "(`nanValue` VALUE replaces them)";
    writeBytes(file, bytesOf(values));
    expectInput(message, file);
    ReadOptions options;
    options.raw.bigEndian = true;
    writeBytes(file, bytesOf(values, true));
    expectInput(message, file, options);
    options.nanValue = std::nan("");
    expectError(ErrorCode::kUsage, "`nanValue`: got nan; expected a finite number",
                [&] { readVolume(file, options); });
}

TEST(ReadRawError, RangeBeyondDoubles) {
    const TempFolder folder;
    writeBytes("a_2x1x1_float64.raw", bytesOf(std::vector<double>{-1.5e308, 1.5e308}));
    ReadOptions linear;
    linear.bits = 16;
    expectInput(
        "a_2x1x1_float64.raw: got values from -1.5e+308 to 1.5e+308; expected a range that "
        "a double can hold",
        "a_2x1x1_float64.raw", linear);
    // A table has no range.
    EXPECT_EQ(readVolume("a_2x1x1_float64.raw").valueMax(), 1.5e308);
}

TEST(ReadRawError, MoreThanGzipCanHold) {
    const TempFolder folder;
    const std::string file = "a_100000x100000x1000_uint8.raw.gz";
    writeGzip(file, std::string(1000000, '\0'));
    const std::string bytes = std::to_string(std::filesystem::file_size(file));
    expectInput(file + ": got " + bytes +
                    " bytes of gzip; expected 10000000000000 (100000x100000x1000 uint8)",
                file);
}

TEST(ReadRawError, MoreThanMemoryHolds) {
    const TempFolder folder;
    writeGzip("a_128x128x64_uint8.raw.gz", std::string(1 << 20, '\0'));
    setMemoryLimit(1);
    try {
        readVolume("a_128x128x64_uint8.raw.gz");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kFailed);
        EXPECT_EQ(std::string(error.what()).rfind("a_128x128x64_uint8.raw.gz: needs ", 0), 0u)
            << error.what();
    }
    setMemoryLimit(0);
}

TEST(ReadRawError, TheListenerStopsTheWork) {
    const TempFolder folder;
    for (const std::string type : {"uint8", "float32"}) {
        const std::string file = "a_8x8x800_" + type + ".raw";
        writeBytes(file, std::string(8 * 8 * 800 * (type == "uint8" ? 1 : 4), '\0'));
        int calls = 0;
        Listener listener;
        listener.progress = [&](double) {
            if (++calls == 3) throw Error(ErrorCode::kInterrupted, "stopped");
        };
        expectError(ErrorCode::kInterrupted, "stopped", [&] { readVolume(file, {}, listener); });
        EXPECT_EQ(calls, 3);
    }
}

}  // namespace
}  // namespace deltasplat
