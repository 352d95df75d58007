// SPDX-License-Identifier: Apache-2.0
#include "delta/slice_mixer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace deltasplat {
namespace {

bool isEven(const CodeBook& book) {
    return book.kind == CodeBook::Kind::kInteger || book.kind == CodeBook::Kind::kLinear;
}

// Bits of a magnitude without the low ones, rounded to nearest.
std::uint64_t roundedBits(double magnitude, int dropped) {
    return (std::bit_cast<std::uint64_t>(magnitude) + (std::uint64_t{1} << (dropped - 1))) >>
           dropped;
}

}  // namespace

SliceMixer::SliceMixer(const Volume& volume, int perVoxel)
    : perVoxel_(perVoxel), levels_(volume), ownLevel_(kCodeCount) {
    levels_.codes = nullptr;
    levels_.source = nullptr;
    levels_.histogram.assign(kCodeCount, 0);
    const auto occurs = [](std::uint64_t count) { return count != 0; };
    const auto& histogram = volume.histogram;
    const auto lowest = std::find_if(histogram.begin(), histogram.end(), occurs);
    if (lowest == histogram.end()) return;
    const auto highest = std::find_if(histogram.rbegin(), histogram.rend(), occurs).base() - 1;
    if (isEven(volume.codeBook)) {
        makeEvenLevels(volume, int(lowest - histogram.begin()), int(highest - histogram.begin()));
    } else {
        makeRoundedLevels(volume);
    }
    for (int code = 0; code < kCodeCount; ++code) {
        if (histogram[code] != 0) ownLevel_[code] = mixCodes(Code(code), Code(code), 0);
    }
}

void SliceMixer::makeEvenLevels(const Volume& volume, int lowest, int highest) {
    const int span = highest - lowest;
    // Values mixed by halves and quarters fall on levels, if there are enough of them.
    const int wanted = 2 * perVoxel_;
    even_ = {Code(lowest), span == 0 ? 1 : std::min(wanted, (kCodeCount - 1) / span)};
    const auto last = std::ptrdiff_t{span} * even_.perCode;
    std::fill_n(levels_.histogram.begin(), last + 1, 1);
    CodeBook& book = levels_.codeBook;
    const double step = book.kind == CodeBook::Kind::kLinear ? book.step : 1;
    book.kind = CodeBook::Kind::kLinear;
    book.offset = volume.codeBook.valueOf(Code(lowest));
    book.step = step / even_.perCode;
}

// Chooses the number of bits so that there are levels enough for the magnitudes there are.
void SliceMixer::makeRoundedLevels(const Volume& volume) {
    rounded_.values.resize(kCodeCount);
    double least = std::numeric_limits<double>::max();
    double most = 0;
    bool negative = false;
    bool positive = false;
    for (int code = 0; code < kCodeCount; ++code) {
        if (volume.histogram[code] == 0) continue;
        const double value = volume.codeBook.valueOf(Code(code));
        rounded_.values[code] = value;
        if (value == 0) continue;
        (value < 0 ? negative : positive) = true;
        least = std::min(least, std::abs(value));
        most = std::max(most, std::abs(value));
    }
    std::vector<double> values{0.0};
    if (most > 0) {
        // A smaller share of a value than that is never mixed with 0.
        least = std::max(least / (2 * perVoxel_), std::numeric_limits<double>::min());
        const int sides = int{negative} + int{positive};
        const auto levelsOf = [&](int dropped) {
            return std::int64_t(roundedBits(most, dropped) - roundedBits(least, dropped)) + 1;
        };
        constexpr int kFewestDropped = 36;  // leaves 16 bits of the mantissa
        rounded_.dropped = kFewestDropped;
        while (sides * levelsOf(rounded_.dropped) + 1 > kCodeCount) ++rounded_.dropped;
        rounded_.first = roundedBits(least, rounded_.dropped);
        rounded_.most = int(levelsOf(rounded_.dropped));
        rounded_.zero = negative ? rounded_.most : 0;
        const int last = rounded_.zero + (positive ? rounded_.most : 0);
        values.clear();
        for (int level = 0; level <= last; ++level) values.push_back(valueOfLevel(level));
    }
    std::fill_n(levels_.histogram.begin(), values.size(), 1);
    levels_.codeBook = CodeBook::ofTable(std::move(values));
}

double SliceMixer::valueOfLevel(int level) const {
    if (level == rounded_.zero) return 0;
    const auto steps = std::uint64_t(std::abs(level - rounded_.zero) - 1);
    const double magnitude = std::bit_cast<double>((rounded_.first + steps) << rounded_.dropped);
    return level < rounded_.zero ? -magnitude : magnitude;
}

int SliceMixer::levelOfValue(double value) const {
    const double magnitude = std::abs(value);
    if (rounded_.most == 0) return rounded_.zero;
    const std::uint64_t bits = roundedBits(magnitude, rounded_.dropped);
    if (bits < rounded_.first) return rounded_.zero;
    const int steps = int(std::min<std::uint64_t>(bits - rounded_.first, rounded_.most - 1)) + 1;
    return value < 0 ? rounded_.zero - steps : rounded_.zero + steps;
}

// @param weight  of the other, in units of 1 / (2 perVoxel)
inline Code SliceMixer::mixCodes(Code here, Code other, int weight) const {
    const int whole = 2 * perVoxel_;
    if (even_.perCode != 0) {
        const int place =
            (whole - weight) * (here - even_.lowest) + weight * (other - even_.lowest);
        return Code((place * even_.perCode + perVoxel_) / whole);
    }
    const double a = rounded_.values[here];
    const double b = rounded_.values[other];
    return Code(levelOfValue(a + (b - a) * weight / whole));
}

void SliceMixer::mixSlice(const Slot* here, const Slot* other, int weight, const Slot* slotMap,
                          Slot* mixed) const {
    for (int n = 0; n < 64; ++n) {
        if (here[n] == kEmptySlot) {
            mixed[n] = kEmptySlot;
            continue;
        }
        const Code code = Code(here[n] - 1);
        const bool alone = other[n] == kEmptySlot || other[n] == here[n];
        const Code level = alone ? ownLevel_[code] : mixCodes(code, Code(other[n] - 1), weight);
        mixed[n] = slotMap[level + 1];
    }
}

void SliceMixer::mix(const Window& window, int part, std::span<const Slot> slotMap,
                     BlockSlots& mixed) const {
    for (int t = 0; t < 8; ++t) {
        const int thin = 8 * part + t;
        const int slice = thin / perVoxel_;
        // How far from the voxels' middle, in halves of a thin slice.
        const int offset = 2 * (thin % perVoxel_) + 1 - perVoxel_;
        const Slot* here = &window.slots[64 * std::size_t(slice)];
        const Slot* before = slice == 0 ? window.before.data() : here - 64;
        const Slot* behind = slice == 7 ? window.behind.data() : here + 64;
        mixSlice(here, offset < 0 ? before : behind, std::abs(offset), slotMap.data(),
                 &mixed[64 * std::size_t(t)]);
    }
}

}  // namespace deltasplat
