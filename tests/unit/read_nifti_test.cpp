// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>

#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/memory_limit.h"
#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

const std::vector<double> kRamp = ramp<double>(24, -5);

NiftiFile sample(int version = 1, bool bigEndian = false) {
    NiftiFile file;
    file.version = version;
    file.bigEndian = bigEndian;
    file.data = bytesOf(ramp<std::int16_t>(24, -5), bigEndian);
    return file;
}

Volume read(const NiftiFile& file, const Listener& listener = {}) {
    writeBytes("a.nii", file.bytes());
    return readVolume("a.nii", {}, listener);
}

TEST(ReadNifti, BothVersionsAndByteOrders) {
    const TempFolder folder;
    for (const int version : {1, 2}) {
        for (const bool bigEndian : {false, true}) {
            SCOPED_TRACE(version + (bigEndian ? 0.5 : 0));
            Warnings warnings;
            const Volume volume = read(sample(version, bigEndian), warnings.listener());
            EXPECT_EQ(volume.name, "a");
            EXPECT_EQ(volume.type, "int16");
            EXPECT_EQ(volume.space, "RAS");
            EXPECT_EQ(volume.box.dims(), glm::ivec3(4, 3, 2));
            EXPECT_EQ(valuesOf(volume), kRamp);
            EXPECT_EQ(volume.worldFromIndex,
                      glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
            EXPECT_TRUE(warnings.lines.empty());
        }
    }
}

TEST(ReadNifti, Gzip) {
    const TempFolder folder;
    writeGzip("b.nii.gz", sample(2, true).bytes());
    const Volume volume = readVolume("b.nii.gz");
    EXPECT_EQ(volume.name, "b");
    EXPECT_EQ(valuesOf(volume), kRamp);
}

template <typename T>
void expectType(int code, const std::string& name) {
    for (const bool bigEndian : {false, true}) {
        NiftiFile file = sample(1, bigEndian);
        file.dataType = code;
        file.bits = 8 * sizeof(T);
        file.data = bytesOf(ramp<T>(24, 3, 4), bigEndian);
        const Volume volume = read(file);
        EXPECT_EQ(volume.type, name);
        EXPECT_EQ(valuesOf(volume), ramp<double>(24, 3, 4)) << name;
        EXPECT_TRUE(volume.codeBook.isExact());
    }
}

TEST(ReadNifti, Types) {
    const TempFolder folder;
    expectType<std::uint8_t>(2, "uint8");
    expectType<std::int16_t>(4, "int16");
    expectType<std::int32_t>(8, "int32");
    expectType<float>(16, "float32");
    expectType<double>(64, "float64");
    expectType<std::int8_t>(256, "int8");
    expectType<std::uint16_t>(512, "uint16");
    expectType<std::uint32_t>(768, "uint32");
    expectType<std::int64_t>(1024, "int64");
    expectType<std::uint64_t>(1280, "uint64");
}

TEST(ReadNifti, WholeNumbersBeyondDoubles) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dataType = 1280;
    std::vector<std::uint64_t> values(24, 1);
    values[5] = ~std::uint64_t{0};
    file.data = bytesOf(values);
    const Volume volume = read(file);
    EXPECT_EQ(volume.valueMin, 1);
    EXPECT_NEAR(volume.valueMax, 0x1p64, 0x1p49);
}

TEST(ReadNifti, SlopeAndIntercept) {
    const TempFolder folder;
    for (const int version : {1, 2}) {
        for (const bool bigEndian : {false, true}) {
            NiftiFile file = sample(version, bigEndian);
            file.slope = 0.5;
            file.intercept = -3;
            const Volume volume = read(file);
            EXPECT_EQ(volume.type, "float32");
            EXPECT_EQ(valuesOf(volume), ramp<double>(24, -5.5, 0.5));
        }
    }
    // 32-bit values keep their precision.
    NiftiFile file = sample();
    file.dataType = 8;
    file.data = bytesOf(ramp<std::int32_t>(24, 1 << 30));
    file.slope = 2;
    file.intercept = 1;
    const Volume volume = read(file);
    EXPECT_EQ(volume.type, "float64");
    EXPECT_EQ(valuesOf(volume), ramp<double>(24, 2147483649.0, 2));
}

TEST(ReadNifti, ASlopeThatIsNoneKeepsIntegers) {
    const TempFolder folder;
    for (const auto& [slope, intercept] :
         {std::pair{1.0, 0.0}, {0.0, 7.0}, {std::nan(""), 1.0}, {2.0, double(INFINITY)}}) {
        NiftiFile file = sample();
        file.slope = slope;
        file.intercept = intercept;
        const Volume volume = read(file);
        EXPECT_EQ(volume.type, "int16");
        EXPECT_EQ(valuesOf(volume), kRamp);
    }
}

void expectNear(const glm::dmat4& got, const glm::dmat4& expected) {
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) EXPECT_NEAR(got[i][j], expected[i][j], 1e-6) << i << "," << j;
    }
}

TEST(ReadNifti, QformTurnsAndMirrors) {
    const TempFolder folder;
    for (const int version : {1, 2}) {
        NiftiFile file = sample(version);
        file.sformCode = 0;
        file.qformCode = 1;
        // A quarter turn about z: x to y, y to -x; and the third axis mirrored.
        file.quaternion = {0, 0, std::sqrt(0.5), 7, 8, 9};
        file.pixelSizes[0] = -1;
        const Volume volume = read(file);
        EXPECT_EQ(volume.space, "RAS");
        expectNear(volume.worldFromIndex,
                   glm::dmat4(0, 2, 0, 0, -3, 0, 0, 0, 0, 0, -4, 0, 7, 8, 9, 1));
    }
}

TEST(ReadNifti, ShearedSformIsKept) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.sform = {2, 0.5, 0, 10, 0, 3, 0.25, 20, 0, 0, 4, 30};
    EXPECT_EQ(read(file).worldFromIndex,
              glm::dmat4(2, 0, 0, 0, 0.5, 3, 0, 0, 0, 0.25, 4, 0, 10, 20, 30, 1));
}

TEST(ReadNifti, SformWinsOverAQformThatDiffers) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.qformCode = 1;
    file.quaternion = {0, 0, 0, 10, 20, 30};
    Warnings same;
    read(file, same.listener());
    EXPECT_TRUE(same.lines.empty());
    file.quaternion = {0, 0, 0, 10, 20, 50};
    Warnings other;
    EXPECT_EQ(read(file, other.listener()).worldFromIndex[3].z, 30);
    EXPECT_EQ(other.lines,
              std::vector<std::string>{"a.nii: sform and qform differ; the sform is taken"});
}

TEST(ReadNifti, WithoutQformAndSform) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.sformCode = 0;
    Warnings warnings;
    const Volume volume = read(file, warnings.listener());
    EXPECT_EQ(volume.space, "");
    EXPECT_EQ(volume.worldFromIndex, glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1));
    EXPECT_EQ(warnings.lines,
              std::vector<std::string>{"a.nii: neither sform nor qform: only the voxel size is "
                                       "known, not where the volume lies or which side is left"});
}

TEST(ReadNifti, Units) {
    const TempFolder folder;
    for (const int version : {1, 2}) {
        for (const bool bigEndian : {false, true}) {
            NiftiFile file = sample(version, bigEndian);
            file.units = 3 + 8;  // micrometres, seconds
            Warnings warnings;
            EXPECT_EQ(read(file, warnings.listener()).voxelSize(), glm::dvec3(2, 3, 4));
            EXPECT_EQ(warnings.lines,
                      std::vector<std::string>{"a.nii: lengths are in micrometres, and stay so"});
        }
    }
}

TEST(ReadNifti, OneTwoAndFourDimensions) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {24};
    EXPECT_EQ(read(file).box.dims(), glm::ivec3(24, 1, 1));
    file.dims = {4, 6};
    EXPECT_EQ(read(file).box.dims(), glm::ivec3(4, 6, 1));
    file.dims = {4, 3, 2, 1, 1};
    EXPECT_EQ(valuesOf(read(file)), kRamp);
}

// Time is the fourth axis, the parts of vectors are the fifth.
TEST(ReadNifti, VolumesAreChosen) {
    const TempFolder folder;
    for (const auto& dims : {std::vector{4, 3, 2, 6}, {4, 3, 2, 1, 6}, {4, 3, 2, 2, 3}}) {
        for (const bool bigEndian : {false, true}) {
            NiftiFile file = sample(dims.size() == 5 ? 2 : 1, bigEndian);
            file.dims = dims;
            file.slope = 0.5;
            file.intercept = 1;
            file.dataStart = 600;
            const int header = file.version == 1 ? 352 : 544;
            file.data = std::string(std::size_t(600 - header), 'x') +
                        bytesOf(ramp<std::int16_t>(144), bigEndian) + "bytes behind";
            writeBytes("a.nii", file.bytes());
            writeGzip("b.nii.gz", file.bytes());
            for (const std::string name : {"a.nii", "b.nii.gz"}) {
                ReadOptions options;
                for (int volume = 0; volume < 6; ++volume) {
                    options.volume = volume;
                    const Volume got = readVolume(name, options);
                    EXPECT_EQ(got.box.dims(), glm::ivec3(4, 3, 2));
                    EXPECT_EQ(valuesOf(got), ramp<double>(24, 1 + 12 * volume, 0.5));
                }
            }
        }
    }
}

TEST(ReadNifti, AVolumeThatIsNotThere) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {4, 3, 2, 5};
    file.data = bytesOf(ramp<std::int16_t>(120));
    writeBytes("a.nii", file.bytes());
    ReadOptions options;
    for (const std::int64_t volume : {std::int64_t{5}, std::int64_t{-1}, INT64_MAX}) {
        options.volume = volume;
        expectRefused("a.nii: got no volume " + std::to_string(volume) +
                          " among 5 volumes (dims 4x3x2x5); expected `volume` 0 to 4",
                      "a.nii", options);
    }
    writeBytes("b.nii", sample().bytes());
    options.volume = 1;
    expectRefused("b.nii: got no volume 1 among 1 volume (dims 4x3x2); expected `volume` 0",
                  "b.nii", options);
    options.volume = 0;
    EXPECT_EQ(valuesOf(readVolume("b.nii", options)), kRamp);
}

// The last of a million volumes, of which all but that are holes: neither memory nor time goes to
// those before it.
TEST(ReadNifti, OtherVolumesAreNotTouched) {
    const TempFolder folder;
    NiftiFile file = sample(2);
    file.dims = {64, 64, 32, 1 << 20};
    file.data.clear();
    const std::string header = file.bytes();
    writeBytes("a.nii", header);
    const std::uint64_t volumeBytes = 64 * 64 * 32 * 2;
    std::error_code error;
    std::filesystem::resize_file("a.nii", header.size() + (volumeBytes << 20), error);
    if (error) GTEST_SKIP() << "no file of 256 GiB with holes here: " << error.message();
    std::fstream out("a.nii", std::ios::binary | std::ios::in | std::ios::out);
    out.seekp(-std::streamoff(volumeBytes), std::ios::end);
    out << bytesOf(ramp<std::int16_t>(64 * 64 * 32, 0, 0.01));
    out.close();
    ReadOptions options;
    options.volume = (1 << 20) - 1;
    setMemoryLimit(std::uint64_t{2} << 30);
    EXPECT_EQ(readVolume("a.nii", options).valueMax, 1310);
    setMemoryLimit(0);
}

TEST(ReadNifti, VolumesAreListed) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {4, 3, 2, 5};
    file.data = bytesOf(ramp<std::int16_t>(120));
    writeBytes("a.nii", file.bytes());
    const std::vector<VolumeEntry> entries = listVolumes("a.nii");
    ASSERT_EQ(entries.size(), 1u);
    EXPECT_EQ(entries[0].volumes, 5);
    EXPECT_EQ(entries[0].box->dims(), glm::ivec3(4, 3, 2));
    EXPECT_FALSE(entries[0].preferred);
    writeBytes("a.nii", sample().bytes());
    EXPECT_EQ(listVolumes("a.nii")[0].volumes, 1);
    EXPECT_TRUE(listVolumes("a.nii")[0].preferred);
}

TEST(ReadNifti, DataBehindExtensions) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dataStart = 400;
    file.data = std::string(48, 'x') + file.data + "bytes behind";
    EXPECT_EQ(valuesOf(read(file)), kRamp);
}

TEST(ReadNifti, ManySlices) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {9, 7, 37};
    file.slope = 2;
    file.data = bytesOf(ramp<std::int16_t>(9 * 7 * 37));
    EXPECT_EQ(valuesOf(read(file)), ramp<double>(9 * 7 * 37, 0, 2));
}

}  // namespace
}  // namespace deltasplat
