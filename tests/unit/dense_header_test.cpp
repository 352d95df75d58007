// SPDX-License-Identifier: Apache-2.0
// Headers, byte by byte as their formats' specifications have them.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "deltasplat/ingest/label_list.h"
#include "formats/format.h"
#include "unit/convert_helpers.h"

namespace deltasplat::testing {
namespace {

DenseLayout layout(const std::string& space, const std::string& unit = "") {
    DenseLayout layout;
    layout.lengthUnit = unit;
    layout.dims = {3, 4, 5};
    layout.type = RawType::kInt16;
    layout.worldFromIndex = {{0, 2, 0, 0}, {-0.5, 0, 0, 0}, {0, 0, -1.25, 0}, {10, -20, 0.1, 1}};
    layout.space = space;
    return layout;
}

std::string headerOf(const std::string& extension, const DenseLayout& layout,
                     const std::string& dataFile) {
    return findDenseFormat(extension)->header(layout, dataFile);
}

TEST(DenseHeader, Nrrd) {
    const std::string text =
        "NRRD0004\n"
        "type: int16\n"
        "dimension: 3\n"
        "space: right-anterior-superior\n"
        "sizes: 3 4 5\n"
        "space directions: (0,2,0) (-0.5,0,0) (0,0,-1.25)\n"
        "kinds: domain domain domain\n"
        "endian: little\n"
        "encoding: gzip\n"
        "space origin: (10,-20,0.1)\n";
    EXPECT_EQ(headerOf(".nrrd", layout("RAS"), ""), text + "\n");
    EXPECT_EQ(headerOf(".nrrd", layout("RAS"), "a b.raw.gz"), text + "data file: a b.raw.gz\n");
    EXPECT_NE(headerOf(".nrrd", layout("LPS"), "").find("space: left-posterior-superior\n"),
              std::string::npos);
    EXPECT_NE(headerOf(".nrrd", layout(""), "").find("space dimension: 3\n"), std::string::npos);
    EXPECT_NE(headerOf(".nrrd", layout("", "um"), "")
                  .find("space dimension: 3\nspace units: \"um\" \"um\" \"um\"\n"),
              std::string::npos);
}

TEST(DenseHeader, MetaImage) {
    const std::string text =
        "ObjectType = Image\n"
        "NDims = 3\n"
        "BinaryData = True\n"
        "BinaryDataByteOrderMSB = False\n"
        "CompressedData = False\n"
        "TransformMatrix = 0 1 0 -1 0 0 0 0 -1\n"
        "Offset = 10 -20 0.1\n"
        "CenterOfRotation = 0 0 0\n";
    const std::string rest =
        "ElementSpacing = 2 0.5 1.25\n"
        "DimSize = 3 4 5\n"
        "ElementType = MET_SHORT\n";
    // Along j, x falls, and x of LPS grows to the left: j comes from the left.
    EXPECT_EQ(headerOf(".mha", layout("LPS"), ""),
              text + "AnatomicalOrientation = ALS\n" + rest + "ElementDataFile = LOCAL\n");
    EXPECT_EQ(headerOf(".mha", layout(""), "b.raw"), text + rest + "ElementDataFile = b.raw\n");
}

template <typename T>
T at(const std::string& bytes, std::size_t place) {
    T value;
    std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
}

TEST(DenseHeader, Nifti) {
    const std::string bytes = headerOf(".nii", layout("RAS"), "");
    ASSERT_EQ(bytes.size(), 352u);
    EXPECT_EQ(at<std::int32_t>(bytes, 0), 348);
    const std::int16_t dims[] = {3, 3, 4, 5, 1, 1, 1, 1};
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(at<std::int16_t>(bytes, 40 + 2 * i), dims[i]);
    EXPECT_EQ(at<std::int16_t>(bytes, 70), 4);   // DT_INT16
    EXPECT_EQ(at<std::int16_t>(bytes, 72), 16);  // bits
    const float sizes[] = {2, 0.5, 1.25};
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(at<float>(bytes, 80 + 4 * i), sizes[i]);
    EXPECT_EQ(at<float>(bytes, 108), 352);  // where the values begin
    EXPECT_EQ(at<float>(bytes, 112), 1);    // slope
    EXPECT_EQ(at<float>(bytes, 116), 0);    // intercept
    EXPECT_EQ(at<char>(bytes, 123), 0);     // the unit is not known
    EXPECT_EQ(at<std::int16_t>(bytes, 252), 1);
    EXPECT_EQ(at<std::int16_t>(bytes, 254), 1);
    const float rows[] = {0, -0.5, 0, 10, 2, 0, 0, -20, 0, 0, -1.25, 0.1F};
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(at<float>(bytes, 280 + 4 * i), rows[i]);
    EXPECT_EQ(bytes.substr(344, 4), std::string("n+1\0", 4));
    EXPECT_EQ(at<std::int32_t>(bytes, 348), 0);  // no extensions
    EXPECT_EQ(headerOf(".nii", layout("RAS", "mm"), "")[123], 2);
    EXPECT_EQ(at<std::int16_t>(bytes, 68), 0);  // no intent
    DenseLayout labels = layout("RAS");
    labels.labels = std::make_shared<const LabelList>();
    EXPECT_EQ(at<std::int16_t>(headerOf(".nii", labels, ""), 68), 1002);
}

// Other programs take lengths in NIfTI and MetaImage for millimetres, whatever the header says.
TEST(DenseHeader, LengthsAreMillimetres) {
    WriteReport report;
    WriteNotes notes(report, "a");
    for (const auto& [unit, factor] : {std::pair{"um", 1e-3}, {"m", 1e3}, {"nm", 1e-6}}) {
        for (auto* const settle :
             {findDenseFormat(".nii")->settle, findDenseFormat(".mha")->settle}) {
            DenseLayout one = layout("", unit);
            const glm::dvec3 size = one.spacing(), place = one.origin();
            settle(one, "a", notes);
            EXPECT_EQ(one.lengthUnit, "mm");
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_DOUBLE_EQ(one.spacing()[axis], factor * size[axis]);
                EXPECT_DOUBLE_EQ(one.origin()[axis], factor * place[axis]);
            }
        }
    }
    EXPECT_NE(headerOf(".mha", layout("LPS", "mm"), "").find("DistanceUnits = mm\n"),
              std::string::npos);
    DenseLayout unknown = layout("");
    findDenseFormat(".nii")->settle(unknown, "a", notes);
    EXPECT_EQ(unknown.worldFromIndex, layout("").worldFromIndex);
}

// Segments as 3D Slicer reads them.
TEST(DenseHeader, NrrdSegments) {
    DenseLayout labels = layout("LPS");
    labels.labels = std::make_shared<const LabelList>(
        LabelList{{{3, "liver, left\nlobe", glm::dvec3(0.5, 0.25, 1)}, {12, "", {}}}});
    const std::string text = headerOf(".nrrd", labels, "");
    for (const char* const line :
         {"Segment0_ID:=Segment_1\n", "Segment0_Name:=liver, left\\nlobe\n",
          "Segment0_Color:=0.5 0.25 1\n", "Segment0_LabelValue:=3\n", "Segment0_Layer:=0\n",
          "Segment0_Extent:=0 2 0 3 0 4\n", "Segment1_LabelValue:=12\n", "Segment1_Name:=\n",
          "Segmentation_MasterRepresentation:=Binary labelmap\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line;
    EXPECT_EQ(text.find("Segment1_Color"), std::string::npos);
    labels.labels = std::make_shared<const LabelList>();
    EXPECT_NE(headerOf(".nrrd", labels, "").find("\nintent_code:=1002\n"), std::string::npos);
    EXPECT_NE(headerOf(".mha", labels, "").find("\nintent_code = 1002\n"), std::string::npos);
}

// What is beyond floats would become infinite, or nothing.
TEST(DenseHeader, NiftiPlacesBeyondFloats) {
    WriteReport report;
    WriteNotes notes(report, "a.nii");
    for (const double scale : {1e-50, 1e50}) {
        for (const int column : {0, 3}) {
            DenseLayout far = layout("RAS");
            far.worldFromIndex[column] *= scale;
            far.worldFromIndex[3].w = 1;
            if (column == 3 && scale < 1) {
                EXPECT_NO_THROW(findDenseFormat(".nii")->settle(far, "a.nii", notes));
                continue;
            }
            expectError(ErrorCode::kFailed,
                        "a.nii: got spacing, directions or origin out of range; expected ones "
                        "that 32-bit floats hold, as NIfTI has them",
                        [&] { findDenseFormat(".nii")->settle(far, "a.nii", notes); });
        }
    }
}

// The quaternion says the same as the matrix, by the formula of nifti1.h.
TEST(DenseHeader, NiftiQuaternion) {
    for (const bool mirrored : {false, true}) {
        for (const double angle : {0.3, 2.5, 3.14159, -1.7}) {
            DenseLayout turned = layout("RAS");
            turned.worldFromIndex = glm::rotate(glm::dmat4(1), angle, glm::dvec3(0.6, -0.8, 0)) *
                                    glm::scale(glm::dmat4(1), {1.5, 2, mirrored ? -3 : 3});
            const std::string bytes = headerOf(".nii", turned, "");
            const double b = at<float>(bytes, 256), c = at<float>(bytes, 260);
            const double d = at<float>(bytes, 264);
            const double a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
            const double handed = at<float>(bytes, 76);
            EXPECT_EQ(handed, mirrored ? -1 : 1);
            const double x[] = {a * a + b * b - c * c - d * d, 2 * (b * c + a * d),
                                2 * (b * d - a * c)};
            const double z[] = {2 * (b * d + a * c), 2 * (c * d - a * b),
                                a * a + d * d - b * b - c * c};
            for (int row = 0; row < 3; ++row) {
                EXPECT_NEAR(1.5 * x[row], turned.worldFromIndex[0][row], 2e-3);
                EXPECT_NEAR(3 * handed * z[row], turned.worldFromIndex[2][row], 2e-3);
            }
        }
    }
    DenseLayout sheared = layout("RAS");
    sheared.worldFromIndex[1].y = 0.1;
    EXPECT_EQ(at<std::int16_t>(headerOf(".nii", sheared, ""), 252), 0);
    EXPECT_EQ(at<std::int16_t>(headerOf(".nii", sheared, ""), 254), 1);
}

// What the files hold behind their headers, unpacked by zlib.
TEST(DenseHeader, PackedValuesFollow) {
    const TempFolder folder;
    const glm::ivec3 dims(19, 17, 10);
    const std::vector<std::uint16_t> values = pattern<std::uint16_t>(dims, 0, 65535);
    const Volume volume = rawVolume(values, dims, "uint16");
    const std::string expected = bytesOf(values);
    const auto unpacked = [&](const std::string& file, std::size_t skip) {
        const std::string bytes = readBytes(file).substr(skip);
        writeBytes("part.gz", bytes);
        std::string text(expected.size() + 1000, '\0');
        gzFile in = gzopen("part.gz", "rb");
        const int got = gzread(in, text.data(), unsigned(text.size()));
        EXPECT_EQ(gzclose(in), Z_OK);
        return text.substr(0, std::size_t(std::max(got, 0)));
    };
    write("out.nrrd", volume);
    EXPECT_EQ(unpacked("out.nrrd", readBytes("out.nrrd").find("\n\n") + 2), expected);
    write("out.nhdr", volume);
    EXPECT_EQ(unpacked("out.raw.gz", 0), expected);
    write("out.nii.gz", volume);
    EXPECT_EQ(unpacked("out.nii.gz", 0).substr(352), expected);
    write("out.nii", volume);
    EXPECT_EQ(readBytes("out.nii").substr(352), expected);
    write("out.mha", volume);
    const std::string local = readBytes("out.mha");
    EXPECT_EQ(local.substr(local.size() - expected.size()), expected);
}

}  // namespace
}  // namespace deltasplat::testing
