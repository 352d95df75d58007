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
#include "base/parallel.h"
#include "base/portable_math.h"
#include "deltasplat/error.h"
#include "lighting/part_sampler.h"
#include "optics/color_digits.h"
#include "optics/hold_rule.h"
#include "picture/draw_plan.h"
#include "volume/code_blocks.h"
#include "volume/code_math.h"
#include "volume/seen_cone.h"
#include "words/joined_tiles.h"
#include "words/value_mixer.h"

namespace deltasplat {
namespace {

// Returns the optics with a range; if a painter gives all colours, with opacities only.
Optics opticsOf(const Volume& volume, Optics optics, const VoxelPainter* painter) {
    if (!optics.range) optics.range = defaultRange(volume);
    if (painter && !painter->needsColors()) optics.transferFunction.colors = {{0, glm::dvec3(1)}};
    return optics;
}

Scene requireVolume(Scene scene) {
    if (scene.volume) return scene;
    throw Error(ErrorCode::kUsage, "scene", "no volume", "one");
}

// Whether the volume is thin. In thin volumes two sheet pixels per voxel show little more than one,
// and mixed values little more (docs/decisions.md). The decision ignores the visible voxels, so
// that no single voxel or angle changes the whole picture.
bool showsThin(const Volume& volume, const Optics& optics) {
    constexpr double kMost = 0.25;
    return !optics.surface && largestAlpha(volume, optics) <= kMost;
}

// Whether shorter steps may hide a class. Visibility must not depend on the scene's first picture.
bool shorterMayShowLess(const ClassTable& classes, double times) {
    // Twice the share of the largest opacity that is sure to be seen (ClassTable), for rounding. A
    // class shrinks by `times` at most, and the largest does not grow.
    const double sure = 2 * 0x1p-40 * ClassTable::kMax * times;
    // One plane holds nothing below 2^-20 of the largest.
    if (classes.planes.size() == 1 && sure < 0x1p-20 * ClassTable::kMax) return false;
    for (std::size_t number = 1; number < classes.size(); ++number)
        if (classes.unitsOf(Slot(number)).a < sure) return true;
    return false;
}

// Returns the opacity of classes along a voxel's shortest side: mixing must ignore the camera.
std::vector<float> opacitiesOf(const Volume& volume, const ClassTable& classes) {
    const double side = smallestSize(volume) / classes.unitDistanceWorld * classes.extinctionScale;
    std::vector<float> opacities;
    for (const Look& look : classes.looks) {
        const double depth = look.extinction > 0 ? look.extinction * side : 0;
        opacities.push_back(float(-portable::expm1(-depth)));
    }
    return opacities;
}

// Warns if rounding the looks of joined slices may be visible.
void warnOfRounding(const SliceJoiner& joiner, const Listener& listener) {
    constexpr int kFewBits = 4;
    if (!joiner.looks()) return;
    const int bits = joiner.looks()->run().bits;
    if (bits > kFewBits) return;
    listener.warn("voxels have so many looks that joined slices have colours of " +
                  std::to_string(1 << bits) + " levels a channel; `between` 0 draws every voxel");
}

// Returns the words of other optics, or null, and numbers the classes alike. Unless something is
// held or painted, words depend only on classes and, if divided, on opacities (checked elsewhere).
// @param before  the same axis with other optics, or null
std::shared_ptr<const PackedDeltas> sharedWords(const AxisPlan& plan,
                                                const PreparedScene::Impl& scene,
                                                const PreparedAxis* before, ClassTable& classes) {
    const bool areOfClasses = !scene.painter && scene.options.tolerance.isExact();
    if (!before || !areOfClasses || before->packer || before->plan.seen != plan.seen) return {};
    return takeNumbers(before->classes(), classes) ? before->words : nullptr;
}

// Returns the classes of levels for an axis' steps, or for straight steps if shorter ones would
// hide some. `first` becomes the steps of the classes.
ClassTable classesOf(const PreparedScene::Impl& scene, const AxisPlan& plan, const Volume& levels,
                     double& first) {
    const Volume& volume = *scene.scene.volume;
    const AxisKey& key = plan.key;
    const double straight =
        planeDistance(volume.worldFromIndex(), key.sliceAxis) / key.parts.slices;
    const auto straightClasses = [&] {
        const ClassTable* const known =
            &levels == &volume ? scene.knownClasses(key.sliceAxis) : nullptr;
        return known ? *known : classify(levels, scene.optics, straight);
    };
    // Held voxels must not depend on the camera, so straight steps decide.
    first = scene.options.tolerance.isExact() ? plan.steps : 1;
    if (first == 1) return straightClasses();
    ClassTable classes = classify(levels, scene.optics, straight * first);
    if (!shorterMayShowLess(classes, first)) return classes;
    first = 1;
    return straightClasses();
}

// @param before  the same axis with other optics, or null
std::shared_ptr<const PreparedAxis> prepare(const PreparedScene::Impl& scene, const AxisPlan& plan,
                                            const PreparedAxis* before, const Listener& listener) {
    const Subdivision& parts = plan.key.parts;
    const Volume& volume = *scene.scene.volume;
    const Tolerance& tolerance = scene.options.tolerance;
    std::optional<ValueMixer> mixer;
    const VoxelPainter* painter = scene.painter.get();
    if (parts.divides() || (painter && painter->choosesClasses()))
        mixer.emplace(volume, parts, scene.options.keepsLone);
    const Volume& levels = mixer ? mixer->levels() : volume;
    double first = 1;
    ClassTable classes = classesOf(scene, plan, levels, first);
    listener.report(0.05);
    // Small footprints are never stamped with two digits.
    Encoding encoding = plan.key.encoding;
    if (encoding == Encoding::kFewerWordsOrStamps && !classes.oneDigit())
        encoding = Encoding::kFewerWords;
    std::shared_ptr<const PackedDeltas> words = sharedWords(plan, scene, before, classes);
    const JoinedRun run{parts.joined, parts.joinedWithin, plan.seenThrough, plan.steps / first};
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
    PackOptions pack{plan.key.sliceAxis, encoding, classes.classOfSlot(),
                     holdRule(levels, classes, tolerance), mixer ? &*mixer : nullptr};
    pack.descending = plan.descending;
    if (joiner) pack.joiner = &*joiner;
    pack.slants = parts.joinedSlants();
    pack.joinedWithin = parts.joinedWithin;
    pack.seen = plan.seen;
    pack.slabLength = plan.key.slabLength;
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
            plan.mayBeParted && packer->canBeParted() && packer->mostBytes() > scene.wordBytes;
        words = std::make_shared<const PackedDeltas>(inParts ? packer->packOrPlan(scene.wordBytes)
                                                             : packer->packAll());
        joiner = packer->joiner();
        if (packer->parts().empty()) packer = nullptr;
    }
    if (joiner) {
        warnOfRounding(*joiner, listener);
        classes = joinedClasses(classes, *joiner, run);
    } else if (plan.steps != first) {
        classes = classes.atSteps(plan.steps);
        if (light) light = painter->lightOf(classes, nullptr);
    }
    StepColors colors = isLit ? StepColors(std::move(classes))
                              : StepColors(*words, std::move(classes), std::move(light));
    return std::make_shared<const PreparedAxis>(PreparedAxis{
        plan, std::move(words), std::move(colors), std::move(packer), std::move(joiner)});
}

}  // namespace

AxisKey AxisKey::otherWay() const {
    AxisKey other = *this;
    other.fromEnd = !fromEnd;
    return other;
}

bool AxisKey::isAlike(const AxisKey& other) const {
    AxisKey one = *this;
    one.parts.slants = other.parts.slants;
    one.steps = other.steps;
    return one == other;
}

std::uint64_t PreparedAxis::stamps(Method method) const {
    if (method == Method::kTraditional) return voxelsOf(deltas().box);
    std::uint64_t stamps = 0;
    for (const PlannedSlab& slab : deltas().slabs) stamps += slab.stamps();
    return stamps;
}

std::shared_ptr<const PreparedAxis> PreparedAxis::withWords(const SlabRange& part) const {
    auto some = std::make_shared<const PackedDeltas>(packer->pack(part));
    // Painted words are never packed in parts.
    StepColors ofSome(*some, classes(), nullptr);
    return std::make_shared<const PreparedAxis>(
        PreparedAxis{plan, std::move(some), std::move(ofSome)});
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

// The group shares the whole's facts: colours, and the light that other groups leave.
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
    : Impl({before.given, std::move(others)}, before.options, before.isForOne, before.axes()) {
    memory = before.memory;
}

PreparedScene::Impl::Axes PreparedScene::Impl::axes() const {
    // Words of painted voxels depend on more than classes.
    if (painter) return before_;
    Axes axes;
    const std::lock_guard lock(mutex_);
    for (const std::shared_ptr<Place>& place : places_) {
        const std::lock_guard placeLock(place->mutex);
        if (place->axis) axes.push_back({place->key, place->axis});
    }
    const auto isKnown = [&](const KnownAxis& before) {
        return std::any_of(axes.begin(), axes.end(),
                           [&](const KnownAxis& known) { return known.key == before.key; });
    };
    for (const KnownAxis& before : before_)
        if (!isKnown(before)) axes.push_back(before);
    return axes;
}

std::shared_ptr<const PreparedAxis> PreparedScene::Impl::wholeAxis(Place& place) {
    // Waiting could deadlock, because its maker may wait for this axis.
    const std::unique_lock lock(place.mutex, std::try_to_lock);
    return lock && place.axis && place.axis->deltas().areWhole() ? place.axis : nullptr;
}

const PreparedAxis* PreparedScene::Impl::axisBefore(const AxisKey& key) const {
    const auto find = [&](const AxisKey& wanted) -> const PreparedAxis* {
        for (const KnownAxis& known : before_)
            if (known.key == wanted) return known.axis.get();
        return nullptr;
    };
    if (const PreparedAxis* same = find(key)) return same;
    const PreparedAxis* other = find(key.otherWay());
    return other && other->deltas().areWhole() ? other : nullptr;
}

std::shared_ptr<PreparedScene::Impl::Place> PreparedScene::Impl::placeOf(const AxisKey& key) const {
    for (const std::shared_ptr<Place>& place : places_)
        if (place->key == key) return place;
    return nullptr;
}

void PreparedScene::Impl::forgetSlants(const AxisKey& key) const {
    const auto isOther = [&](const std::shared_ptr<Place>& place) {
        return place->key.isAlike(key) && place->key != key;
    };
    std::uint64_t last = 0;
    for (const std::shared_ptr<Place>& place : places_)
        if (isOther(place)) last = std::max(last, place->lastUse);
    // Users of an axis hold it.
    std::erase_if(places_,
                  [&](const auto& place) { return isOther(place) && place->lastUse != last; });
}

void PreparedScene::Impl::forgetOtherEyes(const glm::dvec3& eye) const {
    std::erase_if(places_, [&](const auto& place) { return place->eye && *place->eye != eye; });
}

std::shared_ptr<const PreparedAxis> PreparedScene::Impl::axis(const AxisPlan& plan,
                                                              const Listener& listener) const {
    // No other region needs the same axis.
    if (plan.seen && isForOne) return prepare(*this, plan, nullptr, listener);
    const AxisKey& key = plan.key;
    const bool isJoined = key.parts.joined > 1;
    std::shared_ptr<Place> otherWay;
    std::shared_ptr<Place> place;
    {
        const std::lock_guard lock(mutex_);
        if (plan.seen) forgetOtherEyes(indexOfEye(plan.seen->eye, key.sliceAxis));
        otherWay = placeOf(key.otherWay());
        place = placeOf(key);
        if (!place) {
            place = std::make_shared<Place>();
            place->key = key;
            places_.push_back(place);
        }
        place->lastUse = ++uses_;
        if (plan.seen) place->eye = indexOfEye(plan.seen->eye, key.sliceAxis);
        if (isJoined && key.slabLength == SlabLength::kByCounts) forgetSlants(key);
    }
    const std::lock_guard lock(place->mutex);
    // Words for another eye do not serve.
    if (place->axis && place->axis->plan.seen != plan.seen) place->axis = nullptr;
    // Isolated, because other tasks taken on while waiting here might want the same axis.
    std::shared_ptr<const PreparedAxis> other;
    if (!place->axis && otherWay) other = wholeAxis(*otherWay);
    if (other && !isJoined) place->axis = other;
    if (!place->axis)
        isolated([&] {
            const bool isOther = other && other->plan.seen == plan.seen;
            place->axis = prepare(*this, plan, isOther ? other.get() : axisBefore(key), listener);
        });
    return place->axis;
}

bool PreparedScene::Impl::canJoinSlices() const {
    return !painter && options.tolerance.isExact() && !scene.volume->empty();
}

bool PreparedScene::Impl::canPairSlices() const {
    if (!canJoinSlices()) return false;
    if (hasOneColor()) return true;
    const glm::dmat4& worldFromIndex = scene.volume->worldFromIndex();
    int farthest = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (planeDistance(worldFromIndex, axis) > planeDistance(worldFromIndex, farthest))
            farthest = axis;
    // Shorter steps give no more classes.
    const ClassTable& classes = straightClasses(farthest);
    const std::lock_guard lock(factsMutex_);
    if (!canPairSlices_) canPairSlices_ = canBePaired(classes);
    return *canPairSlices_;
}

std::size_t PreparedScene::Impl::blocksSeen(int sliceAxis) const {
    const ClassTable& classes = straightClasses(sliceAxis);
    const std::lock_guard lock(factsMutex_);
    std::optional<std::size_t>& blocks = blocksSeen_[std::size_t(sliceAxis)];
    if (!blocks) {
        isolated([&] {
            blocks = listBlocks(*scene.volume->codes(), sliceAxis, classes.classOfSlot()).size();
        });
    }
    return *blocks;
}

const ClassTable* PreparedScene::Impl::knownClasses(int sliceAxis) const {
    const std::lock_guard lock(factsMutex_);
    return straightClasses_[std::size_t(sliceAxis)].get();
}

const ClassTable& PreparedScene::Impl::straightClasses(int sliceAxis) const {
    const std::lock_guard lock(factsMutex_);
    std::unique_ptr<const ClassTable>& classes = straightClasses_[std::size_t(sliceAxis)];
    if (!classes) {
        const double straight = planeDistance(scene.volume->worldFromIndex(), sliceAxis);
        isolated([&] {
            classes = std::make_unique<const ClassTable>(classify(*scene.volume, optics, straight));
        });
    }
    return *classes;
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
