// SPDX-License-Identifier: Apache-2.0
#include "picture/prepared_axis.h"
#include "volume/placement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "base/default_floats.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "deltasplat/error.h"
#include "lighting/part_looks.h"
#include "optics/class_numbers.h"
#include "optics/hold_rule.h"
#include "picture/picture_view.h"
#include "picture/sheet_plan.h"
#include "volume/box_voxels.h"
#include "volume/code_blocks.h"
#include "volume/seen_cone.h"
#include "words/joined_classes.h"
#include "words/value_mixer.h"

namespace deltasplat {
namespace {

// A word costs much where voxels have looks of their own, for it is lit, and more than its voxels
// do where these are written to pixels of their own, but they do cost: those of divided ones, whose
// sheets are large, one by one.
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

// Optics as the volume has them, for levels to be seen by. Where a painter knows all colours,
// classes tell opacities apart, nothing else.
Optics opticsOf(const Volume& volume, Optics optics, const VoxelPainter* painter) {
    if (!optics.range) optics.range = defaultRange(volume);
    if (painter && !painter->needsColors()) optics.transferFunction.colors = {{0, glm::dvec3(1)}};
    return optics;
}

Scene requireVolume(Scene scene) {
    if (scene.volume) return scene;
    throw Error(ErrorCode::kUsage, gotExpected("scene", "no volume", "one"));
}

// Whether what is shown is thin. Of thin voxels, two sheet pixels show little that one does not,
// and values mixed little more (docs/decisions.md). Not what is seen decides, lest a voxel or an
// angle change the picture of all others.
bool showsThin(const Volume& volume, const Optics& optics) {
    constexpr double kMost = 0.25;
    return !optics.surface && largestAlpha(volume, optics) <= kMost;
}

// Whether steps that are so many times shorter may be too short for some class to be seen. What is
// seen must not depend on which picture of a scene comes first.
bool shorterMayShowLess(const ClassTable& classes, double times) {
    // The share of the largest opacity that is sure to be seen (ClassTable), and twice that, for
    // rounding. A class shrinks by `times` at most, and the largest does not grow.
    const double sure = 2 * 0x1p-40 * ClassTable::kMax * times;
    // On one plane there is nothing below 2^-20 of the largest.
    if (classes.planes.size() == 1 && sure < 0x1p-20 * ClassTable::kMax) return false;
    for (std::size_t number = 1; number < classes.size(); ++number)
        if (classes.unitsOf(Slot(number)).a < sure) return true;
    return false;
}

// Whether slices have far more room than there are voxels. Then few of their pixels are made at a
// time (plane_parts.h): of slices that are made anew those that show something there, of others all
// from the first one on.
bool isMostlyEmpty(const Volume& volume, int sliceAxis) {
    constexpr double kLeast = 1 << 23;
    const glm::dvec3 size = glm::dvec3(volume.box.max) - glm::dvec3(volume.box.min) + 1.0;
    const double pixels = size[(sliceAxis + 1) % 3] * size[(sliceAxis + 2) % 3];
    return pixels > std::max(kLeast, double(volume.activeCount));
}

// Returns how opaque a voxel of each class is along its shortest side: what is mixed must depend on
// no camera.
std::vector<float> opacitiesOf(const Volume& volume, const ClassTable& classes) {
    const double side = smallestSize(volume) / classes.unitDistanceWorld * classes.extinctionScale;
    std::vector<float> opacities;
    for (const Look& look : classes.looks) {
        const double depth = look.extinction > 0 ? look.extinction * side : 0;
        opacities.push_back(float(-portable::expm1(-depth)));
    }
    return opacities;
}

// Says so where looks of joined slices had to be rounded so far that it may be seen.
void warnOfRounding(const SliceJoiner& joiner, const Listener& listener) {
    constexpr int kFewBits = 4;
    if (!joiner.looks()) return;
    const int bits = joiner.looks()->run().bits;
    if (bits > kFewBits) return;
    listener.warn("voxels have so many looks that joined slices have colours of " +
                  std::to_string(1 << bits) + " levels a channel; `between` 0 draws every voxel");
}

// What an axis is to be.
struct AxisRequest {
    int sliceAxis;
    bool descending;
    Subdivision parts;
    SeenThrough seenThrough;  // of joined slices, which of two is behind
    double steps;
    Encoding encoding = Encoding::kChanges;
    SlabLength slabLength = SlabLength::kByCounts;
    std::optional<SeenCone> seen = {};     // empty: all is
    const PreparedAxis* before = nullptr;  // the same axis as other optics have it; null: none
    bool mayBeParted = false;
};

// Returns the words that other optics have, if these tell the same codes apart, or null; classes
// then get the others' numbers. Where nothing is held and nothing has looks of its own, all that
// words know of optics is the classes of codes; and of divided voxels how opaque these are, which
// is left to the caller.
std::shared_ptr<const PackedDeltas> sharedWords(const AxisRequest& request,
                                                const PreparedScene::Impl& scene,
                                                ClassTable& classes) {
    const PreparedAxis* before = request.before;
    const bool areOfClasses = !scene.painter && scene.options.tolerance.isExact();
    if (!before || !areOfClasses || before->packer || before->seen != request.seen) return {};
    return takeNumbers(before->classes(), classes) ? before->words : nullptr;
}

std::shared_ptr<const PreparedAxis> prepare(const PreparedScene::Impl& scene,
                                            const AxisRequest& request, const Listener& listener) {
    const Subdivision& parts = request.parts;
    const PreparedAxis* const before = request.before;
    const Volume& volume = *scene.scene.volume;
    const Tolerance& tolerance = scene.options.tolerance;
    std::optional<ValueMixer> mixer;
    const VoxelPainter* painter = scene.painter.get();
    if (parts.divides() || (painter && painter->choosesClasses()))
        mixer.emplace(volume, parts, scene.options.keepsLone);
    const Volume& levels = mixer ? mixer->levels() : volume;
    // What is held does not depend on the camera: straight ways decide.
    const double straight = planeDistance(volume.worldFromIndex, request.sliceAxis) / parts.slices;
    double first = tolerance.isExact() ? request.steps : 1;
    ClassTable classes = classify(levels, scene.optics, straight * first);
    if (first != 1 && shorterMayShowLess(classes, first)) {
        first = 1;
        classes = classify(levels, scene.optics, straight);
    }
    listener.report(0.05);
    // Small footprints of two digits are never stamped.
    Encoding encoding = request.encoding;
    if (encoding == Encoding::kFewerWordsOrStamps && !classes.oneDigit())
        encoding = Encoding::kFewerWords;
    std::shared_ptr<const PackedDeltas> words = sharedWords(request, scene, classes);
    const JoinedRun run{parts.joined, parts.joinedWithin, request.seenThrough,
                        request.steps / first};
    std::optional<SliceJoiner> joiner;
    if (parts.joined > 1) {
        joiner.emplace(joinerOf(classes, run));
        if (words && joiner != before->joiner) words = nullptr;
    }
    std::vector<float> opacities;
    if (parts.divides()) {
        opacities = opacitiesOf(volume, classes);
        if (words && opacities != opacitiesOf(volume, before->classes())) words = nullptr;
    }
    PackOptions pack{request.sliceAxis, encoding, classes.classOfSlot(),
                     holdRule(levels, classes, tolerance), mixer ? &*mixer : nullptr};
    pack.descending = request.descending;
    if (joiner) pack.joiner = &*joiner;
    pack.slants = parts.joinedSlants();
    pack.joinedWithin = parts.joinedWithin;
    pack.seen = request.seen;
    pack.slabLength = request.slabLength;
    pack.opacities = opacities;
    const bool isLit = painter && painter->dependsOnCamera();
    std::unique_ptr<const LookLight> light;
    if (painter) {
        classes.oneColor = false;
        pack.painter = painter;
        if (!isLit) light = painter->lightOf(classes, nullptr);
        if (painter->mayHold()) {
            pack.looksHold = looksHoldRule(light->units(), tolerance);
        } else {
            pack.holds = {};
        }
    }
    std::shared_ptr<DeltaPacker> packer;
    if (!words) {
        packer = std::make_shared<DeltaPacker>(volume, pack);
        const bool inParts =
            request.mayBeParted && packer->canBeParted() && packer->mostBytes() > scene.wordBytes;
        words = std::make_shared<const PackedDeltas>(inParts ? packer->packOrPlan(scene.wordBytes)
                                                             : packer->packAll());
        joiner = packer->joiner();
        if (packer->parts().empty()) packer = nullptr;
    }
    if (joiner) {
        warnOfRounding(*joiner, listener);
        classes = joinedClasses(classes, *joiner, run);
    } else if (request.steps != first) {
        classes = classes.atSteps(request.steps);
        if (light) light = painter->lightOf(classes, nullptr);
    }
    StepColors colors = isLit ? StepColors(std::move(classes))
                              : StepColors(*words, std::move(classes), std::move(light));
    return std::make_shared<const PreparedAxis>(
        PreparedAxis{request.sliceAxis, parts, std::move(words), request.steps, std::move(colors),
                     std::move(packer), std::move(joiner), request.seen});
}

std::size_t countBlocks(const PreparedScene::Impl& scene, int sliceAxis) {
    const Volume& volume = *scene.scene.volume;
    const ClassTable classes =
        classify(volume, scene.optics, planeDistance(volume.worldFromIndex, sliceAxis));
    return listBlocks(*volume.codes, sliceAxis, classes.classOfSlot()).size();
}

}  // namespace

std::uint64_t PreparedAxis::stamps(Method method) const {
    if (method == Method::kTraditional) return voxelsOf(deltas().box);
    std::uint64_t stamps = 0;
    for (const PlannedSlab& slab : deltas().slabs) stamps += slab.stamps();
    return stamps;
}

std::shared_ptr<const PreparedAxis> PreparedAxis::withWords(const SlabRange& part) const {
    auto some = std::make_shared<const PackedDeltas>(packer->pack(part));
    // What is painted is not packed in parts.
    StepColors ofSome(*some, classes(), nullptr);
    return std::make_shared<const PreparedAxis>(
        PreparedAxis{sliceAxis, parts, std::move(some), steps, std::move(ofSome)});
}

PreparedScene::Impl::Impl(Scene ofScene, SplatOptions withOptions, bool forOne, Axes before)
    : given(ofScene.volume),
      scene(requireVolume(std::move(ofScene))),
      painter(makePainter(*scene.volume, scene.optics)),
      optics(opticsOf(*scene.volume, scene.optics, painter.get())),
      options(withOptions),
      isThin(showsThin(*scene.volume, scene.optics)),
      isForOne(forOne),
      before_(std::move(before)) {
    const BlockSet* more = painter ? painter->more() : nullptr;
    if (more && !more->positions.empty())
        scene.volume = std::make_shared<const Volume>(withRoom(*scene.volume, *more));
    far = FarGroups::find(*scene.volume, more);
}

// What is known of all is known of a group: its colours, and light that others leave of it.
PreparedScene::Impl::Impl(const Impl& whole, std::size_t group)
    : given(whole.given),
      scene{std::make_shared<const Volume>(whole.far->volume(group)), whole.scene.optics},
      painter(whole.painter),
      optics(whole.optics),
      options(whole.options),
      isThin(whole.isThin),
      isForOne(whole.isForOne),
      wordBytes(whole.wordBytes) {}

PreparedScene::Impl::Impl(const Impl& before, Optics others)
    : Impl({before.given, std::move(others)}, before.options, before.isForOne, before.axes()) {}

PreparedScene::Impl::Axes PreparedScene::Impl::axes() const {
    Axes axes = before_;
    // Of what is painted, words are not all that classes say, even where none are left.
    if (painter) return axes;
    const std::lock_guard lock(mutex_);
    for (const auto& [key, place] : places_) {
        const std::lock_guard placeLock(place->mutex);
        if (place->axis) axes[key] = place->axis;
    }
    return axes;
}

std::shared_ptr<const PreparedAxis> PreparedScene::Impl::wholeAxis(Place& place) {
    // Who is making it may be waiting for the other one.
    const std::unique_lock lock(place.mutex, std::try_to_lock);
    return lock && place.axis && place.axis->deltas().areWhole() ? place.axis : nullptr;
}

const PreparedAxis* PreparedScene::Impl::axisBefore(const Key& key, const Key& otherKey) const {
    const auto same = before_.find(key);
    if (same != before_.end()) return same->second.get();
    const auto other = before_.find(otherKey);
    const bool serves = other != before_.end() && other->second->deltas().areWhole();
    return serves ? other->second.get() : nullptr;
}

void PreparedScene::Impl::forgetSlants(const Key& key) const {
    const auto isOther = [&](const Places::value_type& one) {
        const auto end = key.begin() + kKeyOfAllSlants;
        return std::equal(key.begin(), end, one.first.begin()) && one.first != key;
    };
    std::uint64_t last = 0;
    for (const auto& one : places_)
        if (isOther(one)) last = std::max(last, one.second->lastUse);
    // Who uses one holds it.
    std::erase_if(places_,
                  [&](const auto& one) { return isOther(one) && one.second->lastUse != last; });
}

void PreparedScene::Impl::forgetOtherEyes(const glm::dvec3& eye) const {
    std::erase_if(places_,
                  [&](const auto& one) { return one.second->eye && *one.second->eye != eye; });
}

std::shared_ptr<const PreparedAxis> PreparedScene::Impl::axis(const Factorization& view,
                                                              const SheetPlan& plan,
                                                              const Listener& listener,
                                                              const Camera* camera,
                                                              bool inParts) const {
    const int sliceAxis = view.sliceAxis;
    const Subdivision parts = plan.partsIn(view);
    const bool isWhole =
        painter ? painter->isEverywhereOther() || (view.eye && painter->dependsOnCamera())
                : options.method == Method::kAuto && options.tolerance.isExact() &&
                      isMostlyEmpty(*scene.volume, sliceAxis);
    const bool hasPixels = plan.footprintWidth(view) == 1;
    const Encoding encoding =
        isWhole ? Encoding::kWhole
                : encodingOf(options.method, painter != nullptr, hasPixels, parts.divides());
    // Slices are walked from the front on. Whole ones do not depend on it.
    const bool descending = !view.frontToBack && encoding != Encoding::kWhole;
    // Of joined ones, what they look like does; of several colours, unless they are pairs, also how
    // long steps are.
    const bool isJoined = parts.joined > 1;
    const bool areSums = hasOneColor() && parts.joinedWithin == 1;
    const bool isOfSteps = isJoined && !areSums && (parts.joined > 2 || !canPairSlices());
    const bool fromEnd = descending || (isJoined && !view.frontToBack);
    AxisRequest request{sliceAxis, descending, parts,
                        view.frontToBack ? SeenThrough::kSecond : SeenThrough::kFirst,
                        isForOne || isOfSteps ? stepsOf(view, *scene.volume) : 1};
    request.encoding = encoding;
    // From an eye slabs are as long as they are, whatever is in them: what is seen is all that may
    // be packed. What is held depends on all that lies before it.
    request.slabLength = view.eye ? SlabLength::kShortest : SlabLength::kByCounts;
    request.mayBeParted = isForOne && inParts;
    const bool packsSeen = view.eye && camera && !scene.volume->empty() &&
                           options.tolerance.isExact() && (isForOne || isJoined);
    if (packsSeen) request.seen = seenCone(*this, *camera, view, plan);
    // No other region sees the same.
    if (packsSeen && isForOne) return prepare(*this, request, listener);
    Key key{sliceAxis,    int(encoding), int(fromEnd), int(request.slabLength),
            parts.slices, parts.within,  parts.joined, parts.joinedWithin};
    for (const glm::ivec2& slant : parts.joinedSlants()) key.insert(key.end(), {slant.x, slant.y});
    if (isOfSteps) key.push_back(std::bit_cast<std::int64_t>(request.steps));
    Key otherKey = key;
    otherKey[2] = int(!fromEnd);
    std::shared_ptr<Place> otherWay;
    std::shared_ptr<Place> place;
    {
        const std::lock_guard lock(mutex_);
        if (packsSeen) forgetOtherEyes(indexOfEye(view));
        const auto other = places_.find(otherKey);
        if (other != places_.end()) otherWay = other->second;
        std::shared_ptr<Place>& known = places_[key];
        if (!known) known = std::make_shared<Place>();
        known->lastUse = ++uses_;
        if (packsSeen) known->eye = indexOfEye(view);
        place = known;
        if (isJoined && !view.eye) forgetSlants(key);
    }
    const std::lock_guard lock(place->mutex);
    // Seen from elsewhere, it has other words.
    if (place->axis && place->axis->seen != request.seen) place->axis = nullptr;
    // Work of another picture, taken on while waiting here, might want the same axis.
    std::shared_ptr<const PreparedAxis> other;
    if (!place->axis && otherWay) other = wholeAxis(*otherWay);
    if (other && !isJoined) place->axis = other;
    if (!place->axis)
        isolated([&] {
            const bool isOther = other && other->seen == request.seen;
            request.before = isOther ? other.get() : axisBefore(key, otherKey);
            place->axis = prepare(*this, request, listener);
        });
    return place->axis;
}

bool PreparedScene::Impl::canJoinSlices() const {
    return !painter && options.tolerance.isExact() && !scene.volume->empty();
}

bool PreparedScene::Impl::canPairSlices() const {
    if (!canJoinSlices()) return false;
    if (hasOneColor()) return true;
    const std::lock_guard lock(blocksMutex_);
    if (!canPairSlices_) {
        double farthest = 0;
        for (int axis = 0; axis < 3; ++axis)
            farthest = std::max(farthest, planeDistance(scene.volume->worldFromIndex, axis));
        // In shorter steps there are no more classes.
        isolated(
            [&] { canPairSlices_ = canBePaired(classify(*scene.volume, scene.optics, farthest)); });
    }
    return *canPairSlices_;
}

std::size_t PreparedScene::Impl::blocksSeen(int sliceAxis) const {
    const std::lock_guard lock(blocksMutex_);
    std::optional<std::size_t>& blocks = blocksSeen_[std::size_t(sliceAxis)];
    if (!blocks) isolated([&] { blocks = countBlocks(*this, sliceAxis); });
    return *blocks;
}

PreparedScene::PreparedScene(Scene scene, SplatOptions options) {
    const DefaultFloats floats;
    impl_ = std::make_shared<const Impl>(std::move(scene), options);
}

PreparedScene PreparedScene::withOptics(Optics optics) const {
    const DefaultFloats floats;
    PreparedScene other(*this);
    other.impl_ = std::make_shared<const Impl>(*impl_, std::move(optics));
    return other;
}

const Scene& PreparedScene::scene() const {
    return impl_->scene;
}

const SplatOptions& PreparedScene::options() const {
    return impl_->options;
}

}  // namespace deltasplat
