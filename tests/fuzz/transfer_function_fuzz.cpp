// SPDX-License-Identifier: Apache-2.0
// The bytes are a JSON file.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "deltasplat/optics/class_table.h"
#include "fuzz/fuzz_target.h"

namespace deltasplat::fuzz {
namespace {

// Eight voxels of different values.
const Volume& smallVolume() {
    static const Volume kVolume = [] {
        const std::uint8_t values[] = {0, 1, 2, 40, 90, 127, 200, 255};
        ReadOptions options;
        options.raw.dims = {2, 2, 2};
        options.raw.type = "uint8";
        return readVolume(fileWith(".raw", values, sizeof values), options);
    }();
    return kVolume;
}

bool isShare(double value) {
    return value >= 0 && value <= 1;
}

void sample(const TransferFunction& function, double x) {
    const glm::dvec3 color = function.colorAt(x);
    require(isShare(color.x) && isShare(color.y) && isShare(color.z), "colours within 0..1");
    require(isShare(function.opacityAt(x)), "opacities within 0..1");
}

void check(const TransferFunction& function) {
    require(!function.colors.empty() && !function.opacities.empty(), "points of both kinds");
    for (const auto* next = function.colors.data() + 1;
         next < function.colors.data() + function.colors.size(); ++next)
        require(next[-1].x <= next->x, "x of colours does not decrease");
    for (const auto& point : function.colors) sample(function, point.x);
    for (const auto& point : function.opacities) {
        for (const double x : {point.x, std::nextafter(point.x, 1e308), point.x * 1.001 + 1e-3})
            if (std::isfinite(x)) sample(function, x);
    }
    for (const double x : {-1e300, -1.0, 0.0, 0.3, 1.0, 255.0, 1e300}) sample(function, x);

    Optics optics;
    optics.transferFunction = function;
    const ClassTable table = classify(smallVolume(), optics, 1);
    for (int channel = 0; channel < 4; ++channel)
        require(std::isfinite(table.scale[channel]) && table.scale[channel] >= 0, "finite scales");
}

}  // namespace

std::vector<std::string> seeds() {
    return {R"([{"Name": "ct", "Normalized": true, "ColorSpaceOfPoints": "linear",
  "RGBPoints": [0.0, 0.0, 0.0, 0.0, 0.22, 0.2, 0.3, 0.6, 1.0, 1.0, 1.0, 1.0],
  "Points": [0.0, 0.0, 0.5, 0.0, 0.22, 0.0, 0.5, 0.0, 0.8, 0.4, 0.25, 0.7, 1.0, 0.6, 0.5, 1.0]}])",
            R"({"RGBPoints": [0, 1, 0, 0, 128, 0, 1, 0, 128, 0, 0, 1, 255, 1, 1, 1],
  "ColorSpace": "Step", "Points": [-10, 0, 0, 0, 40, 1, 1, 1, 40, 0.5, 0.5, 0.5]})",
            R"([{"RGBPoints": [1e-3, 0.5, 0.25, 1, 2e2, 1, 1, 1], "Annotations": ["\u00e9", null,
  {"a": [true, false, -1.5e+10]}], "ColorSpace": "Diverging"}])"};
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size > (std::size_t{1} << 16)) return 0;
    const std::string file = fuzz::fileWith(".json", data, size);
    fuzz::expectErrorsOfOneLine([&] { fuzz::check(readTransferFunction(file)); });
    std::filesystem::remove(file);
    return 0;
}
