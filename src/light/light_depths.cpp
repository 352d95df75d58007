// SPDX-License-Identifier: Apache-2.0
#include "light/light_depths.h"

#include <algorithm>
#include <array>

#include "deltasplat/threads.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {
namespace {

// Into how many strips a light's plane is cut: enough for every thread to have some work, but none
// so narrow that rows at its edges, which belong to two, take much of it.
std::int64_t stripCount(std::int64_t rows, std::size_t lights) {
    constexpr std::size_t kPiecesPerThread = 4;
    constexpr std::int64_t kLeastRows = 16;
    const auto threads = std::size_t(threadCount());
    const auto wanted = threads == 1 ? 1 : (kPiecesPerThread * threads + lights - 1) / lights;
    return std::clamp<std::int64_t>(std::int64_t(wanted), 1,
                                    std::max<std::int64_t>(1, rows / kLeastRows));
}

}  // namespace

LightDepths::LightDepths(const Volume& volume, const ClassTable& classes,
                         const std::vector<Light>& lights)
    : blocks_(volume, classes) {
    const std::size_t voxels = 512 * blocks_.all().size();
    requireMemory("light on its way to voxels",
                  double(sizeof(std::uint16_t)) * double(voxels) * double(lights.size()));
    depths_ =
        UnclearedArray<std::uint16_t>(voxels * lights.size(), *std::pmr::get_default_resource());
    if (voxels == 0) return;
    struct Piece {
        std::size_t light;
        std::int64_t first;
        std::int64_t last;
    };
    std::vector<LightSweep> sweeps;
    std::array<UnclearedArray<std::uint16_t>, 3> classesAlong;
    std::vector<Piece> pieces;
    for (std::size_t light = 0; light < lights.size(); ++light) {
        sweeps.emplace_back(blocks_, classes, volume.worldFromIndex, lights[light].direction);
        auto& along = classesAlong[std::size_t(sweeps.back().sliceAxis())];
        if (along.empty()) along = blocks_.classesAlong(sweeps.back().sliceAxis());
        const std::int64_t rows = sweeps.back().rows();
        const std::int64_t strips = stripCount(rows, lights.size());
        const auto edge = [&](std::int64_t n) { return rows * n / strips; };
        for (std::int64_t i = 0; i < strips; ++i) pieces.push_back({light, edge(i), edge(i + 1)});
    }
    // Each thread has a piece in hand.
    double largest = 0;
    for (const Piece& piece : pieces)
        largest = std::max(largest, sweeps[piece.light].bytes(piece.first, piece.last));
    requireMemory("a plane that light is swept through",
                  largest * std::min<double>(threadCount(), double(pieces.size())));
    parallelFor(pieces.size(), [&](std::size_t i) {
        const Piece& piece = pieces[i];
        const LightSweep& sweep = sweeps[piece.light];
        sweep.run(piece.first, piece.last, &classesAlong[std::size_t(sweep.sliceAxis())][0],
                  &depths_[piece.light * voxels]);
    });
}

}  // namespace deltasplat
