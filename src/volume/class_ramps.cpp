// SPDX-License-Identifier: Apache-2.0
#include "volume/class_ramps.h"

#include <algorithm>

namespace deltasplat {

ClassRamps::ClassRamps(std::span<const Slot> classOfSlot, Code lowest, Code highest)
    : highest_(highest) {
    const auto classOf = [&](int code) { return int(classOfSlot[std::size_t(code) + 1]); };
    for (int code = lowest; code <= highest;) {
        const int own = classOf(code);
        int next = code + 1;
        const auto goOn = [&](int step) {
            for (; next <= highest && classOf(next) == classOf(next - 1) + step;) ++next;
            return next > code + 1;
        };
        Kind kind = Kind::kRises;
        if (own == 0) {
            kind = Kind::kNone;
            goOn(0);
        } else if (!goOn(1) && goOn(0)) {
            kind = Kind::kStays;
        }
        pieces_.push_back({Code(code), ClassIndex(own - code)});
        kinds_.push_back(kind);
        code = next;
    }
}

std::optional<ClassRamp> ClassRamps::of(Code lowest, Code highest) const {
    if (lowest < pieces_.front().begin || highest > highest_) return {};
    const auto behind =
        std::upper_bound(pieces_.begin(), pieces_.end(), lowest,
                         [](Code code, const RampPiece& piece) { return code < piece.begin; });
    auto begin = std::size_t(behind - pieces_.begin()) - 1;
    Code first = lowest;
    if (kinds_[begin] == Kind::kNone) {
        if (++begin == pieces_.size()) return {};
        first = pieces_[begin].begin;
        if (first > highest) return {};
    }
    std::size_t end = begin;
    Code last = highest;
    for (; end < pieces_.size() && pieces_[end].begin <= highest; ++end) {
        if (end - begin == kMostPieces || kinds_[end] == Kind::kNone) return {};
        if (kinds_[end] != Kind::kStays) continue;
        if (end + 1 < pieces_.size() && pieces_[end + 1].begin <= highest) return {};
        last = pieces_[end].begin;
    }
    // The range may begin behind the first code of a constant piece.
    return ClassRamp{std::min(first, last), last, std::span(pieces_).subspan(begin, end - begin)};
}

}  // namespace deltasplat
