// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/kept_memory.h"
#include "deltasplat/prepared_scene.h"
#include "optics/color_curve.h"
#include "picture/far_groups.h"
#include "picture/join_judge.h"
#include "splat/word_colors.h"
#include "volume/seen_cone.h"
#include "words/packed_deltas.h"
#include "words/slice_joiner.h"

namespace deltasplat {

struct ViewPlan;

/// Which words a slice axis has: those of equal keys are the same, of one scene.
struct AxisKey {
    int sliceAxis = 2;
    Encoding encoding = Encoding::kChanges;
    SlabLength slabLength = SlabLength::kByCounts;
    bool fromEnd = false;  ///< slices are walked, or joined, from the last one on
    Subdivision parts;
    /// The steps of the view, where joined slices look different for other ones.
    std::optional<double> steps;

    bool operator==(const AxisKey&) const = default;
    /// Returns that of the same slices in the other direction.
    AxisKey otherWay() const;
    /// Whether another differs in slants or steps at most.
    bool isAlike(const AxisKey& other) const;
};

/// What an axis is to be.
struct AxisPlan {
    AxisKey key;
    bool descending = false;                         ///< as PackedDeltas::descending
    SeenThrough seenThrough = SeenThrough::kSecond;  ///< of joined slices, which of two is behind
    double steps = 1;                   ///< that colours are for, straight ways from slice to slice
    std::optional<SeenCone> seen = {};  ///< of which there are to be words; empty: of all
    bool mayBeParted = false;           ///< whether words of a few slabs at a time will do
};

/// A volume as slices along one axis: what slabs are rendered from, by whatever camera that sees
/// them from the same end, or from either if all are whole.
struct PreparedAxis {
    AxisPlan plan;
    std::shared_ptr<const PackedDeltas> words;  ///< other optics may share them
    StepColors colors;  ///< of classes alone where looks depend on the camera
    /// Packs the words of a few slabs at a time, where all would take much memory: then there are
    /// none yet. Else null.
    std::shared_ptr<const DeltaPacker> packer = nullptr;
    std::optional<SliceJoiner> joiner = {};  ///< where slices are joined

    const PackedDeltas& deltas() const { return *words; }
    const ClassTable& classes() const { return colors.classes(); }
    int sliceAxis() const { return plan.key.sliceAxis; }
    const Subdivision& parts() const { return plan.key.parts; }
    /// Footprints that a method adds.
    std::uint64_t stamps(Method method) const;
    /// Returns the same with the words of some slabs, by the packer.
    std::shared_ptr<const PreparedAxis> withWords(const SlabRange& part) const;
};

/// The axes of a scene.
struct PreparedScene::Impl {
    /// @param forOne  whether there will be one picture only
    Impl(Scene ofScene, SplatOptions withOptions, bool forOne = false)
        : Impl(std::move(ofScene), withOptions, forOne, Axes()) {}
    /// The same volume seen by other optics.
    Impl(const Impl& before, Optics others);
    /// A group of a scene's voxels, as that shows them.
    Impl(const Impl& whole, std::size_t group);

    std::shared_ptr<const Volume> given;  ///< before it got room for what a painter adds
    Scene scene;
    std::shared_ptr<const VoxelPainter> painter;  ///< of own looks; null: there are none
    Optics optics;  ///< with the range that the volume has, and white if painted colours are others
    SplatOptions options;
    bool isThin;
    bool isForOne;
    /// Where voxels lie far apart: their groups, each of which is drawn as a scene of its own.
    std::optional<FarGroups> far;
    /// The most that words of an axis are to take where a picture may be made in parts.
    double wordBytes = 256.0 * 1024 * 1024;

    /// Returns the axis that a plan asks for, made if it is not there.
    std::shared_ptr<const PreparedAxis> axis(const AxisPlan& plan, const Listener& listener) const;
    /// Returns whether voxels differ in nothing but how much light they absorb, by the transfer
    /// function alone.
    bool hasOneColor() const { return deltasplat::hasOneColor(optics.transferFunction); }
    /// Whether it is seen that slices are joined.
    JoinJudge joinJudge;
    /// Returns whether slices can be joined.
    bool canJoinSlices() const;
    /// Returns whether two can be for all cameras (words/joined_classes.h), along whatever axis.
    bool canPairSlices() const;
    /// Returns how many blocks of 8x8x8 voxels can be seen; counted once for each axis.
    std::size_t blocksSeen(int sliceAxis) const;
    /// Returns the classes of whole voxels in straight steps along an axis; made once for each.
    const ClassTable& straightClasses(int sliceAxis) const;
    /// Returns them if they have been asked for, or null.
    const ClassTable* knownClasses(int sliceAxis) const;
    /// Memory for sheets and layers, which pictures of the scene leave for those behind them.
    std::shared_ptr<KeptMemory> memory = std::make_shared<KeptMemory>();

  private:
    struct KnownAxis {
        AxisKey key;
        std::shared_ptr<const PreparedAxis> axis;
    };
    using Axes = std::vector<KnownAxis>;
    struct Place {
        std::mutex mutex;
        std::shared_ptr<const PreparedAxis> axis;
        AxisKey key;
        // Guarded as places_ are:
        std::uint64_t lastUse = 0;
        std::optional<glm::dvec3> eye;  // that sees all that is there; empty: there is all
    };

    Impl(Scene ofScene, SplatOptions withOptions, bool forOne, Axes before);

    // Returns an axis whose slices are walked the other way if that makes no difference; null:
    // there is none yet.
    static std::shared_ptr<const PreparedAxis> wholeAxis(Place& place);
    // Returns an axis of other optics whose words may serve, or null.
    const PreparedAxis* axisBefore(const AxisKey& key) const;
    // Returns the place of a key, or null.
    std::shared_ptr<Place> placeOf(const AxisKey& key) const;
    // Forgets axes of other slants than a key's, but for the one that was used last.
    void forgetSlants(const AxisKey& key) const;
    // Forgets axes of which only is there what another eye sees.
    void forgetOtherEyes(const glm::dvec3& eye) const;
    // Returns those that are there of classes alone, and those of optics before for which there are
    // none.
    Axes axes() const;

    const Axes before_;  // of other optics
    mutable std::mutex mutex_;
    mutable std::vector<std::shared_ptr<Place>> places_;
    mutable std::uint64_t uses_ = 0;
    // Facts of the volume that plans ask for; [slice axis].
    mutable std::mutex factsMutex_;
    mutable std::array<std::unique_ptr<const ClassTable>, 3> straightClasses_;
    mutable std::array<std::optional<std::size_t>, 3> blocksSeen_;
    mutable std::optional<bool> canPairSlices_;
};

}  // namespace deltasplat
