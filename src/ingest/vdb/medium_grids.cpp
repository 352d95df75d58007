// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>

#include "deltasplat/ingest/list_grids.h"
#include "lower_case.h"

namespace deltasplat {
namespace {

// As caches of Houdini, Mantaflow, EmberGen and others call them, those first that say most of
// where it burns.
constexpr std::array<std::string_view, 6> kFires{"flame", "flames", "fire",
                                                 "burn",  "heat",   "temperature"};
constexpr std::array<std::string_view, 4> kColors{"cd", "color", "colour", "albedo"};

}  // namespace

bool isColorType(const std::string& type) {
    return type == "vec3s" || type == "vec3d";
}

MediumGrids mediumGrids(const std::vector<VolumeEntry>& entries) {
    const auto firstOf = [&](const auto& names, const auto& suits) -> std::string {
        for (const std::string_view name : names) {
            for (const VolumeEntry& entry : entries)
                if (suits(entry) && lowerCase(entry.name) == name) return entry.name;
        }
        return "";
    };
    MediumGrids grids;
    // One that cannot be read is the one that is meant all the same, and reading it says why.
    grids.emission = firstOf(
        kFires, [](const VolumeEntry& entry) { return entry.scalar || !entry.obstacle.empty(); });
    grids.color =
        firstOf(kColors, [](const VolumeEntry& entry) { return isColorType(entry.type); });
    grids.otherEmission = firstOf(kFires, [&](const VolumeEntry& entry) {
        const bool isEmpty = entry.box && entry.box->empty();
        return entry.scalar && !isEmpty && entry.name != grids.emission;
    });
    return grids;
}

}  // namespace deltasplat
