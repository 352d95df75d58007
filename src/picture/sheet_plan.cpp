// SPDX-License-Identifier: Apache-2.0
#include "picture/sheet_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "view/factorization.h"
#include "view/joined_slants.h"

namespace deltasplat {
namespace {

// Where voxels cover fewer pixels of the screen, one sheet pixel for each and its footprint, which
// grows slowly (defaultSigma), take a fraction of the time of two and theirs, and blur as little.
constexpr double kLeastPixelsOfTwoSheetPixels = 5;

// What whole blocks are divided into is counted with 32 bits, and some more voxels around it.
bool canBeDivided(const IndexBox& box, int between) {
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    const glm::i64vec3 wide = glm::i64vec3(box.max) - glm::i64vec3(box.min) + std::int64_t{16};
    return std::max({wide.x, wide.y, wide.z}) * (between + 1) <= kMost;
}

void checkBetween(int between) {
    if (between >= 0 && between <= kMostBetween) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("`between`", std::to_string(between),
                            "a whole number within 0.." + std::to_string(kMostBetween)));
}

void checkMostJoined(int most) {
    if (most >= 1 && most <= kMostJoined && std::has_single_bit(unsigned(most))) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("`mostJoined`", std::to_string(most),
                            "a power of two, at most " + std::to_string(kMostJoined)));
}

[[noreturn]] void throwTooWide(const IndexBox& box, int between) {
    const glm::ivec3 dims = box.dims();
    throw Error(ErrorCode::kFailed,
                gotExpected("`between` " + std::to_string(between), dimsText(dims) + " voxels",
                            "at most 2^30 parts of them along each axis (`between` 0: undivided)"));
}

bool dividesVoxels(const PreparedScene::Impl& scene) {
    return !scene.painter || scene.painter->dividesVoxels();
}

// Whether voxels of a view, or what they are divided into, have a sheet pixel of their own if
// nothing else is asked for.
bool hasOwnPixelIn(const Factorization& view, double parts, double resolution) {
    return hasOwnPixel(view.pixelsPerVoxel / parts * (1 + kSnap), resolution);
}

// Whether the screen asks for values between voxels, and nobody says otherwise.
bool wantsDivided(const PreparedScene::Impl& scene, const Factorization& view) {
    const SplatOptions& options = scene.options;
    if (view.resolution < 2 || options.resolution || options.footprintWidth) return false;
    // Of the transfer function that was asked for, whatever colours are by.
    const Optics& optics = scene.scene.optics;
    if (!optics.surface && optics.transferFunction.colorsJump()) return false;
    return !scene.scene.volume->empty() && !scene.isThin && dividesVoxels(scene);
}

// Whether voxels are few enough to be divided unasked.
bool areFewEnough(const PreparedScene::Impl& scene, const Factorization& view,
                  const Listener& listener) {
    const IndexBox& box = scene.scene.volume->box;
    if (!canBeDivided(box, 1)) {
        listener.warn("the volume is too wide for voxels to be divided: drawn as they are");
        return false;
    }
    const glm::dvec3 places = (box.max >> 3) - (box.min >> 3) + 1;
    if (places.x * places.y * places.z <= double(kMostDivided)) return true;
    const std::size_t blocks = scene.blocksSeen(view.sliceAxis);
    if (blocks <= kMostDivided) return true;
    listener.warn("voxels are too many to be divided (" + std::to_string(blocks) +
                  " blocks of 8x8x8 can be seen, at most " + std::to_string(kMostDivided) +
                  " are): drawn as they are; `between` 1 divides them");
    return false;
}

// Whether voxels are so small on the screen that slices may be joined two and two: moved by a
// quarter of a voxel along u and along v, which is less than a fifth of a pixel, in a picture that
// averages two voxels each way at least, nothing of one voxel's width is seen to move.
bool areSmall(const Camera& camera, const Volume& volume, const Factorization& view) {
    constexpr double kMostPixelsPerVoxel = 0.5;
    // From an eye the nearest voxel covers more than others.
    constexpr double kMostOfNearest = 0.75;
    if (!(view.pixelsPerVoxel * (1 - kSnap) <= kMostPixelsPerVoxel)) return false;
    if (!view.eye) return true;
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis)
        longest = std::max(longest, glm::length(glm::dvec3(volume.worldFromIndex[axis])));
    return mostPixelsOf(longest, camera, volume.box, volume.worldFromIndex) <= kMostOfNearest;
}

// Returns how so many slices are moved along lines of sight, by whole voxels.
JoinedSlants slantsOf(const Factorization& view, int joined, int within) {
    if (view.eye) {
        JoinedSlants slants;
        slants.slants[1] = view.frontToBack ? -*view.slopeStep : *view.slopeStep;
        return slants;
    }
    return joinedSlants(view.shiftPerSlice, joined, within);
}

// Whether so many slices may be joined, more than two: as far as so many voxels side by side cover
// a few pixels, none of them is moved by more than a quarter of one, and what is thin stays as
// dense.
bool mayJoin(const Factorization& view, const JoinedVoxels& joined) {
    constexpr double kMostPixelsOfAll = 4;
    constexpr double kMostPixelsMoved = 0.25;
    if (joined.slices * view.pixelsPerVoxel * (1 - kSnap) > kMostPixelsOfAll) return false;
    const JoinedSlants slants = slantsOf(view, joined.slices, joined.within);
    const double moved = slants.farthest * view.pixelsPerVoxel;
    return slants.keepsDensity && moved * (1 - kSnap) <= kMostPixelsMoved;
}

// Returns what may be joined of more than two slices, the most first. Voxels beside each other
// become one as far as an edge, which may move from one of them to another, moves by less than a
// fifth of a pixel; and of so many slices that little goes on from some to the next, but no more,
// which would take longer to join than they save.
std::vector<JoinedVoxels> manyJoined(const Factorization& view, int most) {
    constexpr double kMostPixelsBeside = 0.1875;
    constexpr int kDepth = 8;
    std::vector<JoinedVoxels> may;
    for (int within = kMostJoinedWithin; within > 1; within /= 2) {
        if ((within - 1) * view.pixelsPerVoxel * (1 - kSnap) > kMostPixelsBeside) continue;
        for (int slices = kDepth * within; slices <= most; slices *= 2) {
            if (!mayJoin(view, {slices, within})) continue;
            may.push_back({slices, within});
            break;
        }
    }
    for (int slices = most; slices > 2; slices /= 2)
        if (mayJoin(view, {slices, 1})) may.push_back({slices, 1});
    return may;
}

JoinedVoxels joinedUnasked(const PreparedScene::Impl& scene, const Camera& camera,
                           const Factorization& view) {
    const SplatOptions& options = scene.options;
    const Volume& volume = *scene.scene.volume;
    if (options.mostJoined < 2 || options.resolution || options.between || options.sigma ||
        options.footprintWidth || !scene.canJoinSlices() ||
        volume.activeCount < leastVoxelsJoined || !areSmall(camera, volume, view))
        return {};
    // Numbering looks takes what it saves, but of volumes that are larger still.
    constexpr std::uint64_t kTimesLarger = 32;
    const bool isWorthIt =
        scene.hasOneColor() || volume.activeCount >= kTimesLarger * leastVoxelsJoined;
    const bool canBeMany = options.mostJoined > 2 && !view.eye && isWorthIt;
    std::vector<JoinedVoxels> may;
    if (canBeMany) may = manyJoined(view, options.mostJoined);
    if (canBeMany || scene.canPairSlices()) may.push_back({2, 1});
    return scene.joinJudge.firstUnseen(may, scene, view);
}

}  // namespace

SheetPlan::SheetPlan(const PreparedScene::Impl& scene, const Camera& camera,
                     const Factorization& view, bool keepsSlices, const Listener& listener)
    : asksForSigma_(scene.options.sigma.has_value()),
      footprintWidth_(scene.options.footprintWidth),
      firstVoxel_(scene.scene.volume->box.min),
      resolution_(view.resolution) {
    const IndexBox& box = scene.scene.volume->box;
    const SplatOptions& options = scene.options;
    checkMostJoined(options.mostJoined);
    int between = 0;
    // What is thin shows nothing else with more sheet pixels, while it is not smoothed.
    bool hasOnePixelEach = scene.isThin && hasOwnPixelIn(view, 1, 1);
    if (options.between) {
        between = *options.between;
        checkBetween(between);
        if (between > 0 && !dividesVoxels(scene)) {
            const bool isLit = scene.scene.optics.scattering.has_value();
            throw Error(ErrorCode::kUsage,
                        gotExpected("`between`",
                                    std::to_string(between) + " with " +
                                        (isLit ? "`scattering`" : "`parts` or `colorGrids`"),
                                    "0: lit fog and media of several grids are drawn by whole "
                                    "voxels"));
        }
        if (between > 0 && !canBeDivided(box, between)) throwTooWide(box, between);
    } else if (wantsDivided(scene, view)) {
        between = areFewEnough(scene, view, listener) ? 1 : 0;
        hasOnePixelEach =
            !asksForSigma_ && view.pixelsPerVoxel * (1 + kSnap) < kLeastPixelsOfTwoSheetPixels;
    }
    if (!options.resolution && (between > 0 || hasOnePixelEach)) resolution_ = between > 0 ? 2 : 1;
    parts_.slices = between + 1;
    parts_.within = between > 0 && std::fmod(resolution_, 2) == 0 ? 2 : 1;
    if (keepsSlices) return;
    const JoinedVoxels joined = joinedUnasked(scene, camera, view);
    parts_.joined = joined.slices;
    parts_.joinedWithin = joined.within;
}

std::optional<int> SheetPlan::footprintWidth(const Factorization& view) const {
    if (footprintWidth_ || asksForSigma_) return footprintWidth_;
    if (!hasOwnPixelIn(view, parts_.per().y, resolution())) return {};
    return 1;
}

Subdivision SheetPlan::partsIn(const Factorization& view) const {
    Subdivision parts = parts_;
    if (parts.joined > 1) parts.slants = slantsOf(view, parts.joined, parts.joinedWithin).slants;
    // Whole blocks are divided.
    if (parts.divides()) parts.origin = toSliceOrder(firstVoxel_, view.sliceAxis) & ~7;
    return parts;
}

}  // namespace deltasplat
