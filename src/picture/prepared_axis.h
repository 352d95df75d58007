// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

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

class SheetPlan;

/// A volume as slices along one axis: what slabs are rendered from, by whatever camera that sees
/// them from the same end, or from either if all are whole.
struct PreparedAxis {
    int sliceAxis;
    Subdivision parts;
    std::shared_ptr<const PackedDeltas> words;  ///< other optics may share them
    double steps;       ///< that colours are for, straight ways from slice to slice
    StepColors colors;  ///< of classes alone where looks depend on the camera
    /// Packs the words of a few slabs at a time, where all would take much memory: then there are
    /// none yet. Else null.
    std::shared_ptr<const DeltaPacker> packer = nullptr;
    std::optional<SliceJoiner> joiner = {};  ///< where slices are joined
    std::optional<SeenCone> seen = {};       ///< of which there are words; empty: of all

    const PackedDeltas& deltas() const { return *words; }
    const ClassTable& classes() const { return colors.classes(); }
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

    /// Returns the axis of a view, made if it is not there. Classes are coloured for the view's
    /// steps if there will be no other picture. From an eye, what is lit looks different in each
    /// slice, and slabs are whole.
    /// @param camera   whose picture it is for: from an eye, what that does not see may be left
    ///                 out; null: there is all
    /// @param inParts  whether a few slabs at a time will do, of a scene for one picture
    std::shared_ptr<const PreparedAxis> axis(const Factorization& view, const SheetPlan& plan,
                                             const Listener& listener, const Camera* camera,
                                             bool inParts = false) const;
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

  private:
    // Axis, encoding, from which end slices are walked, how long slabs are, parts, how many slices
    // and voxels beside each other are joined; then by which slants and for which steps.
    using Key = std::vector<std::int64_t>;
    static constexpr std::ptrdiff_t kKeyOfAllSlants = 8;
    using Axes = std::map<Key, std::shared_ptr<const PreparedAxis>>;
    struct Place {
        std::mutex mutex;
        std::shared_ptr<const PreparedAxis> axis;
        // Guarded as places_ are:
        std::uint64_t lastUse = 0;
        std::optional<glm::dvec3> eye;  // that sees all that is there; empty: there is all
    };
    using Places = std::map<Key, std::shared_ptr<Place>>;

    Impl(Scene ofScene, SplatOptions withOptions, bool forOne, Axes before);

    // Returns an axis whose slices are walked the other way if that makes no difference; null:
    // there is none yet.
    static std::shared_ptr<const PreparedAxis> wholeAxis(Place& place);
    // Returns an axis of other optics whose words may serve, or null.
    const PreparedAxis* axisBefore(const Key& key, const Key& otherKey) const;
    // Forgets axes of other slants than a key's, but for the one that was used last.
    void forgetSlants(const Key& key) const;
    // Forgets axes of which only is there what another eye sees.
    void forgetOtherEyes(const glm::dvec3& eye) const;
    // Returns those that are there of classes alone, and those of optics before for which there are
    // none.
    Axes axes() const;

    const Axes before_;  // of other optics
    mutable std::mutex mutex_;
    mutable Places places_;
    mutable std::uint64_t uses_ = 0;
    mutable std::mutex blocksMutex_;
    mutable std::array<std::optional<std::size_t>, 3> blocksSeen_;  // [slice axis]
    mutable std::optional<bool> canPairSlices_;
};

class DeepStages;

/// What a picture is cut into in depth.
struct DeepRequest {
    int slicesPerSample;  ///< 0: one of those that slices are divided into
    DeepStages& stages;
};

/// As the public one, of a scene's insides, into a picture of the camera's size that is clear.
/// @param memory  for sheets and layers
/// @param deep    if the picture is wanted stage by stage as well
RenderStats renderComposite(const PreparedScene::Impl& scene, const Camera& camera,
                            KeptMemory& memory, Image& image, const Listener& listener,
                            const DeepRequest* deep = nullptr);

}  // namespace deltasplat
