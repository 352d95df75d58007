// SPDX-License-Identifier: Apache-2.0
// Real volumes seen from an eye that moves: pictures on both sides of a region's border agree, and
// a flight into a volume has no jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "data/data_scene.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render.h"

namespace deltasplat {
namespace {

const std::filesystem::path kData = DELTASPLAT_SHARED_DATA;
const std::filesystem::path kTransferFunctions = test::transferFunctionsOf(kData);

class PerspectiveData : public testing::TestWithParam<test::DataScene> {
  protected:
    void SetUp() override {
        for (const std::filesystem::path& folder : {kData, kTransferFunctions}) {
            if (!exists(folder)) GTEST_SKIP() << "no folder " << folder;
        }
        volume_ = readVolume(kData / GetParam().file);
        options_.optics.transferFunction =
            readTransferFunction(kTransferFunctions / GetParam().transferFunction);
        options_.camera.projection = Projection::kPerspective;
    }

    Image picture() const { return render(volume_, options_).image; }

    Volume volume_;
    RenderOptions options_;
};

INSTANTIATE_TEST_SUITE_P(Data, PerspectiveData, test::dataScenes());

double difference(const Image& a, const Image& b) {
    return std::sqrt(test::meanSquare(a, b));
}

// The camera goes round the volume; where lines of sight cross 45 degrees their axis changes.
TEST_P(PerspectiveData, picturesOnBothSidesOfABorderAgree) {
    for (const int size : {512, 800}) {
        for (const double fov : {10.0, 60.0}) {
            for (const bool turn : {true, false}) {
                const auto at = [&](double degrees) {
                    options_.camera.sizePixels = {size, size};
                    options_.camera.fovDegrees = fov;
                    options_.camera.azimuthDegrees = turn ? degrees : 0;
                    options_.camera.elevationDegrees = turn ? 0 : degrees;
                    return picture();
                };
                const double db = -20 * std::log10(difference(at(44.95), at(45.05)));
                const std::string name = std::to_string(size) +
                                         (turn ? " azimuth " : " elevation ") +
                                         std::to_string(int(fov));
                RecordProperty(name, std::to_string(db));
                std::printf("%s: %.1f dB\n", name.c_str(), db);
                EXPECT_GE(db, 45) << name;
            }
        }
    }
}

// Walls let light through, or passing one would be a jump (as it is for a ray marcher).
TEST_P(PerspectiveData, aFlightIntoTheVolumeHasNoJump) {
    constexpr int kFrames = 60;
    options_.optics.extinctionScale = 0.05;
    if (std::string(GetParam().file).starts_with("boston")) {
        GTEST_SKIP() << "walls thinner than a step of the flight: passing one is a jump for a ray "
                        "marcher as well";
    }
    const IndexBox& box = volume_.box();
    const auto worldAt = [&](glm::dvec3 share) {
        const glm::dvec3 index = glm::dvec3(box.min) + share * glm::dvec3(box.max - box.min);
        return glm::dvec3(volume_.worldFromIndex() * glm::dvec4(index, 1));
    };
    const glm::dvec3 from = worldAt({1.2, 0.0, 1.2});
    const glm::dvec3 to = worldAt({0.7, 0.5, 0.6});
    options_.camera.fovDegrees = 60;
    options_.camera.sizePixels = {256, 256};
    options_.camera.direction = to - from;
    std::vector<Image> frames;
    for (int i = 0; i < kFrames; ++i) {
        options_.camera.eyeWorld = from + double(i) / (kFrames - 1) * (to - from);
        frames.push_back(picture());
    }
    std::vector<double> changes;
    for (int i = 1; i < kFrames; ++i) changes.push_back(difference(frames[i - 1], frames[i]));
    double worst = 0;
    for (std::size_t i = 1; i + 1 < changes.size(); ++i) {
        const double beside = 0.5 * (changes[i - 1] + changes[i + 1]);
        worst = std::max(worst, changes[i] / beside);
        EXPECT_LE(changes[i], 1.5 * beside) << "frame " << i;
    }
    RecordProperty("worst", std::to_string(worst));
    std::printf("largest change beside those before and after: %.2f times\n", worst);
}

}  // namespace
}  // namespace deltasplat
