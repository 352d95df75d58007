// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <ostream>

#include "deltasplat/image/image.h"

namespace deltasplat::test {

/// A data set and the transfer function that it is looked at with.
struct DataScene {
    const char* file;
    const char* transferFunction;
};

inline void PrintTo(const DataScene& scene, std::ostream* out) {
    *out << scene.file;
}

/// Opaque, hollow and thin.
inline auto dataScenes() {
    return testing::Values(
        DataScene{"engine/engine_256x256x128_uint8.raw.gz", "tf_ct.json"},
        DataScene{"boston_teapot/boston_teapot_256x256x178_uint8.raw.gz", "tf_ct.json"},
        DataScene{"vdb_smoke/smoke.vdb", "tf_fog.json"});
}

/// Returns the folder of transfer functions beside that of the data sets.
inline std::filesystem::path transferFunctionsOf(const std::filesystem::path& data) {
    return data / "../bench";
}

/// Returns the mean square of how far pictures of one size differ.
inline double meanSquare(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        sum += std::pow(double(a.rgba[i]) - double(b.rgba[i]), 2);
    return sum / double(a.rgba.size());
}

}  // namespace deltasplat::test
