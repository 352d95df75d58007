// SPDX-License-Identifier: Apache-2.0
#include "rays/follow_rays.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "deltasplat/threads.h"
#include "memory.h"
#include "parallel.h"
#include "shared_progress.h"

namespace deltasplat {
namespace {

// Rows of the base plane that are done at a time: so many that little is read twice, so few that
// what they read stays in the second-level cache.
constexpr int kBandRows = 64;

}  // namespace

RayPlanes followRays(const RayInput& input, const Listener& listener) {
    const IndexBox& volume = input.volume.box;
    const PlaneBox box = reachOf(input.plane, input.layout, volume.min.x, volume.dims().x);
    const int bands = (box.size().y + kBandRows - 1) / kBandRows;
    const int workers = std::min(threadCount(), bands);
    const double row = double(sizeof(float)) * box.size().x;
    requireMemory("base plane", (input.marksPlaces ? 4 : 2) * row * box.size().y +
                                    workers * (RayBand::bytes(input, kBandRows) + kBandRows * row));

    const bool sum = input.rule == RayRule::kSum;
    RayPlanes planes{RayPlane(box, sum ? 0 : -std::numeric_limits<float>::infinity()), {}};
    if (input.marksPlaces) planes.places.emplace(box);
    std::atomic<int> next = 0;
    std::atomic<int> done = 0;
    SharedProgress progress(listener);
    parallelFor(std::size_t(workers), [&](std::size_t) {
        RayBand band(input, kBandRows);
        for (int i = next++; i < bands; i = next++) {
            const int first = box.min.y + i * kBandRows;
            band.run(first, std::min(first + kBandRows, box.max.y), planes);
            progress.report(0.1 + 0.8 * ++done / bands);
        }
    });
    return planes;
}

}  // namespace deltasplat
