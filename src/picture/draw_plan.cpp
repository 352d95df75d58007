// SPDX-License-Identifier: Apache-2.0
#include "picture/draw_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "view/base_plane.h"
#include "view/factorization.h"
#include "volume/placement.h"
#include "words/packed_deltas.h"

namespace deltasplat {
namespace {

// For smaller voxels on the screen, one sheet pixel per voxel takes a fraction of the time of two.
// Its footprint, which grows slowly (defaultSigma), blurs as little.
constexpr double kLeastPixelsOfTwoSheetPixels = 5;

// Coordinates of divided blocks, and of some voxels around them, must fit 32 bits.
bool canBeDivided(const IndexBox& box, int between) {
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    const glm::i64vec3 wide = glm::i64vec3(box.max) - glm::i64vec3(box.min) + std::int64_t{16};
    return std::max({wide.x, wide.y, wide.z}) * (between + 1) <= kMost;
}

void checkBetween(int between) {
    if (between >= 0 && between <= kMostBetween) return;
    throw Error(ErrorCode::kUsage, "`between`", std::to_string(between),
                "a whole number within 0.." + std::to_string(kMostBetween));
}

void checkMostJoined(int most) {
    if (most >= 1 && most <= kMostJoined && std::has_single_bit(unsigned(most))) return;
    throw Error(ErrorCode::kUsage, "`mostJoined`", std::to_string(most),
                "a power of two, at most " + std::to_string(kMostJoined));
}

[[noreturn]] void throwTooWide(const IndexBox& box, int between) {
    const glm::ivec3 dims = box.dims();
    throw Error(ErrorCode::kFailed, "`between` " + std::to_string(between),
                dimsText(dims) + " voxels",
                "at most 2^30 parts of them along each axis (`between` 0: undivided)");
}

[[noreturn]] void throwUndividable(const PreparedScene::Impl& scene, int between) {
    const bool isLit = scene.scene.optics.scattering.has_value();
    throw Error(
        ErrorCode::kUsage, "`between`",
        std::to_string(between) + " with " + (isLit ? "`scattering`" : "`parts` or `colorGrids`"),
        "0: lit fog and media of several grids are drawn by whole voxels");
}

bool dividesVoxels(const PreparedScene::Impl& scene) {
    return !scene.painter || scene.painter->dividesVoxels();
}

// Whether voxels of a view, or their parts, get a sheet pixel of their own by default.
bool hasOwnPixelIn(const Factorization& view, double parts, double resolution) {
    return hasOwnPixel(view.pixelsPerVoxel / parts * (1 + kSnap), resolution);
}

// Whether the screen needs values between voxels and no option decides.
bool wantsDivided(const PreparedScene::Impl& scene, const Factorization& view) {
    const SplatOptions& options = scene.options;
    if (view.resolution < 2 || options.resolution || options.footprintWidth) return false;
    // The transfer function as given, whatever the colours are by.
    const Optics& optics = scene.scene.optics;
    if (!optics.surface && optics.transferFunction.colorsJump()) return false;
    return !scene.scene.volume->empty() && !scene.isThin && dividesVoxels(scene);
}

// Whether there are few enough voxels to divide them by default.
bool areFewEnough(const PreparedScene::Impl& scene, const Factorization& view,
                  const Listener& listener) {
    const IndexBox& box = scene.scene.volume->box();
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

// Whether voxels are small enough on the screen to join pairs of slices. Joining moves voxels by a
// quarter voxel along u and v, less than a fifth of a pixel. In a picture that averages at least
// two voxels each way, no detail of one voxel's width visibly moves.
bool areSmall(const Camera& camera, const Volume& volume, const Factorization& view) {
    constexpr double kMostPixelsPerVoxel = 0.5;
    // From an eye, the nearest voxel covers most.
    constexpr double kMostOfNearest = 0.75;
    if (!(view.pixelsPerVoxel * (1 - kSnap) <= kMostPixelsPerVoxel)) return false;
    if (!view.eye) return true;
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis)
        longest = std::max(longest, glm::length(glm::dvec3(volume.worldFromIndex()[axis])));
    return mostPixelsOf(longest, camera, volume.box(), volume.worldFromIndex()) <= kMostOfNearest;
}

// Returns how joined slices move along lines of sight, by whole voxels.
JoinedSlants slantsOf(const Factorization& view, int joined, int within) {
    if (view.eye) {
        JoinedSlants slants;
        slants.slants[1] = view.frontToBack ? -*view.slopeStep : *view.slopeStep;
        return slants;
    }
    return joinedSlants(view.shiftPerSlice, joined, within);
}

// Whether more than two slices may be joined: if that many voxels cover only a few pixels, no voxel
// moves by more than a quarter pixel, and thin volumes keep their density.
bool mayJoin(const Factorization& view, const JoinedVoxels& joined) {
    constexpr double kMostPixelsOfAll = 4;
    constexpr double kMostPixelsMoved = 0.25;
    if (joined.slices * view.pixelsPerVoxel * (1 - kSnap) > kMostPixelsOfAll) return false;
    const JoinedSlants slants = slantsOf(view, joined.slices, joined.within);
    const double moved = slants.farthest * view.pixelsPerVoxel;
    return slants.keepsDensity && moved * (1 - kSnap) <= kMostPixelsMoved;
}

// Returns the candidates of more than two slices, the largest first. Neighbouring voxels may be
// joined while edges move by less than a fifth of a pixel. They need enough slices that little
// continues from one group to the next; more would take longer to join than they save.
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
        volume.activeCount() < leastVoxelsJoined || !areSmall(camera, volume, view))
        return {};
    // Numbering looks pays only in still larger volumes.
    constexpr std::uint64_t kTimesLarger = 32;
    const bool isWorthIt =
        scene.hasOneColor() || volume.activeCount() >= kTimesLarger * leastVoxelsJoined;
    const bool canBeMany = options.mostJoined > 2 && !view.eye && isWorthIt;
    std::vector<JoinedVoxels> may;
    if (canBeMany) may = manyJoined(view, options.mostJoined);
    if (canBeMany || scene.canPairSlices()) may.push_back({2, 1});
    return scene.joinJudge.firstUnseen(may, scene, view);
}

// Picture pixels per line of an eye's base plane, at most: about parallel projection's average.
constexpr double kPixelsOfScreen = 0.7;

// The slope in a region nearest to the camera's direction. A larger frame does not change it.
glm::dvec2 middleSlope(const Camera& camera, const Factorization& view) {
    const glm::dvec3 ahead = glm::inverse(view.worldFromStep) * camera.direction;
    if (camera.projection == Projection::kLatlong || !(ahead.x > 0))
        return 0.5 * (view.slopeMin + view.slopeMax);
    return glm::clamp(glm::dvec2(ahead.y, ahead.z) / ahead.x, view.slopeMin, view.slopeMax);
}

// Base plane pixels per unit slope: the sheet pixels of the farthest slice, which show all, or, if
// far fewer suffice, what the picture needs. That includes one per voxel (or sheet pixel, if fewer)
// of the middle slice, because averaging before compositing changes the result.
// @param view         of thin voxels
// @param box          of all slices
// @param sheetPixels  per thin voxel
double planeDensity(const Factorization& view, const IndexBox& box, double sheetPixels,
                    int within) {
    const double farthest = view.frontToBack ? box.max.x - view.eye->x : view.eye->x - box.min.x;
    const double nearest =
        std::max(0.0, view.frontToBack ? box.min.x - view.eye->x : view.eye->x - box.max.x);
    const double middle = 0.5 * (nearest + farthest);
    const double needed = std::max(kPixelsOfScreen * view.pixelsPerSlope,
                                   middle * std::min(sheetPixels, 1.0) / within);
    const double most = sheetPixels * std::max(farthest, 1.0);
    // Reading sheets without averaging saves that much time.
    constexpr double kWorthMore = 1.3;
    return most < kWorthMore * needed ? most : needed;
}

// Words of own looks are expensive, because they are lit. Otherwise a word costs more than its
// voxels if these are written to single pixels; with the large sheets of divided voxels, each voxel
// counts, too.
Encoding encodingOf(Method method, bool hasLooks, bool hasPixels, bool isDivided) {
    switch (method) {
        case Method::kAuto:
            if (hasLooks) return Encoding::kFewerWords;
            if (!hasPixels) return Encoding::kFewerWordsOrStamps;
            return isDivided ? Encoding::kFewerWordsOrVoxels : Encoding::kFewerWordsOrWrites;
        case Method::kDelta:
            return Encoding::kChanges;
        default:
            return Encoding::kWhole;
    }
}

// Whether slices have far more room than there are voxels. Parts of the picture (render_image.cpp)
// then need only the visible slices if these are whole, but all slices from the first on otherwise.
bool isMostlyEmpty(const Volume& volume, int sliceAxis) {
    constexpr double kLeast = 1 << 23;
    const glm::dvec3 size = glm::dvec3(volume.box().max) - glm::dvec3(volume.box().min) + 1.0;
    const double pixels = size[(sliceAxis + 1) % 3] * size[(sliceAxis + 2) % 3];
    return pixels > std::max(kLeast, double(volume.activeCount()));
}

// How finely all views of a picture are drawn.
struct Fineness {
    Subdivision parts;      // without slants and origin, which depend on the view
    double resolution = 1;  // sheet pixels per undivided voxel

    // Sheet pixels per part of a voxel.
    double thinResolution() const { return resolution / parts.within; }
};

Fineness finenessOf(const PreparedScene::Impl& scene, const Camera& camera,
                    const Factorization& view, bool keepsSlices, const Listener& listener) {
    const IndexBox& box = scene.scene.volume->box();
    const SplatOptions& options = scene.options;
    Fineness fineness;
    fineness.resolution = view.resolution;
    checkMostJoined(options.mostJoined);
    int between = 0;
    // Extra sheet pixels change nothing visible in thin volumes, unless the footprint is smoothed.
    bool hasOnePixelEach = scene.isThin && hasOwnPixelIn(view, 1, 1);
    if (options.between) {
        between = *options.between;
        checkBetween(between);
        if (between > 0 && !dividesVoxels(scene)) throwUndividable(scene, between);
        if (between > 0 && !canBeDivided(box, between)) throwTooWide(box, between);
    } else if (wantsDivided(scene, view)) {
        between = areFewEnough(scene, view, listener) ? 1 : 0;
        hasOnePixelEach =
            !options.sigma && view.pixelsPerVoxel * (1 + kSnap) < kLeastPixelsOfTwoSheetPixels;
    }
    if (!options.resolution && (between > 0 || hasOnePixelEach))
        fineness.resolution = between > 0 ? 2 : 1;
    fineness.parts.slices = between + 1;
    fineness.parts.within = between > 0 && std::fmod(fineness.resolution, 2) == 0 ? 2 : 1;
    if (keepsSlices) return fineness;
    const JoinedVoxels joined = joinedUnasked(scene, camera, view);
    fineness.parts.joined = joined.slices;
    fineness.parts.joinedWithin = joined.within;
    return fineness;
}

// The subdivision in a view.
Subdivision partsIn(const Factorization& view, Subdivision parts, const Volume& volume) {
    if (parts.joined > 1) parts.slants = slantsOf(view, parts.joined, parts.joinedWithin).slants;
    // Whole blocks are divided.
    if (parts.divides()) parts.origin = toSliceOrder(volume.box().min, view.sliceAxis) & ~7;
    return parts;
}

std::vector<Factorization> factorizeAll(const PreparedScene::Impl& scene, const Camera& camera,
                                        bool atSlopeSteps) {
    const Volume& volume = *scene.scene.volume;
    const std::optional<double> resolution = scene.options.resolution;
    if (camera.projection == Projection::kOrtho)
        return {factorize(camera, volume.worldFromIndex(), resolution)};
    std::vector<Factorization> views =
        factorizeRegions(camera, volume.box(), volume.worldFromIndex(), resolution, atSlopeSteps);
    if (!views.empty()) return views;
    throw Error(ErrorCode::kUsage, "camera", "no lines of sight", "what makeCamera returns");
}

// Width of a footprint: 1 if a voxel shows only in its own sheet pixel; empty: given by sigma.
std::optional<int> footprintWidth(const SplatOptions& options, const Factorization& view,
                                  const Fineness& fineness) {
    if (options.footprintWidth || options.sigma) return options.footprintWidth;
    if (!hasOwnPixelIn(view, fineness.parts.per().y, fineness.thinResolution())) return {};
    return 1;
}

// @param width  as footprintWidth
Footprint footprintOf(const SplatOptions& options, const Camera& camera, const Factorization& view,
                      const Fineness& fineness, std::optional<int> width) {
    const int within = fineness.parts.within;
    const double pixels = view.pixelsPerVoxel / within;
    const double sigma =
        options.sigma.value_or(defaultSigma(pixels, fineness.thinResolution()) / within);
    // The kernel is round in voxels, whatever their slices; seen along the middle line of sight.
    const glm::dvec2 shift = view.eye ? middleSlope(camera, view) : view.shiftPerSlice;
    return makeFootprint(sigma, {shift.y, shift.x}, int(fineness.thinResolution()), width, within);
}

Encoding encodingIn(const PreparedScene::Impl& scene, const Factorization& view, bool hasOwnPixel,
                    bool isDivided) {
    const SplatOptions& options = scene.options;
    const VoxelPainter* painter = scene.painter.get();
    const bool isWhole =
        painter ? painter->isEverywhereOther() || (view.eye && painter->dependsOnCamera())
                : options.method == Method::kAuto && options.tolerance.isExact() &&
                      isMostlyEmpty(*scene.scene.volume, view.sliceAxis);
    return isWhole ? Encoding::kWhole
                   : encodingOf(options.method, painter != nullptr, hasOwnPixel, isDivided);
}

// @param steps        of the view
// @param hasOwnPixel  whether each voxel is drawn to a sheet pixel
AxisPlan axisPlanOf(const PreparedScene::Impl& scene, const Factorization& view, double steps,
                    const Subdivision& parts, bool hasOwnPixel, DrawnFor drawnFor) {
    AxisPlan plan;
    AxisKey& key = plan.key;
    key.sliceAxis = view.sliceAxis;
    key.parts = parts;
    key.encoding = encodingIn(scene, view, hasOwnPixel, parts.divides());
    // From an eye, slab lengths must not depend on the content, because only the visible part may
    // be packed. Held voxels depend on all voxels in front of them.
    key.slabLength = view.eye ? SlabLength::kShortest : SlabLength::kByCounts;
    // Slices are walked from the front on; whole slices work both ways.
    plan.descending = !view.frontToBack && key.encoding != Encoding::kWhole;
    // Joined looks depend on the direction and, with several colours, on steps (except pairs).
    const bool isJoined = parts.joined > 1;
    const bool areSums = scene.hasOneColor() && parts.joinedWithin == 1;
    const bool isOfSteps = isJoined && !areSums && (parts.joined > 2 || !scene.canPairSlices());
    key.fromEnd = plan.descending || (isJoined && !view.frontToBack);
    if (isOfSteps) key.steps = steps;
    plan.seenThrough = view.frontToBack ? SeenThrough::kSecond : SeenThrough::kFirst;
    plan.steps = scene.isForOne || isOfSteps ? steps : 1;
    plan.mayBeParted = scene.isForOne && drawnFor == DrawnFor::kPixels;
    return plan;
}

// The part of the volume that a view from an eye may show.
// @param plan  complete except its axis' `seen`
SeenCone seenCone(const ViewPlan& plan, int within) {
    const Factorization& view = plan.view;
    SeenCone cone;
    cone.eye = *view.eye;
    cone.frontToBack = view.frontToBack;
    // In slopes of the volume's own slices and voxels.
    cone.reachPerSlice = plan.slopeSpacing * view.slopeLimit / plan.thin.slopeLimit;
    const double border = (planeBorder(plan.thin, plan.slopeSpacing) + 3) * cone.reachPerSlice;
    cone.slopeMin = view.slopeMin - border;
    cone.slopeMax = view.slopeMax + border;
    // Joined voxels lie up to one voxel away from their parts, and mixed ones next to them.
    constexpr double kBeside = 2;
    const double sheetPixels = plan.footprint.resolution;
    cone.reach = (plan.footprint.reach() + 2) / sheetPixels / within + kBeside;
    return cone;
}

ViewPlan viewPlanOf(const PreparedScene::Impl& scene, const Camera& camera,
                    const Factorization& view, const Fineness& fineness, DrawnFor drawnFor) {
    const Volume& volume = *scene.scene.volume;
    const Subdivision parts = partsIn(view, fineness.parts, volume);
    const std::optional<int> width = footprintWidth(scene.options, view, fineness);
    ViewPlan plan;
    plan.view = view;
    plan.thin = subdivided(view, parts);
    plan.steps = stepsOf(view, volume);
    plan.axis = axisPlanOf(scene, view, plan.steps, parts, width == 1, drawnFor);
    if (volume.empty()) return plan;
    plan.footprint = footprintOf(scene.options, camera, view, fineness, width);
    const IndexBox box = boxOfSlices(volume.box(), view.sliceAxis, parts);
    plan.sheet = layoutSheet(box, plan.footprint);
    if (!view.eye) return plan;
    plan.slopeSpacing = 1 / planeDensity(plan.thin, box, plan.footprint.resolution, parts.within);
    const bool packsSeen =
        scene.options.tolerance.isExact() && (scene.isForOne || parts.joined > 1);
    if (packsSeen) plan.axis.seen = seenCone(plan, parts.within);
    return plan;
}

}  // namespace

double stepsOf(const Factorization& view, const Volume& volume) {
    if (view.eye) return view.steps;
    // Rounding must not turn a straight view into an oblique one.
    constexpr double kSame = 1e-12;
    const double steps =
        view.sliceStepWorld / planeDistance(volume.worldFromIndex(), view.sliceAxis);
    return std::abs(steps - 1) < kSame ? 1 : steps;
}

glm::dvec3 indexOfEye(const glm::dvec3& eye, int sliceAxis) {
    const glm::ivec3 order = sliceOrder(sliceAxis);
    glm::dvec3 index;
    for (int i = 0; i < 3; ++i) index[order[i]] = eye[i];
    return index;
}

DrawPlan planPicture(const PreparedScene::Impl& scene, const Camera& camera, DrawnFor drawnFor,
                     const Listener& listener) {
    std::vector<Factorization> views = factorizeAll(scene, camera, false);
    Fineness fineness =
        finenessOf(scene, camera, views.front(), drawnFor == DrawnFor::kDepths, listener);
    if (fineness.parts.joined > 1 && views.front().eye) {
        // Slices are joined along lines of sight, by whole voxels. With several colours, steps must
        // be close to those that pairs are mixed for.
        constexpr double kMostRange = 1.3;
        std::vector<Factorization> atSlopes = factorizeAll(scene, camera, true);
        const bool areAlike =
            std::all_of(atSlopes.begin(), atSlopes.end(),
                        [](const Factorization& view) { return view.stepRange < kMostRange; });
        if (scene.hasOneColor() || areAlike) {
            views = std::move(atSlopes);
        } else {
            fineness.parts.joined = fineness.parts.joinedWithin = 1;
        }
    }
    DrawPlan plan;
    for (const Factorization& view : views)
        plan.views.push_back(viewPlanOf(scene, camera, view, fineness, drawnFor));
    return plan;
}

}  // namespace deltasplat
