// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "deltasplat/optics/class_table.h"
#include "optics/voxel_painter.h"
#include "words/packed_deltas.h"

namespace deltasplat {

/// What the voxels of a word are seen as, of one plane of colours: premultiplied by the opacity
/// that their class has in a step.
struct LitWord {
    std::array<ClassTable::Color, 64> high;  ///< of those that are not visible 0
    std::array<ClassTable::Color, 64> low;   ///< likewise
    std::uint64_t any;                       ///< mask word of voxels with anything on the plane
    std::uint64_t anyLow;                    ///< with a low digit
};

/// What the voxels of words are seen as that have looks of their own: in two digits, on as many
/// planes as the thinnest and darkest of their classes need. Thread-safe.
class WordColors {
  public:
    /// @param deltas   must outlive the colours
    /// @param classes  of the words
    WordColors(const PackedDeltas& deltas, const ClassTable& classes,
               std::unique_ptr<const LookLight> light);

    /// Which planes and digits there are, and in which units; of classes there is the empty one.
    const ClassTable& table() const { return table_; }
    /// Lights a word.
    /// @param out  [planes]
    void light(std::size_t word, int slice,
               const std::array<LitWord*, ClassTable::kMaxPlanes>& out) const;

  private:
    const PackedDeltas* deltas_;
    std::unique_ptr<const LookLight> light_;
    ClassTable table_;
};

/// What the voxels of words are seen as in steps of one length, in digits.
class StepColors {
  public:
    /// @param deltas  must outlive the colours
    /// @param light   what own looks are seen as; null: they look as their classes do
    StepColors(const PackedDeltas& deltas, ClassTable classes,
               std::unique_ptr<const LookLight> light);
    /// Of classes alone: of looks that are seen from nowhere yet.
    explicit StepColors(ClassTable classes) : classes_(std::move(classes)) {}

    const ClassTable& classes() const { return classes_; }
    /// Which planes and digits there are, in which units, and of which colour, if of one; with own
    /// colours there are no others' to look up in it.
    const ClassTable& table() const { return own_ ? own_->table() : classes_; }
    /// Colours that voxels have of their own; null if they look as their classes do.
    const WordColors* own() const { return own_ ? &*own_ : nullptr; }

  private:
    ClassTable classes_;
    std::optional<WordColors> own_;
};

}  // namespace deltasplat
