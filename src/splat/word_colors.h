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

/// Colours of a word's voxels on one plane, premultiplied by the opacity of their class in a step.
struct LitWord {
    std::array<ClassTable::Color, 64> high;  ///< 0 for invisible voxels
    std::array<ClassTable::Color, 64> low;   ///< likewise
    std::uint64_t any;                       ///< mask word of voxels with anything on the plane
    std::uint64_t anyLow;                    ///< of voxels with a low digit
};

/// Own looks' colours, on as many planes as the thinnest and darkest need. Thread-safe.
class WordColors {
  public:
    /// @param classes  of the words
    WordColors(const PackedDeltas& deltas, const ClassTable& classes,
               std::unique_ptr<const LookLight> light);

    /// Planes, digits and units; the only class is the empty one.
    const ClassTable& table() const { return table_; }
    /// @param out  [planes]
    void light(std::size_t word, int slice,
               const std::array<LitWord*, ClassTable::kMaxPlanes>& out) const;

  private:
    const PackedDeltas* deltas_;
    std::unique_ptr<const LookLight> light_;
    ClassTable table_;
};

/// Colours of voxels in steps of one length, in digits.
class StepColors {
  public:
    /// @param deltas  must outlive the colours
    /// @param light   colours of own looks; null: colours of classes
    StepColors(const PackedDeltas& deltas, ClassTable classes,
               std::unique_ptr<const LookLight> light);
    /// For classes only: looks without a camera.
    explicit StepColors(ClassTable classes) : classes_(std::move(classes)) {}

    const ClassTable& classes() const { return classes_; }
    /// Planes, digits, units, and the colour, if there is one; own colours are not in it.
    const ClassTable& table() const { return own_ ? own_->table() : classes_; }
    /// Colours of voxels' own looks; null: classes' colours.
    const WordColors* own() const { return own_ ? &*own_ : nullptr; }

  private:
    ClassTable classes_;
    std::optional<WordColors> own_;
};

}  // namespace deltasplat
