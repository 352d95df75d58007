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
constexpr std::array<std::string_view, 4> kHelperEnds{"_noise", "_inflow", "_in", "_old"};

bool isFog(const VdbFile& file, const VdbGrid& grid) {
    try {
        return gridClassOf(file.metadata(grid)) == kFogClass;
    } catch (const Error&) {
        // What is wrong with a grid that may not even be wanted is said when it is read.
        return false;
    }
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
    enum Rank { kNone, kHelper, kHelperFog, kOther, kFog, kDensity };
    const VdbGrid* best = nullptr;
    Rank bestRank = kNone;
    for (const VdbGrid& grid : file.grids()) {
        if (!grid.isScalar()) continue;
        if (grid.plainName() == "density") return &grid;
        const bool fog = isFog(file, grid);
        const Rank rank =
            isHelperName(grid.plainName()) ? (fog ? kHelperFog : kHelper) : (fog ? kFog : kOther);
        if (rank <= bestRank) continue;
        best = &grid;
        bestRank = rank;
    }
    return best;
}

}  // namespace deltasplat
