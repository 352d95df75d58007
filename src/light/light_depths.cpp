// SPDX-License-Identifier: Apache-2.0
#include "light/light_depths.h"

#include <algorithm>
#include <array>
#include <optional>

#include "deltasplat/threads.h"
#include "memory.h"
#include "optics/voxel_units.h"
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

// In a world unit, [classes].
std::vector<float> extinctionsOf(const ClassTable& classes) {
    constexpr double kMost = 1e30;
    std::vector<float> extinctions;
    for (const double depth : depthsOf(classes, 1))
        extinctions.push_back(float(std::min(depth, kMost)));
    return extinctions;
}

}  // namespace

LightDepths::LightDepths(const Volume& volume, const ClassTable& classes,
                         const std::vector<Light>& lights, int octaves)
    : blocks_(volume, classes) {
    const std::size_t voxels = 512 * blocks_.size();
    requireMemory("light on its way to voxels",
                  double(sizeof(std::uint16_t)) * double(voxels) * double(lights.size()));
    depths_ =
        UnclearedArray<std::uint16_t>(voxels * lights.size(), *std::pmr::get_default_resource());
    if (voxels == 0) return;
    // What a voxel of a wall leaves of the octave that is dimmed least. More of it would only make
    // its shadow wider, as it is shared between points of a plane.
    constexpr float kMost = 10;
    const float most = std::min(kMost * float(1 << octaves), 1000.0f);
    const std::vector<float> extinctions = extinctionsOf(classes);
    struct Piece {
        std::size_t light;
        std::int64_t first;
        std::int64_t last;
    };
    std::array<std::optional<LitBlocks::Along>, 3> blocksAlong;
    std::vector<LightSweep> sweeps;
    std::vector<Piece> pieces;
    for (std::size_t light = 0; light < lights.size(); ++light) {
        const LightWay way(volume.worldFromIndex, lights[light].direction);
        auto& along = blocksAlong[std::size_t(way.sliceAxis)];
        if (!along) along.emplace(blocks_.along(way.sliceAxis));
        sweeps.emplace_back(*along, way, volume.box.min[way.sliceAxis],
                            MetClasses{extinctions.data(), float(way.sliceWorld), most});
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
        sweeps[piece.light].run(piece.first, piece.last, &depths_[piece.light * voxels]);
    });
}

}  // namespace deltasplat
