// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/default_grid.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "deltasplat/error.h"
#include "ingest/grids/grid_metadata.h"
#include "lower_case.h"

namespace deltasplat {
namespace {

// As caches of smoke and fire simulations (Mantaflow, Houdini) call them.
constexpr std::array<std::string_view, 8> kHelpers{
    "flags", "shadow", "pressure", "obstacle", "obstacles", "collision", "divergence", "mask"};
constexpr std::array<std::string_view, 2> kHelperBegins{"phi", "fractions"};
// The surface of a liquid, which simulations of it keep for its own sake; their other names that
// begin so are of obstacles and inflows.
constexpr std::string_view kSurface = "phi";
constexpr std::array<std::string_view, 4> kHelperEnds{"_noise", "_inflow", "_in", "_old"};

enum Rank { kNone, kHelper, kHelperFog, kSurfaceOfLiquid, kOther, kFog };

Rank rankOf(const VdbFile& file, const VdbGrid& grid, VdbBytes& bytes) {
    if (grid.vector) return kNone;
    const std::string gridClass = gridClassOf(file.summary(grid, bytes).metadata);
    // Of types that nobody knows, those are numbers that say what they are numbers of.
    if (!grid.numeric && gridClass != kFogClass && gridClass != kLevelSetClass) return kNone;
    const bool fog = gridClass == kFogClass;
    const std::string name = grid.plainName();
    if (lowerCase(name) == kSurface) return kSurfaceOfLiquid;
    if (isHelperName(name)) return fog ? kHelperFog : kHelper;
    return fog ? kFog : kOther;
}

// Null if no grid has the name.
const VdbGrid* densityOf(const VdbFile& file) {
    const VdbGrid* found = nullptr;
    for (const VdbGrid& grid : file.grids()) {
        if (grid.plainName() != "density") continue;
        if (grid.numeric) return &grid;
        if (!found) found = &grid;
    }
    return found;
}

}  // namespace

bool isHelperName(const std::string& gridName) {
    const std::string name = lowerCase(gridName);
    return std::any_of(kHelpers.begin(), kHelpers.end(), [&](auto word) { return name == word; }) ||
           std::any_of(kHelperBegins.begin(), kHelperBegins.end(),
                       [&](auto word) { return name.starts_with(word); }) ||
           std::any_of(kHelperEnds.begin(), kHelperEnds.end(),
                       [&](auto word) { return name.ends_with(word); });
}

const VdbGrid* defaultGrid(const VdbFile& file) {
    if (const VdbGrid* const density = densityOf(file)) return density;
    const VdbGrid* best = nullptr;
    Rank bestRank = kNone;
    VdbBytes bytes = file.bytes();
    for (const VdbGrid& grid : file.grids()) {
        const Rank rank = rankOf(file, grid, bytes);
        if (rank <= bestRank) continue;
        best = &grid;
        bestRank = rank;
        if (rank == kFog) break;
    }
    return best;
}

const VdbGrid* toldDefaultGrid(const VdbFile& file) {
    try {
        return defaultGrid(file);
    } catch (const Error&) {
        return nullptr;
    }
}

}  // namespace deltasplat
