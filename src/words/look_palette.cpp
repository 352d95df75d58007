// SPDX-License-Identifier: Apache-2.0
#include "words/look_palette.h"

namespace deltasplat {
namespace {

constexpr std::size_t kPlaces = std::size_t{1} << 17;

}  // namespace

LookPalette::LookPalette(std::size_t most) : most_(most), limit_(most), places_(kPlaces) {}

std::uint32_t LookPalette::numberOf(std::uint64_t key) {
    std::size_t at = hashPlace(key, kPlaces);
    for (; !hasTooMany(); at = (at + 1) % kPlaces) {
        Place& place = places_[at];
        std::uint64_t there = place.key.load(std::memory_order_acquire);
        if (there == 0 && place.key.compare_exchange_strong(there, key)) {
            const std::uint32_t number = ++count_;
            if (number > limit_) hasTooMany_ = true;
            place.number.store(number, std::memory_order_release);
            there = key;
        }
        if (there != key) continue;
        // The thread that took the place sets the number soon.
        std::uint32_t number = 0;
        while (number == 0) number = place.number.load(std::memory_order_acquire);
        return number > limit_ ? 0 : number;
    }
    return 0;
}

void LookPalette::limitTo(double share) {
    limit_ = std::size_t(share * double(most_));
    if (count_ > limit_) hasTooMany_ = true;
}

std::vector<std::uint64_t> LookPalette::keys() const {
    std::vector<std::uint64_t> keys(count_);
    for (const Place& place : places_)
        if (place.key != 0) keys[place.number - 1] = place.key;
    return keys;
}

}  // namespace deltasplat
