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

inline constexpr std::array<ClassIndex, 64> kEmptyClasses{};

/// A slice of an 8x8x8 block: 64 voxels, bit 8 * u + v of the masks, as in OpenVDB's leaves.
struct DeltaWord {
    std::uint64_t visible;  ///< voxels whose class is not empty
    /// Voxels whose class or look differs from the slice walked before; in a key slice, `visible`.
    std::uint64_t changed;
    const ClassIndex* classes;  ///< [64]: classes of all voxels
    glm::ivec2 block;           ///< (u, v) of the first voxel divided by 8
};

/// The delta grid of a picture: classes, in walking order, without words that stamp nothing.
struct PackedDeltas {
    PackedDeltas() = default;
    PackedDeltas(const PackedDeltas&) = delete;
    PackedDeltas& operator=(const PackedDeltas&) = delete;
    PackedDeltas(PackedDeltas&&) = default;
    PackedDeltas& operator=(PackedDeltas&&) = default;

    int sliceAxis = 2;
    /// Slices are walked from last to first, and changes are relative to the slice behind. Makes no
    /// difference if all slabs are whole.
    bool descending = false;
    IndexBox box;                    ///< of all slices, in (slice, u, v) order
    std::vector<PlannedSlab> slabs;  ///< in increasing order, covering `box`; none if empty

    std::uint64_t visible() const;  ///< visible voxels, all slabs together
    std::uint64_t deltas() const;   ///< deltas, all slabs together
    bool areWhole() const;
    /// A slice's words with changed voxels, or with visible ones in a whole slab, by u, then v.
    std::span<const DeltaWord> slice(int index) const;

    UnclearedVector<DeltaWord> words;  ///< by slice, u and v
    std::vector<std::size_t> begins;   ///< [slices + 1]: index of each slice's first word
    std::vector<UnclearedVector<ClassIndex>> storage;  ///< classes that words point to
    /// [word]: own looks of the voxels, [64]; empty if voxels have none.
    std::vector<const OwnLook*> looks;
    std::vector<std::vector<OwnLook>> lookStorage;  ///< looks that `looks` points to
};

struct PackOptions {
    int sliceAxis = 2;
    Encoding encoding = Encoding::kChanges;
    std::span<const Slot> classOfSlot;  ///< [kSlotCount], entry 0 must be 0
    /// May a voxel with the second slot hold the first, which the slice before has? Both slots are
    /// visible, of different classes. Empty: never.
    std::function<bool(Slot held, Slot slot)> holds;
    /// Divides voxels into thin ones. Slots are then those of the mixer's levels. May be null.
    const ValueMixer* mixer = nullptr;
    /// With a mixer, [class]: opacity of a voxel, as for ValueMixer::mix.
    std::span<const float> opacities = {};
    /// Gives voxels own looks, or null. If it chooses classes, a mixer is needed and no holding.
    const VoxelPainter* painter = nullptr;
    /// With a painter: may a voxel hold the first look? `holds` must agree. Empty: never.
    std::function<bool(const VoxelLook& held, const VoxelLook& look)> looksHold = {};
    bool descending = false;  ///< as in PackedDeltas
    /// Joins slices. Voxels then have the classes of this joiner, or of the packer's coarser one
    /// (DeltaPacker::joiner). May be null. Not with a mixer, a painter or holding.
    const SliceJoiner* joiner = nullptr;
    std::span<const glm::ivec2> slants = {};  ///< with a joiner, as Subdivision::joinedSlants
    int joinedWithin = 1;                     ///< with a joiner, as Subdivision::joinedWithin
    /// Leaves out blocks that the cone does not see. Not with holding.
    std::optional<SeenCone> seen = {};
    SlabLength slabLength = SlabLength::kByCounts;
};

/// Returns a volume's box in (slice, u, v) order after dividing or joining.
IndexBox boxOfSlices(const IndexBox& box, int sliceAxis, const Subdivision& parts);

/// Takes the differences of consecutive slices in one pass over the visible leaves, and cuts slices
/// into slabs (SlabPlanner). With `holds`, a voxel keeps its class while allowed, compared with its
/// true slot each time, so errors do not add up. Linear in the active voxels; deterministic;
/// multi-threaded.
PackedDeltas packDeltas(const Volume& volume, const PackOptions& options);

struct SlabRange {
    int first;
    int last;
};

/// Packs like packDeltas, or a few slabs at a time: one pass for the slabs and one per part.
class DeltaPacker {
  public:
    /// @param volume  must outlive this object
    DeltaPacker(const Volume& volume, const PackOptions& options);
    ~DeltaPacker();
    DeltaPacker(DeltaPacker&&) noexcept;

    /// Whether packing in parts is possible: no voxel is held, divided or painted.
    bool canBeParted() const;
    /// Upper bound of the bytes of all words, before they are counted.
    double mostBytes() const;
    PackedDeltas packAll();
    /// Like packAll() if words fit into `mostBytes`, else slabs without words. Needs canBeParted().
    /// @param mostBytes  also the limit of a part, unless the part is a single slab
    PackedDeltas packOrPlan(double mostBytes);
    /// The joiner, after packing: its looks are rounded as coarsely as necessary.
    const std::optional<SliceJoiner>& joiner() const;
    /// The parts to pack in increasing order, after packOrPlan() planned parts.
    const std::vector<SlabRange>& parts() const;
    /// Returns all slabs, with words for the slabs of a part.
    PackedDeltas pack(const SlabRange& part) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
