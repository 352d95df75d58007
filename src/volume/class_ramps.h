// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/slot.h"
#include "volume/code_math.h"

namespace deltasplat {

/// A run of codes, from `begin` on, whose class rises by one per code.
struct RampPiece {
    Code begin;
    ClassIndex shift;  ///< class minus code, modulo 2^16
};

/// Classes as arithmetic: 0 below `first`, then consecutive pieces; above `last` that of `last`.
struct ClassRamp {
    Code first;
    Code last;
    std::span<const RampPiece> pieces;  ///< in increasing order; first `begin` unused
};

/// Finds ramps in a class map, as transfer functions make them, to replace 512 lookups per block by
/// a few vectors. Several pieces per ramp, because classes of dark colours come after the others.
class ClassRamps {
  public:
    /// @param classOfSlot     [kSlotCount]
    /// @param lowest,highest  range of codes that calls of of() stay within
    ClassRamps(std::span<const Slot> classOfSlot, Code lowest, Code highest);

    /// Returns a ramp that points into this object; nothing if the range is no ramp of few pieces.
    std::optional<ClassRamp> of(Code lowest, Code highest) const;

  private:
    static constexpr int kMostPieces = 8;
    enum class Kind { kNone, kRises, kStays };

    Code highest_;
    // Pieces in increasing order of code. A constant stretch is one piece, begun by its first code.
    std::vector<RampPiece> pieces_;
    std::vector<Kind> kinds_;  // [piece]
};

}  // namespace deltasplat
