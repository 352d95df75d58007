// SPDX-License-Identifier: Apache-2.0
#include "golden/golden_volumes.h"

#include <cmath>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/synth/write_analytic.h"
#include "synth/noise.h"
#include "unit/temp_folder.h"

namespace deltasplat::test {
namespace {

// A number 0..1 that depends on the seed and the position.
double unitAt(std::uint64_t seed, const glm::dvec3& p) {
    const auto part = [](double x) { return std::uint64_t(std::int64_t(x * 65536)); };
    return unitFromBits(hash3(seed, part(p.x), part(p.y), part(p.z)));
}

double squared(const glm::dvec3& p) {
    return p.x * p.x + p.y * p.y + p.z * p.z;
}

AnalyticVolume made(const std::string& name, double (*valueAt)(const glm::dvec3&)) {
    return {name, valueAt};
}

// Thin fog in a ball, and one small thing a hundred thousand times as dense.
double fogBesideRock(const glm::dvec3& p) {
    if (squared(p - glm::dvec3(0.4, 0.1, -0.3)) < 0.02) return 1;
    return squared(p) < 0.8 ? 1e-5 * (1 - 0.5 * squared(p)) : 0;
}

// More values than there are codes, over six decades and of both signs.
double decades(const glm::dvec3& p) {
    const double size = std::ldexp(0.5 + 0.5 * unitAt(1, p), -int(20 * unitAt(2, p)));
    return unitAt(3, p) < 0.3 ? 0 : unitAt(3, p) < 0.5 ? -size : size;
}

// Values that a float holds as denormals only.
double faintest(const glm::dvec3& p) {
    return squared(p) < 0.9 ? 1e-39 * (1 + unitAt(4, p)) : 0;
}

double fewCodes(const glm::dvec3& p) {
    return unitAt(5, p) < 0.6 ? 0 : std::floor(8 * unitAt(6, p)) / 8;
}

Volume throughFile(const AnalyticVolume& volume, const std::string& extension,
                   const AnalyticFileOptions& options) {
    const TempFolder folder;
    const glm::ivec3 d = options.dims;
    const std::string name = "v_" + std::to_string(d.x) + "x" + std::to_string(d.y) + "x" +
                             std::to_string(d.z) + "_" +
                             (options.type.empty() ? "uint8" : options.type) + extension;
    writeAnalytic(volume, folder / name, options);
    ReadOptions read;
    if (extension == ".raw") read.raw.spacing = options.spacing;
    return readVolume(folder / name, read);
}

}  // namespace

std::map<std::string, Volume> goldenVolumes() {
    std::map<std::string, Volume> volumes;
    const auto add = [&](const AnalyticVolume& volume, const std::string& extension,
                         const AnalyticFileOptions& options) {
        volumes.emplace(volume.name, throughFile(volume, extension, options));
    };
    add(makeAnalytic("engine"), ".raw", {{44, 40, 36}, "uint8"});
    add(makeAnalytic("cloud"), ".vdb", {{40, 33, 36}, ""});
    add(makeAnalytic("hydrogen"), ".raw", {{33, 33, 33}, "float32", {1, 0.7, 1.3}});
    add(makeAnalytic("marschner-lobb"), ".raw", {{32, 32, 32}, "uint16"});
    add(makeAnalytic("shepp-logan"), ".raw", {{36, 40, 24}, "uint8", {1, 1, 1.7}});
    add(makeAnalytic("vessels"), ".vdb", {{48, 48, 48}, "", {0.5, 0.5, 0.5}});
    add(makeAnalytic("slab"), ".raw", {{30, 20, 10}, "uint8", {1, 1, 4}});
    AnalyticVolume noisy = makeAnalytic("engine", 7, 0.05);
    noisy.name = "noisy";
    add(noisy, ".raw", {{40, 40, 40}, "uint8"});
    add(made("fog", fogBesideRock), ".vdb", {{32, 32, 40}, ""});
    add(made("decades", decades), ".raw", {{44, 44, 44}, "float32"});
    add(made("faintest", faintest), ".raw", {{16, 16, 16}, "float32"});
    add(made("few", fewCodes), ".vdb", {{30, 25, 35}, "", {1, 1.1, 0.9}});
    return volumes;
}

}  // namespace deltasplat::test
