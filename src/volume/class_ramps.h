// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/slot.h"
#include "volume/code_math.h"

namespace deltasplat {

/// Codes from a first one on whose classes go up by one with each.
struct RampPiece {
    Code begin;
    ClassIndex shift;  ///< a code's class less the code, modulo 2^16
};

/// Classes of a range of codes as arithmetic has them: none before the first, then those of pieces,
/// one behind the other, up to the last, whose class all behind it have.
struct ClassRamp {
    Code first;
    Code last;
    std::span<const RampPiece> pieces;  ///< in increasing order; the first one's begin is of no use
};

/// Finds ramps in a map of classes, as transfer functions make them over the codes of a block: a
/// few vectors work out what 512 voxels would have to look up. Not one piece but some, for classes
/// of dark colours come behind the others.
class ClassRamps {
  public:
    /// @param classOfSlot     [kSlotCount]
    /// @param lowest,highest  codes that may be asked for
    ClassRamps(std::span<const Slot> classOfSlot, Code lowest, Code highest);

    /// Returns what codes from `lowest` to `highest` have, as long as this is there; nothing if it
    /// is no ramp of few pieces.
    std::optional<ClassRamp> of(Code lowest, Code highest) const;

  private:
    static constexpr int kMostPieces = 8;
    enum class Kind { kNone, kRises, kStays };

    Code highest_;
    // Of what codes are from the first asked for on, in increasing order. What stays is a piece of
    // one code, and others of its class.
    std::vector<RampPiece> pieces_;
    std::vector<Kind> kinds_;  // [piece]
};

}  // namespace deltasplat
