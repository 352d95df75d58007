// SPDX-License-Identifier: Apache-2.0
// Where things are in a picture, by its pixels and by the metadata stored with it.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "deltasplat/image/write_image.h"
#include "deltasplat/render.h"
#include "support/make_volume.h"
#include "unit/temp_folder.h"

namespace deltasplat::test {
namespace {

constexpr IndexBox kBox{{-4, 2, 3}, {19, 17, 30}};

Volume oneVoxel(const glm::ivec3& at) {
    Volume volume =
        makeVolume(kBox, [&](int x, int y, int z) { return glm::ivec3(x, y, z) == at ? 100 : 0; });
    test::changed(volume)->worldFromIndex[0] = {0.5, 0.1, 0, 0};
    test::changed(volume)->worldFromIndex[1] = {0, -0.75, 0.2, 0};
    test::changed(volume)->worldFromIndex[2] = {0.3, 0, 1.25, 0};
    test::changed(volume)->worldFromIndex[3] = {10, -20, 30, 1};
    return volume;
}

// The point (0, 0 is the upper left corner) where the picture's values balance.
glm::dvec2 centreOfMass(const Image& image) {
    glm::dvec2 sum(0);
    double mass = 0;
    for (int y = 0; y < image.size.y; ++y) {
        for (int x = 0; x < image.size.x; ++x) {
            const double value = image.pixel(x, y)[0];
            sum += value * (glm::dvec2(x, y) + 0.5);
            mass += value;
        }
    }
    EXPECT_GT(mass, 0);
    return sum / mass;
}

// As OpenEXR has them: rows of a matrix that row vectors are multiplied with.
glm::dvec3 transformed(const glm::dvec3& point, const std::array<float, 16>& matrix) {
    std::array<double, 4> out{};
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) out[column] += point[row] * matrix[4 * row + column];
        out[column] += matrix[12 + column];
    }
    return glm::dvec3(out[0], out[1], out[2]) / out[3];
}

std::array<float, 16> storedMatrix(const std::string& file, const std::string& name) {
    std::array<float, 16> matrix{};
    const auto input = OIIO::ImageInput::open(file);
    EXPECT_TRUE(input && input->spec().getattribute(name, OIIO::TypeMatrix, matrix.data()));
    return matrix;
}

// The corners of the volume, each as a voxel of its own, are where the stored matrices say.
TEST(PicturePlace, CornersAreWhereTheMetadataProjectThem) {
    const TempFolder folder;
    RenderOptions options;
    options.mode = Mode::kXray;
    options.camera.view = "iso";
    options.camera.azimuthDegrees = 25;
    options.camera.rollDegrees = 10;
    options.camera.sizePixels = {240, 160};
    options.camera.frameWidthWorld = 75;
    options.camera.targetWorld = glm::dvec3(20, -25, 50);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 at(corner & 1 ? kBox.max.x : kBox.min.x,
                            corner & 2 ? kBox.max.y : kBox.min.y,
                            corner & 4 ? kBox.max.z : kBox.min.z);
        const Volume volume = oneVoxel(at);
        const RenderResult result = render(volume, options);
        ImageFileOptions file;
        file.floatExr = true;
        file.cameraFromWorld = result.camera.cameraFromWorld();
        file.ndcFromWorld = result.camera.ndcFromWorld();
        const std::string name = (folder / "out.exr").string();
        writeImage(name, result.image, file);

        const glm::dvec3 world(volume.worldFromIndex() * glm::dvec4(at, 1));
        const glm::dvec3 ndc = transformed(world, storedMatrix(name, "worldToNDC"));
        const glm::dvec2 pixel = glm::dvec2(ndc) * glm::dvec2(240, 160);
        // Half a pixel would be another corner or centre; one narrow voxel alone is resampled with
        // an error of nearly a tenth.
        EXPECT_LE(glm::distance(pixel, centreOfMass(result.image)), 0.1) << corner;
        const glm::dvec3 camera = transformed(world, storedMatrix(name, "worldToCamera"));
        EXPECT_NEAR(camera.x, (pixel.x / 240 - 0.5) * 75, 1e-3);
        EXPECT_NEAR(camera.y, (0.5 - pixel.y / 160) * 50, 1e-3);
        EXPECT_GT(camera.z, 0);
    }
}

// A mark at the head, the left hand or the nose of a patient is seen where a person would see it.
TEST(PicturePlace, PatientsStandUpright) {
    const struct {
        const char* space;
        glm::ivec3 left, front;  // on which side of the middle, in indices
    } spaces[] = {{"RAS", {-1, 0, 0}, {0, 1, 0}}, {"LPS", {1, 0, 0}, {0, -1, 0}}};
    for (const auto& patient : spaces) {
        SCOPED_TRACE(patient.space);
        const auto seen = [&](const std::string& view, const glm::ivec3& towards) {
            const glm::ivec3 at = glm::ivec3(8) + 6 * towards;
            Volume volume = makeVolume({glm::ivec3(0), glm::ivec3(16)}, [&](int x, int y, int z) {
                return glm::ivec3(x, y, z) == at ? 100 : 0;
            });
            test::changed(volume)->space = patient.space;
            RenderOptions options;
            options.mode = Mode::kXray;
            options.camera.view = view;
            options.camera.sizePixels = {64, 64};
            const glm::dvec2 place = centreOfMass(render(volume, options).image) - 32.0;
            return glm::ivec2(glm::round(place / 24.0));
        };
        const glm::ivec3 head(0, 0, 1);
        const glm::ivec2 up(0, -1), toTheRight(1, 0), middle(0, 0);
        EXPECT_EQ(seen("front", head), up);
        EXPECT_EQ(seen("front", patient.left), toTheRight);
        EXPECT_EQ(seen("front", patient.front), middle);
        EXPECT_EQ(seen("left", head), up);
        EXPECT_EQ(seen("left", patient.front), -toTheRight);
        EXPECT_EQ(seen("right", patient.front), toTheRight);
        EXPECT_EQ(seen("bottom", patient.front), up);  // as radiologists look at slices
        EXPECT_EQ(seen("bottom", patient.left), toTheRight);
        EXPECT_EQ(seen("top", patient.front), -up);
    }
}

}  // namespace
}  // namespace deltasplat::test
