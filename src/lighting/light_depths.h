// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <iterator>
#include <memory_resource>
#include <utility>
#include <vector>

#include "base/uncleared.h"
#include "deltasplat/optics/shading.h"
#include "lighting/lit_blocks.h"

namespace deltasplat {

/// Rows and columns of a plane that light is swept through, both ends inclusive.
struct PlaneBox {
    glm::i64vec2 least;
    glm::i64vec2 most;

    bool empty() const { return most.x < least.x || most.y < least.y; }
    double count() const {
        return (double(most.x) - double(least.x) + 1) * (double(most.y) - double(least.y) + 1);
    }
};

/// Returns the box of all boxes, at least one.
/// @tparam Reach  a PlaneBox: nodes that a block reads or writes
template <typename Reach>
PlaneBox boxOf(const std::vector<Reach>& all) {
    PlaneBox box = all.front();
    for (const PlaneBox& one : all) {
        box.least = glm::min(box.least, one.least);
        box.most = glm::max(box.most, one.most);
    }
    return box;
}

/// Cuts the boxes at every gap along an axis; returns nothing if there is no gap.
template <typename Reach>
std::vector<std::vector<Reach>> cutAtGaps(const std::vector<Reach>& all, int axis) {
    std::vector<std::pair<std::int64_t, std::int64_t>> ends;
    for (const PlaneBox& one : all) ends.emplace_back(one.least[axis], one.most[axis]);
    std::sort(ends.begin(), ends.end());
    std::vector<std::int64_t> begins{ends.front().first};
    std::int64_t last = ends.front().second;
    for (const auto& [first, lastOfOne] : ends) {
        if (first > last + 1) begins.push_back(first);
        last = std::max(last, lastOfOne);
    }
    if (begins.size() == 1) return {};
    std::vector<std::vector<Reach>> parts(begins.size());
    for (const Reach& one : all) {
        const auto after = std::upper_bound(begins.begin(), begins.end(), one.least[axis]);
        parts[std::size_t(after - begins.begin() - 1)].push_back(one);
    }
    return parts;
}

/// Splits boxes into parts that are separated by gaps. Each part keeps the boxes' order.
/// @param small  planes of at most this many nodes are not cut
template <typename Reach>
std::vector<std::vector<Reach>> partsAtGaps(std::vector<Reach> all, double small) {
    std::vector<std::vector<Reach>> parts;
    std::vector<std::vector<Reach>> left;
    if (!all.empty()) left.push_back(std::move(all));
    while (!left.empty()) {
        std::vector<Reach> some = std::move(left.back());
        left.pop_back();
        std::vector<std::vector<Reach>> cut;
        const bool isLarge = boxOf(some).count() > small;
        for (int axis = 0; axis < 2 && isLarge && cut.empty(); ++axis) cut = cutAtGaps(some, axis);
        if (cut.empty()) {
            parts.push_back(std::move(some));
        } else {
            std::move(cut.begin(), cut.end(), std::back_inserter(left));
        }
    }
    return parts;
}

/// Extinction on the ways from several lights to the voxels of a volume.
class LightDepths {
  public:
    /// Sweeps the volume from each light on. Multi-threaded.
    /// @param classes  must outlive this, like `volume`
    /// @param octaves  of Scattering: with more octaves, deeper extinctions still matter
    /// @throw Error(kFailed) if there is not enough memory
    LightDepths(const Volume& volume, const ClassTable& classes, const std::vector<Light>& lights,
                int octaves);

    const LitBlocks& blocks() const { return blocks_; }
    /// Returns the distances of voxels from a point light; empty for light from far away.
    const LitBlocks::Reach& reach(std::size_t light) const { return reaches_[light]; }
    /// Returns the roots of extinction in block `number`, `[x][y][z]`, in 1 / kDepthSteps.
    const std::uint16_t* of(std::size_t light, std::int64_t number) const {
        return &depths_[512 * (light * blocks_.size() + std::size_t(number))];
    }

  private:
    LitBlocks blocks_;
    std::vector<LitBlocks::Reach> reaches_;  // [lights]
    UnclearedArray<std::uint16_t> depths_;   // [light][block][512]
};

}  // namespace deltasplat
