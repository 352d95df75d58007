// SPDX-License-Identifier: Apache-2.0
// Reads the data sets in medical formats; the expected numbers are those of their description,
// DATASETS.md, or were read from the files' bytes by another program.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;

namespace fs = std::filesystem;

class FormatsData : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!fs::is_directory(kFolder)) GTEST_SKIP() << "no data sets in " << kFolder;
    }
    static Volume read(const std::string& file) { return readVolume(kFolder / file); }
    static void expectSpacing(const Volume& volume, const glm::dvec3& spacing, double tolerance) {
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(volume.voxelSize()[axis], spacing[axis], tolerance);
        }
    }
    inline static const fs::path kFolder = DELTASPLAT_SHARED_DATA;
};

TEST_F(FormatsData, Colin27) {
    const Volume brain = read("brain_colin27/ch2.nii.gz");
    EXPECT_EQ(brain.type(), "uint8");
    EXPECT_EQ(brain.space(), "RAS");
    EXPECT_EQ(brain.box().dims(), glm::ivec3(181, 217, 181));
    expectSpacing(brain, {1, 1, 1}, 0);
}

TEST_F(FormatsData, MraHead) {
    const Volume head = read("mra_head/chris_MRA.nii.gz");
    EXPECT_EQ(head.type(), "uint8");
    EXPECT_EQ(head.box().dims(), glm::ivec3(200, 256, 120));
    expectSpacing(head, {0.521, 0.521, 0.65}, 0.0005);
    EXPECT_NEAR(double(head.histogram()[0]) / double(head.activeCount()), 0.99, 0.005);
}

// The letters run through all slices. Their voxels have values of 254 and 255: 549 a slice for the
// R, 349 for the L. In RAS the patient's right is where x is positive.
TEST_F(FormatsData, LettersOfTheMniBrain) {
    const Volume brain = read("brain_avg152/avg152T1_RL_nifti.nii.gz");
    EXPECT_EQ(brain.type(), "uint8");
    EXPECT_EQ(brain.space(), "RAS");
    EXPECT_EQ(brain.box().dims(), glm::ivec3(91, 109, 91));
    EXPECT_EQ(brain.worldFromIndex(),
              glm::dmat4(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, -90, -126, -72, 1));
    int right = 0;
    int left = 0;
    for (int y = 0; y < 109; ++y) {
        for (int x = 0; x < 91; ++x) {
            if (valueAt(brain, x, y, 5) < 254) continue;
            const glm::dvec4 world = brain.worldFromIndex() * glm::dvec4(x, y, 5, 1);
            ++(world.x > 0 ? right : left);
        }
    }
    EXPECT_EQ(right, 549);
    EXPECT_EQ(left, 349);
}

#if DELTASPLAT_DICOM

TEST_F(FormatsData, MrKnee) {
    const Volume knee = read("mr_knee/MRknee_8bit.mhd");
    EXPECT_EQ(knee.type(), "uint8");
    EXPECT_EQ(knee.box().dims(), glm::ivec3(128));
    expectSpacing(knee, {1, 1, 1}, 0);
}

TEST_F(FormatsData, SmallHead) {
    const Volume head = read("head_mr_small/HeadMRVolume.mhd");
    EXPECT_EQ(head.type(), "uint8");
    EXPECT_EQ(head.box().dims(), glm::ivec3(48, 62, 42));
    expectSpacing(head, {4, 4, 4}, 0);
    // The values are those of the raw file beside it.
    ReadOptions options;
    options.raw.dims = {48, 62, 42};
    options.raw.type = "uint8";
    EXPECT_EQ(valuesOf(head),
              valuesOf(readVolume(kFolder / "head_mr_small/HeadMRVolume.raw", options)));
}

TEST_F(FormatsData, ArmVessels) {
    const Volume arm = read("avf_mr/avf_float_32.nrrd");
    EXPECT_EQ(arm.type(), "float32");
    EXPECT_EQ(arm.space(), "LPS");
    EXPECT_EQ(arm.box().dims(), glm::ivec3(74, 93, 20));
    expectSpacing(arm, {0.7227, 0.7227, 1}, 0.0001);
    EXPECT_LT(arm.worldFromIndex()[0].x, 0);
    EXPECT_LT(arm.worldFromIndex()[1].y, 0);
    EXPECT_GT(arm.worldFromIndex()[2].z, 0);
    EXPECT_EQ(arm.valueMin(), 0);
    EXPECT_NEAR(arm.valueMax(), 2509.886963, 1e-6);
}

// How unlike two neighbouring slices are.
double difference(const Volume& volume, int a, int b) {
    double sum = 0;
    for (int y = 0; y < volume.box().dims().y; y += 4) {
        for (int x = 0; x < volume.box().dims().x; x += 4) {
            sum += std::abs(valueAt(volume, x, y, a) - valueAt(volume, x, y, b));
        }
    }
    return sum;
}

TEST_F(FormatsData, ChestInAnatomicalOrder) {
    const Volume chest = read("dicom_chest_ct");
    EXPECT_EQ(chest.type(), "int16");
    EXPECT_EQ(chest.space(), "LPS");
    EXPECT_EQ(chest.box().dims(), glm::ivec3(512, 512, 32));
    expectSpacing(chest, {0.78125, 0.78125, 1}, 1e-5);
    EXPECT_GT(chest.worldFromIndex()[2].z, 0.999);
    // Air: the intercept of -1000 has been added.
    EXPECT_EQ(chest.valueMin(), -1000);
    EXPECT_EQ(chest.valueMax(), 1761);
    // In the order of the body every slice resembles its neighbour more than one farther away.
    for (int z = 0; z + 6 < 32; ++z) {
        EXPECT_LT(difference(chest, z, z + 1), difference(chest, z, z + 6)) << z;
    }
}

TEST_F(FormatsData, OneSliceOfTheChest) {
    const Volume slice = read("dicom_chest_ct/000008.dcm");
    const Volume chest = read("dicom_chest_ct");
    // Its ImagePositionPatient is -201, -59, -515.800049.
    EXPECT_NEAR(slice.worldFromIndex()[3].z, -515.800049, 1e-9);
    const int z = int(std::lround(-515.800049 - chest.worldFromIndex()[3].z));
    for (int i = 0; i < 512; i += 7)
        EXPECT_EQ(valueAt(slice, i, 300, 0), valueAt(chest, i, 300, z));
}

#endif

// Scans that are stored with the large byte first, against a copy turned round here.
TEST_F(FormatsData, BigEndianScansTurnedRound) {
    const TempFolder folder;
    for (const auto& [file, dims] :
         {std::pair{"tooth/tooth_103x94x161_uint16be.raw.gz", "103x94x161"},
          {"ct_head/cthead_256x256x113_uint16be.raw.gz", "256x256x113"}}) {
        const Volume big = read(file);
        gzFile in = gzopen((kFolder / file).c_str(), "rb");
        std::string bytes(std::size_t(big.box().voxels()) * 2, '\0');
        ASSERT_EQ(gzread(in, bytes.data(), unsigned(bytes.size())), int(bytes.size()));
        gzclose(in);
        for (std::size_t i = 0; i < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
        const std::string copy = "copy_" + std::string(dims) + "_uint16le.raw";
        writeBytes(copy, bytes);
        const Volume little = readVolume(copy);
        EXPECT_EQ(big.histogram(), little.histogram());
        EXPECT_EQ(valuesOf(big), valuesOf(little));
    }
}

}  // namespace
}  // namespace deltasplat
