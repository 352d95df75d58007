// SPDX-License-Identifier: Apache-2.0
#include "join_judge.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "delta/code_blocks.h"
#include "delta/slab_facts.h"
#include "optics/joined_classes.h"
#include "parallel.h"
#include "picture_view.h"
#include "prepared_axis.h"

namespace deltasplat {
namespace {

// Returns the lines of sight from an eye at a voxel (x, y, z), along the axis that they belong to.
SightLines linesFrom(const glm::dvec3& eye, const glm::ivec3& voxel) {
    const glm::dvec3 along = glm::dvec3(voxel) - eye;
    const auto stepsAlong = [&](int axis) {
        const glm::ivec3 order = sliceOrder(axis);
        return glm::dvec3(along[order[0]], along[order[1]], along[order[2]]);
    };
    int axis = 2;
    for (; axis > 0; --axis) {
        const glm::dvec3 steps = stepsAlong(axis);
        if (belongs({std::abs(steps.x), steps.y, steps.z}, sliceOrder(axis))) break;
    }
    const glm::dvec3 steps = stepsAlong(axis);
    // From within a voxel it is seen any way.
    const double slices = steps.x == 0 ? 1 : steps.x;
    return {axis, slices > 0, glm::dvec2(-steps.y, -steps.z) / slices};
}

// Returns what lines of sight depend on, as bits.
std::vector<std::uint64_t> bitsOfLines(const Factorization& view, const Volume& volume) {
    std::vector<double> numbers{double(view.sliceAxis), double(view.frontToBack),
                                stepsOf(view, volume)};
    if (view.eye) {
        numbers.insert(numbers.end(), {view.eye->x, view.eye->y, view.eye->z});
    } else {
        numbers.insert(numbers.end(), {view.shiftPerSlice.x, view.shiftPerSlice.y});
    }
    std::vector<std::uint64_t> bits;
    for (const double number : numbers) bits.push_back(std::bit_cast<std::uint64_t>(number));
    return bits;
}

// Whether a change may be seen. What looks like one on average may be chance, as long as it is
// small.
bool isSeen(const JoinedChange& change) {
    constexpr double kHardlyGained = 1.0 / 256;
    constexpr double kMostGained = 1.0 / 64;
    constexpr double kMostRms = 1.0 / 16;
    const double most = std::min(kMostGained, kHardlyGained + 2 * change.gainedError);
    return std::abs(change.gained) > most || change.rms > kMostRms;
}

}  // namespace

JoinJudge::Axis::Axis(const PreparedScene::Impl& scene, int ofAxis)
    : sliceAxis(ofAxis),
      classes(classify(*scene.scene.volume, scene.optics,
                       planeDistance(scene.scene.volume->worldFromIndex, ofAxis))),
      probe(listBlocks(*scene.scene.volume->codes, ofAxis, classes.classOfSlot()), ofAxis,
            classes.classOfSlot()) {}

bool JoinJudge::mayBeSeen(const JoinedVoxels& joined, const PreparedScene::Impl& scene,
                          const Factorization& view) const {
    constexpr std::size_t kMostKnown = 256;
    const Volume& volume = *scene.scene.volume;
    // Where only some slices are there, it was found out when all were.
    const SlotBlocks* const along = volume.codes->blocksAlong(view.sliceAxis);
    if (along && along->facts()) return joined.slices > along->facts()->joined;
    Key key = bitsOfLines(view, volume);
    key.insert(key.end(), {std::uint64_t(joined.slices), std::uint64_t(joined.within)});
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    std::optional<JoinedChange> change;
    isolated([&] {
        if (!axis_ || axis_->sliceAxis != view.sliceAxis) axis_ = nullptr;
        if (!axis_) axis_ = std::make_unique<const Axis>(scene, view.sliceAxis);
        std::optional<glm::dvec3> eye;
        if (view.eye) eye = indexOfEye(view);
        const auto lines = [&](const glm::ivec3& voxel) {
            if (eye) return linesFrom(*eye, voxel);
            return SightLines{view.sliceAxis, view.frontToBack, view.shiftPerSlice};
        };
        const ClassTable seen = axis_->classes.atSteps(stepsOf(view, volume));
        change = axis_->probe.change(joined, lines, lightsOf(seen));
    });
    const bool mayBe = !change || isSeen(*change);
    // Blocks will be listed again, of what is seen, when they are packed.
    if (scene.isForOne && !mayBe) axis_ = nullptr;
    if (known_.size() >= kMostKnown) known_.clear();
    known_.emplace(std::move(key), mayBe);
    return mayBe;
}

}  // namespace deltasplat
