// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/uncleared.h"
#include "deltasplat/view/factorization.h"
#include "optics/voxel_painter.h"
#include "volume/code_math.h"
#include "volume/seen_cone.h"
#include "words/slab_plan.h"

namespace deltasplat {

class SliceJoiner;
class ValueMixer;

/// Classes of 64 empty voxels.
inline constexpr std::array<ClassIndex, 64> kEmptyClasses{};

/// One slice of an 8x8x8 block: its 64 voxels, bit 8 * u + v of the masks, as OpenVDB's leaves have
/// them.
struct DeltaWord {
    std::uint64_t visible;  ///< whose class is not empty
    /// Whose class or own look differs from the slice that is walked before; in a key slice,
    /// visible.
    std::uint64_t changed;
    const ClassIndex* classes;  ///< [64]: of all voxels in this slice
    glm::ivec2 block;           ///< (u, v) of the first voxel divided by 8
};

/// The delta grid of a volume as a picture needs it: of classes instead of codes, ordered as it is
/// walked, and without what nothing is stamped for.
struct PackedDeltas {
    PackedDeltas() = default;
    PackedDeltas(const PackedDeltas&) = delete;
    PackedDeltas& operator=(const PackedDeltas&) = delete;
    PackedDeltas(PackedDeltas&&) = default;
    PackedDeltas& operator=(PackedDeltas&&) = default;

    int sliceAxis = 2;
    /// Slices are walked from the last to the first: what changes is told from the one behind.
    /// Where all slabs are whole, that makes no difference, and they may be walked either way.
    bool descending = false;
    IndexBox box;  ///< of all slices, in (slice, u, v) order
    std::vector<PlannedSlab>
        slabs;  ///< in increasing order, covering `box`; none for an empty volume

    std::uint64_t visible() const;  ///< visible voxels, all slabs together
    std::uint64_t deltas() const;   ///< deltas, all slabs together
    /// Whether all slices are splatted anew.
    bool areWhole() const;
    /// The words of a slice with changed voxels, or with visible ones in a slab that is whole,
    /// ordered by u, then v.
    std::span<const DeltaWord> slice(int index) const;

    UnclearedVector<DeltaWord> words;  ///< by slice, u and v
    std::vector<std::size_t> begins;   ///< [slices + 1]: the first of each slice's words
    std::vector<UnclearedVector<ClassIndex>> storage;  ///< what they point into
    /// [word]: where voxels have looks of their own, those of its voxels, [64]; else empty.
    std::vector<const OwnLook*> looks;
    std::vector<std::vector<OwnLook>> lookStorage;  ///< what those point into
};

/// How to pack deltas.
struct PackOptions {
    int sliceAxis = 2;
    Encoding encoding = Encoding::kChanges;
    std::span<const Slot> classOfSlot;  ///< [kSlotCount], entry 0 must be 0
    /// May a voxel of the second slot go on as one of the first, which the slice before has? Both
    /// can be seen and belong to different classes. Empty: never.
    std::function<bool(Slot held, Slot slot)> holds;
    /// Divides voxels into thin ones, which then are what voxels are. Slots are those of its
    /// levels. Null: none.
    const ValueMixer* mixer = nullptr;
    /// With a mixer, [classes]: how opaque a voxel of each is, as ValueMixer::mix takes it.
    std::span<const float> opacities = {};
    /// Gives voxels looks of their own. Null: classes say all. With one that chooses classes there
    /// has to be a mixer, and nothing is held.
    const VoxelPainter* painter = nullptr;
    /// With a painter, may a voxel go on as the first, for which `holds` has to allow it as well?
    /// Empty: never.
    std::function<bool(const VoxelLook& held, const VoxelLook& look)> looksHold = {};
    bool descending = false;  ///< as PackedDeltas has it
    /// Joins slices, whose voxels then have its classes, or those of what the packer made of it
    /// (DeltaPacker::joiner). Null: none are. Not with a mixer or a painter, or where voxels are
    /// held.
    const SliceJoiner* joiner = nullptr;
    std::span<const glm::ivec2> slants = {};  ///< with a joiner, as Subdivision::joinedSlants
    int joinedWithin = 1;                     ///< with one of as many, as Subdivision::joinedWithin
    /// Leaves out blocks of voxels that it does not see. Not where voxels are held.
    std::optional<SeenCone> seen = {};
    SlabLength slabLength = SlabLength::kByCounts;
};

/// Returns a volume's box in (slice, u, v) order, of what its voxels are divided into, or joined
/// to.
IndexBox boxOfSlices(const IndexBox& box, int sliceAxis, const Subdivision& parts);

/// Takes the differences of consecutive slices, in one pass over the leaves that can be seen, and
/// cuts them into slabs (SlabPlanner). With `holds`, a voxel keeps its class along the slice axis
/// as long as it may: compared with its true slot each time, so that errors never add up. Linear in
/// the active voxels; deterministic; multi-threaded.
PackedDeltas packDeltas(const Volume& volume, const PackOptions& options);

/// Slabs [first, last).
struct SlabRange {
    int first;
    int last;
};

/// Packs deltas as packDeltas does, or those of a few slabs at a time, so that few words are in
/// memory at once: then the volume is gone through once to find the slabs, and once for each part.
class DeltaPacker {
  public:
    /// @param volume  must outlive this
    DeltaPacker(const Volume& volume, const PackOptions& options);
    ~DeltaPacker();
    DeltaPacker(DeltaPacker&&) noexcept;

    /// Whether parts can be made: no voxel is held, divided or painted.
    bool canBeParted() const;
    /// The most bytes that all words may take, of what is known before they are counted.
    double mostBytes() const;
    PackedDeltas packAll();
    /// Returns what packAll() does where words take no more than so many bytes; else the slabs,
    /// without words. Only where parts can be made.
    /// @param mostBytes  also of a part, unless it is of one slab
    PackedDeltas packOrPlan(double mostBytes);
    /// What joined slices, once that is done: looks are rounded as far as they have to be.
    const std::optional<SliceJoiner>& joiner() const;
    /// The parts that the words are packed in, in increasing order, once there is a plan of some.
    const std::vector<SlabRange>& parts() const;
    /// Returns all slabs, of which those of a part have their words.
    PackedDeltas pack(const SlabRange& part) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
