// SPDX-License-Identifier: Apache-2.0
#include "../tools/table1/table1.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "../tools/table1/ct_ramp.h"
#include "deltasplat/view/camera.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

TEST(CtRamp, IsThatOfTheExamples) {
    const TransferFunction file =
        readTransferFunction(std::filesystem::path(DELTASPLAT_SOURCE_DIR) / "examples" / "ct.json");
    const TransferFunction ramp = ctRamp();
    EXPECT_EQ(ramp.name, file.name);
    EXPECT_EQ(ramp.normalized, file.normalized);
    EXPECT_EQ(ramp.linearColors, file.linearColors);
    ASSERT_EQ(ramp.colors.size(), file.colors.size());
    for (std::size_t i = 0; i < file.colors.size(); ++i) {
        EXPECT_EQ(ramp.colors[i].x, file.colors[i].x);
        EXPECT_EQ(ramp.colors[i].rgb, file.colors[i].rgb);
    }
    ASSERT_EQ(ramp.opacities.size(), file.opacities.size());
    for (std::size_t i = 0; i < file.opacities.size(); ++i) {
        EXPECT_EQ(ramp.opacities[i].x, file.opacities[i].x);
        EXPECT_EQ(ramp.opacities[i].opacity, file.opacities[i].opacity);
        EXPECT_EQ(ramp.opacities[i].midpoint, file.opacities[i].midpoint);
        EXPECT_EQ(ramp.opacities[i].sharpness, file.opacities[i].sharpness);
    }
}

TEST(Table1Options, PutsEveryVoxelIntoTheMiddleOfItsPixel) {
    const Volume volume =
        test::makeVolume({glm::ivec3(0), glm::ivec3(19, 11, 7)}, [](int x, int, int) { return x; });
    const RenderOptions options = table1Options(volume, ctRamp());
    const Camera camera = makeCamera(options.camera, volume.box(), volume.worldFromIndex());
    EXPECT_EQ(camera.sizePixels, glm::ivec2(20, 12));
    EXPECT_EQ(camera.direction, glm::dvec3(0, 0, -1));
    for (const glm::ivec2 voxel : {glm::ivec2(0, 0), glm::ivec2(7, 3), glm::ivec2(19, 11)}) {
        const glm::dvec4 world = volume.worldFromIndex() * glm::dvec4(voxel, 4, 1);
        const glm::dvec2 pixel = camera.pixelFromWorld(glm::dvec3(world));
        EXPECT_NEAR(pixel.x, voxel.x + 0.5, 1e-9);
        EXPECT_NEAR(pixel.y, 11 - voxel.y + 0.5, 1e-9);
    }
}

TEST(Table1Options, StampsTheFootprintOfThePaper) {
    const Volume volume = test::makeVolume({glm::ivec3(0), glm::ivec3(19, 11, 7)},
                                           [](int x, int, int) { return 10 * x; });
    const RenderResult result = render(volume, table1Options(volume, ctRamp()));
    EXPECT_EQ(result.stats.footprint, 6);
    EXPECT_EQ(result.stats.resolution, 1);
    EXPECT_EQ(result.stats.sliceAxis, 2);
}

}  // namespace
}  // namespace deltasplat
