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

/// Identifies the words of a slice axis in a scene.
struct AxisKey {
    int sliceAxis = 2;
    Encoding encoding = Encoding::kChanges;
    SlabLength slabLength = SlabLength::kByCounts;
    bool fromEnd = false;  ///< slices are walked or joined from the last one on
    Subdivision parts;
    /// The steps of the view, if joined slices depend on them.
    std::optional<double> steps;

    bool operator==(const AxisKey&) const = default;
    /// Returns the key of the same slices in the other direction.
    AxisKey otherWay() const;
    /// Whether the keys differ at most in slants or steps.
    bool isAlike(const AxisKey& other) const;
};

struct AxisPlan {
    AxisKey key;
    bool descending = false;                         ///< as PackedDeltas::descending
    SeenThrough seenThrough = SeenThrough::kSecond;  ///< which of two joined slices is behind
    double steps = 1;                   ///< length that colours are for, in straight steps
    std::optional<SeenCone> seen = {};  ///< the only part that needs words; empty: all
    bool mayBeParted = false;           ///< whether words of a few slabs at a time suffice
};

/// A volume as slices along an axis, for cameras at the same end, or at either if slices are whole.
struct PreparedAxis {
    AxisPlan plan;
    std::shared_ptr<const PackedDeltas> words;  ///< may be shared with other optics
    StepColors colors;                          ///< of classes alone if looks depend on the camera
    /// Packs the words of a few slabs at a time if all take too much memory, else null.
    std::shared_ptr<const DeltaPacker> packer = nullptr;
    std::optional<SliceJoiner> joiner = {};  ///< if slices are joined

    const PackedDeltas& deltas() const { return *words; }
    const ClassTable& classes() const { return colors.classes(); }
    int sliceAxis() const { return plan.key.sliceAxis; }
    const Subdivision& parts() const { return plan.key.parts; }
    /// Footprints that a method adds.
    std::uint64_t stamps(Method method) const;
    /// Returns the axis with the words of some slabs, from the packer.
    std::shared_ptr<const PreparedAxis> withWords(const SlabRange& part) const;
};

struct PreparedScene::Impl {
    /// @param forOne  whether there will be only one picture
    Impl(Scene ofScene, SplatOptions withOptions, bool forOne = false)
        : Impl(std::move(ofScene), withOptions, forOne, Axes()) {}
    /// The same volume with other optics.
    Impl(const Impl& before, Optics others);
    /// A group of a scene's voxels, seen by the scene's optics.
    Impl(const Impl& whole, std::size_t group);

    std::shared_ptr<const Volume> given;  ///< before it got room for the painter's blocks
    Scene scene;
    std::shared_ptr<const VoxelPainter> painter;  ///< gives own looks; null: there are none
    Optics optics;  ///< with the volume's range; white if painters give colours
    SplatOptions options;
    bool isThin;
    bool isForOne;
    /// Groups that lie far apart, each drawn as a scene of its own.
    std::optional<FarGroups> far;
    /// Limit for an axis' words, in bytes, if a picture may be made in parts.
    double wordBytes = 256.0 * 1024 * 1024;

    /// Returns the axis of a plan, prepared at the first call.
    std::shared_ptr<const PreparedAxis> axis(const AxisPlan& plan, const Listener& listener) const;
    /// Returns whether, by the transfer function, voxels differ only in absorption.
    bool hasOneColor() const { return deltasplat::hasOneColor(optics.transferFunction); }
    JoinJudge joinJudge;
    bool canJoinSlices() const;
    /// Returns whether two slices can be joined for all cameras, along any axis.
    bool canPairSlices() const;
    /// Returns the number of visible 8x8x8 blocks; counted once per axis.
    std::size_t blocksSeen(int sliceAxis) const;
    /// Returns the classes of whole voxels for straight steps; made once per axis.
    const ClassTable& straightClasses(int sliceAxis) const;
    /// Returns straightClasses() if they exist, or null.
    const ClassTable* knownClasses(int sliceAxis) const;
    /// Memory for sheets and layers, reused by the scene's pictures.
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
        // Guarded like places_:
        std::uint64_t lastUse = 0;
        std::optional<glm::dvec3> eye;  // the only eye the axis is for; empty: for all
    };

    Impl(Scene ofScene, SplatOptions withOptions, bool forOne, Axes before);

    // Returns an axis walked the other way if the direction makes no difference; else null.
    static std::shared_ptr<const PreparedAxis> wholeAxis(Place& place);
    // Returns an axis of the previous optics with usable words, or null.
    const PreparedAxis* axisBefore(const AxisKey& key) const;
    std::shared_ptr<Place> placeOf(const AxisKey& key) const;
    // Forgets axes alike but for slants or steps, except the last used.
    void forgetSlants(const AxisKey& key) const;
    // Forgets axes of other eyes.
    void forgetOtherEyes(const glm::dvec3& eye) const;
    // Axes that depend on classes only, plus the previous optics' axes for keys not known yet.
    Axes axes() const;

    const Axes before_;  // of previous optics
    mutable std::mutex mutex_;
    mutable std::vector<std::shared_ptr<Place>> places_;
    mutable std::uint64_t uses_ = 0;
    // Facts of the volume for plans; [slice axis].
    mutable std::mutex factsMutex_;
    mutable std::array<std::unique_ptr<const ClassTable>, 3> straightClasses_;
    mutable std::array<std::optional<std::size_t>, 3> blocksSeen_;
    mutable std::optional<bool> canPairSlices_;
};

}  // namespace deltasplat
