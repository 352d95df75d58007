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
            EXPECT_EQ(volume.name(), "a");
            EXPECT_EQ(volume.type(), "int16");
            EXPECT_EQ(volume.space(), "RAS");
            EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 2));
            EXPECT_EQ(valuesOf(volume), kRamp);
            EXPECT_EQ(volume.worldFromIndex(),
                      glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
            EXPECT_TRUE(warnings.lines.empty());
        }
    }
}

TEST(ReadNifti, Gzip) {
    const TempFolder folder;
    writeGzip("b.nii.gz", sample(2, true).bytes());
    const Volume volume = readVolume("b.nii.gz");
    EXPECT_EQ(volume.name(), "b");
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
        EXPECT_EQ(volume.type(), name);
        EXPECT_EQ(valuesOf(volume), ramp<double>(24, 3, 4)) << name;
        EXPECT_TRUE(volume.codeBook().isExact());
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
    EXPECT_EQ(volume.valueMin(), 1);
    EXPECT_NEAR(volume.valueMax(), 0x1p64, 0x1p49);
}

TEST(ReadNifti, SlopeAndIntercept) {
    const TempFolder folder;
    for (const int version : {1, 2}) {
        for (const bool bigEndian : {false, true}) {
            NiftiFile file = sample(version, bigEndian);
            file.slope = 0.5;
            file.intercept = -3;
            const Volume volume = read(file);
            EXPECT_EQ(volume.type(), "float32");
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
    EXPECT_EQ(volume.type(), "float64");
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
        EXPECT_EQ(volume.type(), "int16");
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
        EXPECT_EQ(volume.space(), "RAS");
        expectNear(volume.worldFromIndex(),
                   glm::dmat4(0, 2, 0, 0, -3, 0, 0, 0, 0, 0, -4, 0, 7, 8, 9, 1));
    }
}

TEST(ReadNifti, ShearedSformIsKept) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.sform = {2, 0.5, 0, 10, 0, 3, 0.25, 20, 0, 0, 4, 30};
    EXPECT_EQ(read(file).worldFromIndex(),
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
    EXPECT_EQ(read(file, other.listener()).worldFromIndex()[3].z, 30);
    EXPECT_EQ(other.lines,
              std::vector<std::string>{"a.nii: sform and qform differ; the sform is taken"});
}

TEST(ReadNifti, WithoutQformAndSform) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.sformCode = 0;
    Warnings warnings;
    const Volume volume = read(file, warnings.listener());
    EXPECT_EQ(volume.space(), "");
    EXPECT_EQ(volume.worldFromIndex(), glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1));
    EXPECT_EQ(warnings.lines,
              std::vector<std::string>{"a.nii: neither sform nor qform: only the voxel size is "
                                       "known, not where the volume lies or which side is left"});
}

// Sizes below 0 mirror nothing: a quaternion and a matrix do.
TEST(ReadNifti, SizesBelowZero) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.sformCode = 0;
    for (const int qform : {0, 1}) {
        file.qformCode = qform;
        file.pixelSizes = {1, 2, 3, 4, 1, 1, 1, 1};
        const Volume plain = read(file);
        file.pixelSizes = {1, -2, 3, -4, 1, 1, 1, 1};
        Warnings warnings;
        EXPECT_EQ(read(file, warnings.listener()).worldFromIndex(), plain.worldFromIndex());
        EXPECT_EQ(warnings.lines.front(),
                  "a.nii: a voxel size below 0 is taken as if it were positive");
    }
}

// A patient's space is in millimetres; without one, lengths are what the file says.
TEST(ReadNifti, Units) {
    const TempFolder folder;
    const std::string turned = ", and are turned into millimetres";
    for (const auto& [code, factor, unit, line] :
         {std::tuple{1, 1e3, "m", "a.nii: lengths are in metres" + turned},
          {2, 1.0, "mm", std::string()},
          {3, 1e-3, "um", "a.nii: lengths are in micrometres" + turned},
          {0, 1.0, "", std::string()}}) {
        for (const int version : {1, 2}) {
            for (const bool bigEndian : {false, true}) {
                NiftiFile file = sample(version, bigEndian);
                file.units = code + 8;  // seconds
                writeBytes("a.nii", file.bytes());
                Warnings warnings;
                const Volume volume = readVolume("a.nii", {}, warnings.listener());
                EXPECT_EQ(volume.lengthUnit(), code == 0 ? "" : "mm");
                const glm::dmat4 world(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1);
                for (int i = 0; i < 16; ++i) {
                    const double wanted = i == 15 ? 1 : factor * world[i / 4][i % 4];
                    EXPECT_DOUBLE_EQ(volume.worldFromIndex()[i / 4][i % 4], wanted) << unit;
                }
                EXPECT_EQ(warnings.lines, line.empty() ? std::vector<std::string>()
                                                       : std::vector<std::string>{line});
                file.sformCode = 0;
                writeBytes("b.nii", file.bytes());
                EXPECT_EQ(readVolume("b.nii").lengthUnit(), unit);
                EXPECT_EQ(readVolume("b.nii").voxelSize(), glm::dvec3(2, 3, 4));
            }
        }
    }
}

// A form that gives voxels no place is as none: the other counts, else voxel sizes do.
TEST(ReadNifti, FormsWithoutPlaces) {
    const TempFolder folder;
    const auto warned = [](const NiftiFile& file) {
        writeBytes("a.nii", file.bytes());
        Warnings warnings;
        const Volume volume = readVolume("a.nii", {}, warnings.listener());
        return std::pair{volume, warnings.lines};
    };
    const std::string neither =
        "a.nii: neither sform nor qform: only the voxel size is known, not where the volume lies "
        "or which side is left";
    for (const std::vector<double>& sform : {std::vector<double>(12, 0),
                                             {1, 0, 0, 5, 2, 0, 0, 5, 0, 0, 4, 5},
                                             {NAN, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30}}) {
        NiftiFile file = sample();
        file.sform = sform;
        file.qformCode = 1;
        file.quaternion = {0, 0, 0, 7, 8, 9};
        auto [volume, lines] = warned(file);
        EXPECT_EQ(volume.space(), "RAS");
        EXPECT_EQ(volume.worldFromIndex(),
                  glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 7, 8, 9, 1));
        EXPECT_EQ(lines, std::vector<std::string>{
                             "a.nii: the sform gives voxels no place; the qform is taken"});
        file.qformCode = 0;
        std::tie(volume, lines) = warned(file);
        EXPECT_EQ(volume.space(), "");
        EXPECT_EQ(volume.voxelSize(), glm::dvec3(2, 3, 4));
        EXPECT_EQ(lines,
                  (std::vector<std::string>{
                      "a.nii: the sform gives voxels no place; the voxel size is taken", neither}));
    }
    NiftiFile file = sample();
    file.sformCode = 0;
    file.qformCode = 1;
    file.quaternion[1] = INFINITY;
    const auto [volume, lines] = warned(file);
    EXPECT_EQ(volume.space(), "");
    EXPECT_EQ(volume.voxelSize(), glm::dvec3(2, 3, 4));
    EXPECT_EQ(lines,
              (std::vector<std::string>{
                  "a.nii: the qform gives voxels no place; the voxel size is taken", neither}));
}

// A count of 0 is 1, as is a size of 0; a single slice has a thickness.
TEST(ReadNifti, ZerosAreOnes) {
    const TempFolder folder;
    NiftiFile file = sample();
    for (const std::vector<int>& dims :
         {std::vector<int>{4, 6, 0}, {4, 6, 0, 0}, {4, 6, 1, 0, 0}}) {
        file.dims = dims;
        writeBytes("a.nii", file.bytes());
        EXPECT_EQ(readVolume("a.nii").box().dims(), glm::ivec3(4, 6, 1));
    }
    // One slice, whose header leaves out what lies across it.
    for (const auto& [dims, thickness, wanted] : {std::tuple{std::vector<int>{4, 6}, 0.0, 1.0},
                                                  {std::vector<int>{4, 6}, 2.5, 2.5},
                                                  {std::vector<int>{4, 6, 1}, 0.0, 1.0}}) {
        for (const bool bySform : {false, true}) {
            file.dims = dims;
            file.sformCode = bySform ? 1 : 0;
            file.qformCode = bySform ? 0 : 1;
            file.pixelSizes = {1, 0.5, 0.25, thickness, 0, 0, 0, 0};
            // x to the back, y up: the slice lies across from left to right.
            file.sform = {0, 0, 0, 10, 0.5, 0, 0, 20, 0, 0.25, 0, 30};
            writeBytes("b.nii", file.bytes());
            Warnings warnings;
            const Volume volume = readVolume("b.nii", {}, warnings.listener());
            EXPECT_EQ(volume.voxelSize(), glm::dvec3(0.5, 0.25, wanted));
            EXPECT_EQ(volume.space(), "RAS");
            EXPECT_EQ(warnings.lines, std::vector<std::string>());
            if (!bySform) continue;
            EXPECT_EQ(glm::dvec3(volume.worldFromIndex()[2]), glm::dvec3(wanted, 0, 0));
        }
    }
}

// A pair is read by either name, and each file may be packed.
TEST(ReadNifti, Pairs) {
    const TempFolder folder;
    for (const int version : {1, 2}) {
        NiftiFile file = sample(version);
        file.magic = version == 1 ? "ni1" : std::string("ni2\0\r\n\x1a\n", 8);
        const std::string data = file.data;
        file.data.clear();
        std::string header = file.bytes();
        // Where data begin in their file.
        std::fill_n(header.begin() + (version == 1 ? 108 : 168), version == 1 ? 4 : 8, '\0');
        writeBytes("a.hdr", header.substr(0, version == 1 ? 348 : 540));
        writeBytes("a.img", data);
        writeGzip("b.hdr.gz", header);
        writeGzip("b.img.gz", data);
        writeBytes("C.HDR", header);
        writeGzip("C.IMG", data);
        for (const char* const name :
             {"a.hdr", "a.img", "b.hdr.gz", "b.img.gz", "C.HDR", "C.IMG"}) {
            const Volume volume = readVolume(name);
            EXPECT_EQ(volume.name(), std::string(1, name[0])) << name;
            EXPECT_EQ(valuesOf(volume), kRamp) << name;
            EXPECT_EQ(volume.space(), "RAS");
        }
    }
    // The file that is named, and no other of the same name.
    writeGzip("a.img.gz", bytesOf(ramp<std::int16_t>(24, 3)));
    EXPECT_EQ(valuesOf(readVolume("a.img.gz")), ramp<double>(24, 3));
    // One piece, whatever it is called.
    writeBytes("d.hdr", sample().bytes());
    EXPECT_EQ(valuesOf(readVolume("d.hdr")), kRamp);
}

// Packed or plain is what the bytes are, not what the name says.
TEST(ReadNifti, PackedByContent) {
    const TempFolder folder;
    writeGzip("a.nii", sample().bytes());
    writeBytes("b.nii.gz", sample().bytes());
    for (const char* const name : {"a.nii", "b.nii.gz"})
        EXPECT_EQ(valuesOf(readVolume(name)), kRamp) << name;
}

TEST(ReadNifti, OneTwoAndFourDimensions) {
    const TempFolder folder;
    NiftiFile file = sample();
    file.dims = {24};
    EXPECT_EQ(read(file).box().dims(), glm::ivec3(24, 1, 1));
    file.dims = {4, 6};
    EXPECT_EQ(read(file).box().dims(), glm::ivec3(4, 6, 1));
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
                    EXPECT_EQ(got.box().dims(), glm::ivec3(4, 3, 2));
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
    EXPECT_EQ(readVolume("a.nii", options).valueMax(), 1310);
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
