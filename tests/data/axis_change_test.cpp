// SPDX-License-Identifier: Apache-2.0
// Where the line of sight crosses 45 degrees the slice axis changes, and with it every sheet: the
// two pictures must agree all the same.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/vec2.hpp>
#include <string>

#include "data/data_scene.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render.h"

namespace deltasplat {
namespace {

const std::filesystem::path kData = DELTASPLAT_SHARED_DATA;
const std::filesystem::path kTransferFunctions = test::transferFunctionsOf(kData);

class AxisChange : public testing::TestWithParam<test::DataScene> {};

INSTANTIATE_TEST_SUITE_P(Data, AxisChange, test::dataScenes());

RenderResult renderTurned(const Volume& volume, const test::DataScene& scene, int size,
                          double azimuth, double elevation) {
    RenderOptions options;
    options.camera.sizePixels = glm::ivec2(size);
    options.optics.transferFunction =
        readTransferFunction(kTransferFunctions / scene.transferFunction);
    options.camera.azimuthDegrees = azimuth;
    options.camera.elevationDegrees = elevation;
    return render(volume, options);
}

double psnr(const Image& a, const Image& b) {
    return -10 * std::log10(test::meanSquare(a, b));
}

TEST_P(AxisChange, PicturesOnBothSidesOfFortyFiveDegreesAgree) {
    for (const std::filesystem::path& folder : {kData, kTransferFunctions}) {
        if (!exists(folder)) GTEST_SKIP() << "no folder " << folder;
    }
    const Volume volume = readVolume(kData / GetParam().file);
    // Voxels are divided, but not those of smoke.
    for (const int size : {512, 800}) {
        for (const bool turn : {true, false}) {
            const auto at = [&](double degrees) {
                return renderTurned(volume, GetParam(), size, turn ? degrees : 0,
                                    turn ? 0 : degrees);
            };
            const RenderResult before = at(44.95);
            const RenderResult behind = at(45.05);
            ASSERT_NE(before.stats.sliceAxis, behind.stats.sliceAxis);
            const std::string name = (turn ? "azimuth" : "elevation") + std::to_string(size);
            const double agreement = psnr(before.image, behind.image);
            RecordProperty(name, std::to_string(agreement));
            std::printf("%s: %.1f dB\n", name.c_str(), agreement);
            EXPECT_GE(agreement, 45) << name;
        }
    }
}

}  // namespace
}  // namespace deltasplat
