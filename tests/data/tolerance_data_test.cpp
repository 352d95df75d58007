// SPDX-License-Identifier: Apache-2.0
// The proved bound of a relative tolerance beside what is measured, on every real volume.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render.h"

namespace deltasplat {
namespace {

const std::filesystem::path kData = DELTASPLAT_SHARED_DATA;

std::vector<std::filesystem::path> volumes() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kData)) {
        const std::string extension = entry.path().extension().string();
        for (const char* known : {".vdb", ".raw", ".gz", ".nrrd", ".mhd", ".nii"}) {
            if (extension == known) files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

double largestDifference(const Image& a, const Image& b, bool alpha) {
    double largest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        if ((i % 4 == 3) == alpha)
            largest = std::max(largest, std::abs(double{a.rgba[i]} - double{b.rgba[i]}));
    }
    return largest;
}

TEST(ToleranceData, NoPixelIsFartherOffThanProved) {
    if (!exists(kData)) GTEST_SKIP() << "no folder " << kData;
    int tried = 0;
    double loosest = 0;
    double tightest = 1e300;
    for (const std::filesystem::path& file : volumes()) {
        Volume volume;
        try {
            volume = readVolume(file);
        } catch (const Error&) {
            continue;  // the data of a header beside it
        }
        ++tried;
        RenderOptions options;
        options.optics.transferFunction = defaultRamp(volume);
        options.camera.direction = glm::dvec3(-1, 0.8, -0.6);
        options.camera.sizePixels = {128, 128};
        // As pictures with a tolerance are, for which the bound is.
        options.splat.mostJoined = 1;
        const RenderResult exact = render(volume, options);
        options.splat.tolerance.relative = 0.05;
        const RenderResult held = render(volume, options);
        const double alpha = largestDifference(held.image, exact.image, true);
        const double color = largestDifference(held.image, exact.image, false);
        EXPECT_LE(alpha, held.stats.errorBoundAlpha + 1e-5) << file;
        EXPECT_LE(color, held.stats.errorBoundColor + 1e-5) << file;
        EXPECT_LE(held.stats.deltas, exact.stats.deltas) << file;
        if (alpha == 0) continue;
        loosest = std::max(loosest, held.stats.errorBoundAlpha / alpha);
        tightest = std::min(tightest, held.stats.errorBoundAlpha / alpha);
    }
    EXPECT_GT(tried, 40);
    // How loose the bound is, for the record.
    std::printf("%d volumes: bound / measured from %.1f to %.1f\n", tried, tightest, loosest);
}

}  // namespace
}  // namespace deltasplat
