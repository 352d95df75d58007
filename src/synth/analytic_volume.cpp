// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/synth/analytic_volume.h"

#include <cmath>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "synth/volumes.h"

namespace deltasplat {

const std::vector<std::string>& analyticNames() {
    static const std::vector<std::string> kNames = {
        "marschner-lobb", "hydrogen", "shepp-logan", "engine", "cloud",
        "slab",           "vessels",  "body",        "fire",   "explosion"};
    return kNames;
}

AnalyticVolume makeAnalytic(const std::string& name, std::uint64_t seed, double noise) {
    const DefaultFloats floats;
    if (!(noise >= 0) || !std::isfinite(noise)) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("`noise`", std::to_string(noise), "a number of at least 0"));
    }
    if (name == "marschner-lobb") return {name, makeMarschnerLobb()};
    if (name == "hydrogen") return {name, makeHydrogen()};
    if (name == "shepp-logan") return {name, makeSheppLogan()};
    if (name == "engine") return {name, makeEngine(seed, noise)};
    if (name == "cloud") return {name, makeCloud(seed)};
    if (name == "slab") return {name, makeSlab()};
    if (name == "vessels") return {name, makeVessels(seed, noise)};
    if (name == "body") return {name, makeBody()};
    if (name == "fire") return makeFire(seed);
    if (name == "explosion") return makeExplosion(seed);

    std::string names;
    for (const std::string& known : analyticNames()) names += (names.empty() ? "" : ", ") + known;
    throw Error(ErrorCode::kUsage, gotExpected("`name`", "\"" + name + "\"", "one of " + names));
}

}  // namespace deltasplat
