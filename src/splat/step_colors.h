// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "deltasplat/optics/class_table.h"
#include "optics/voxel_painter.h"
#include "splat/word_colors.h"

namespace deltasplat {

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
