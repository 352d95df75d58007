// SPDX-License-Identifier: Apache-2.0
#include "picture/join_judge.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "picture/draw_plan.h"
#include "view/factorization.h"
#include "volume/code_blocks.h"
#include "words/joined_tiles.h"

namespace deltasplat {
namespace {

using Lights = std::vector<glm::dvec4>;

// Returns the lines of sight from an eye at a voxel (x, y, z), along their most parallel axis.
SightLines linesFrom(const glm::dvec3& eye, const glm::ivec3& voxel,
                     const std::array<Lights, 3>& lights) {
    const glm::dvec3 along = glm::dvec3(voxel) - eye;
    const int axis = mostParallelAxis(along);
    const glm::ivec3 order = sliceOrder(axis);
    const glm::dvec3 steps(along[order[0]], along[order[1]], along[order[2]]);
    // From within a voxel, any direction will do.
    const double slices = steps.x == 0 ? 1 : steps.x;
    return {axis, slices > 0, glm::dvec2(-steps.y, -steps.z) / slices, lights[std::size_t(axis)]};
}

// The axis of the probe: from an eye always the same, whatever regions and storage.
int axisOf(const Factorization& view) {
    return view.eye ? 2 : view.sliceAxis;
}

// Returns the bits of all that lines of sight and the result depend on.
std::vector<std::uint64_t> keyOf(const Factorization& view, const Volume& volume,
                                 const std::vector<JoinedVoxels>& some) {
    std::vector<double> numbers;
    if (view.eye) {
        const glm::dvec3 eye = indexOfEye(*view.eye, view.sliceAxis);
        numbers = {eye.x, eye.y, eye.z};
    } else {
        numbers = {double(view.sliceAxis), double(view.frontToBack), view.shiftPerSlice.x,
                   view.shiftPerSlice.y, stepsOf(view, volume)};
    }
    for (const JoinedVoxels& one : some)
        numbers.insert(numbers.end(), {double(one.slices), double(one.within)});
    std::vector<std::uint64_t> bits;
    for (const double number : numbers) bits.push_back(std::bit_cast<std::uint64_t>(number));
    return bits;
}

bool isSeen(const JoinedChange& change) {
    constexpr double kMostGained = 1.0 / 64;
    constexpr double kMostRms = 1.0 / 32;
    for (int c = 0; c < 4; ++c)
        if (std::abs(change.gained[c]) > kMostGained) return true;
    return change.rms > kMostRms;
}

}  // namespace

JoinJudge::Axis::Axis(const PreparedScene::Impl& scene, int ofAxis)
    : sliceAxis(ofAxis),
      classes(scene.straightClasses(ofAxis)),
      probe(listBlocks(*scene.scene.volume->codes(), ofAxis, classes.classOfSlot()), ofAxis,
            classes.classOfSlot()) {}

JoinedVoxels JoinJudge::firstUnseen(const std::vector<JoinedVoxels>& some, const Axis& axis,
                                    const Volume& volume, const Factorization& view) {
    // Per axis. From an eye, steps count as straight; in cubic voxels some are 1.7 times as long.
    std::array<Lights, 3> lights;
    const auto lightsAlong = [&](int sliceAxis, double steps) {
        const double distance = planeDistance(volume.worldFromIndex(), sliceAxis);
        return lightsOf(axis.classes.atSteps(steps * distance / axis.classes.stepWorld));
    };
    JoinProbe::LinesThrough lines;
    if (view.eye) {
        for (int along = 0; along < 3; ++along) lights[std::size_t(along)] = lightsAlong(along, 1);
        lines = [&, eye = indexOfEye(*view.eye, view.sliceAxis)](const glm::ivec3& voxel) {
            return linesFrom(eye, voxel, lights);
        };
    } else {
        Lights& only = lights[std::size_t(view.sliceAxis)];
        only = lightsAlong(view.sliceAxis, stepsOf(view, volume));
        lines = [&](const glm::ivec3&) {
            return SightLines{view.sliceAxis, view.frontToBack, view.shiftPerSlice, only};
        };
    }
    for (const JoinedVoxels& joined : some) {
        const std::optional<JoinedChange> change = axis.probe.change(joined, lines);
        if (change && !isSeen(*change)) return joined;
    }
    return {};
}

JoinedVoxels JoinJudge::firstUnseen(const std::vector<JoinedVoxels>& some,
                                    const PreparedScene::Impl& scene,
                                    const Factorization& view) const {
    constexpr std::size_t kMostKnown = 256;
    if (some.empty()) return {};
    const Volume& volume = *scene.scene.volume;
    Key key = keyOf(view, volume, some);
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    JoinedVoxels unseen;
    isolated([&] {
        const int axis = axisOf(view);
        if (!axis_ || axis_->sliceAxis != axis) axis_ = nullptr;
        if (!axis_) axis_ = std::make_unique<const Axis>(scene, axis);
        unseen = firstUnseen(some, *axis_, volume, view);
    });
    // Packing lists blocks again anyway.
    if (scene.isForOne) axis_ = nullptr;
    if (known_.size() >= kMostKnown) known_.clear();
    known_.emplace(std::move(key), unseen);
    return unseen;
}

}  // namespace deltasplat
