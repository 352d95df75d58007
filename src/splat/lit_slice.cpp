// SPDX-License-Identifier: Apache-2.0
#include "splat/lit_slice.h"

namespace deltasplat {

void LitSlice::begin(int slice) {
    if (hasSlice_ && slice == slice_) return;
    hasSlice_ = true;
    slice_ = slice;
    const std::span<const DeltaWord> words = deltas_.slice(slice);
    first_ = std::size_t(words.data() - deltas_.words.data());
    placeOf_.assign(words.size(), kUnlit);
    used_ = 0;
}

const LitWord& LitSlice::of(std::size_t word, int plane) {
    std::uint32_t& place = placeOf_[word - first_];
    if (place == kUnlit) {
        const std::size_t planes = colors_.table().planes.size();
        place = std::uint32_t(used_);
        used_ += planes;
        while (lit_.size() < used_) lit_.emplace_back();
        std::array<LitWord*, ClassTable::kMaxPlanes> out{};
        for (std::size_t p = 0; p < planes; ++p) out[p] = &lit_[place + p];
        colors_.light(word, slice_, out);
    }
    return lit_[place + std::size_t(plane)];
}

}  // namespace deltasplat
