// SPDX-License-Identifier: Apache-2.0
#include "optics/color_digits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace deltasplat {

namespace {

constexpr double kFiner = double(1 << ClassTable::kPlaneBits);
static_assert(kLeastUnits == kLeastOfPlane / kFiner);

// As std::round() for x in [0, 2^53), without a call.
std::int64_t rounded(double x) {
    const auto cut = std::int64_t(x);
    return cut + (x - double(cut) >= 0.5 ? 1 : 0);
}

double nearest(double units) {
    return double(std::min(rounded(units), std::int64_t{ClassTable::kMax}));
}

// The relative error of rounding to one digit.
double errorOf(double units) {
    return (nearest(units) - units) / std::max(units, kLeastUnits);
}

// Fog of any depth then errs by at most a voxel in alpha and colour (thin) or their ratio (dense).
bool oneDigitIsEnough(const glm::dvec4& units) {
    const double alpha = errorOf(units.a);
    if (std::abs(alpha) > kColorShare) return false;
    for (int c = 0; c < 3; ++c) {
        if (units[c] == units.a) continue;  // same error as alpha
        const double color = errorOf(units[c]);
        const bool seen = units[c] >= kLeastUnits;
        if (std::abs(color) > kColorShare) return false;
        if (seen && std::abs(color - alpha) > kColorShare) return false;
    }
    return true;
}

void writeChannel(double units, int c, ColorDigits& digits) {
    std::size_t high = 0;
    if (units < kLeastOfPlane) {
        units *= kFiner;
        high = 2;
    }
    constexpr double kLow = double(1 << ClassTable::kDigitBits);
    const std::int64_t whole = rounded(units * kLow);
    digits[high][c] = std::int16_t(whole >> ClassTable::kDigitBits);
    digits[high + 1][c] = std::int16_t(whole & ClassTable::kMax);
}

}  // namespace

ColorDigits digitsOf(const glm::dvec4& units) {
    ColorDigits digits{};
    if (oneDigitIsEnough(units)) {
        for (int c = 0; c < 4; ++c) digits[0][c] = std::int16_t(nearest(units[c]));
    } else {
        for (int c = 0; c < 4; ++c) writeChannel(units[c], c, digits);
    }
    return digits;
}

glm::dvec4 unitsOf(const ColorDigits& digits) {
    constexpr double kOne[] = {1, 1.0 / (1 << ClassTable::kDigitBits)};
    glm::dvec4 units(0.0);
    for (std::size_t i = 0; i < digits.size(); ++i) {
        const double one = kOne[i % 2] / (i < 2 ? 1 : kFiner);
        for (int c = 0; c < 4; ++c) units[c] += one * digits[i][std::size_t(c)];
    }
    return units;
}

unsigned usedDigits(const ColorDigits& digits) {
    unsigned used = 0;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (std::bit_cast<std::uint64_t>(digits[i]) != 0) used |= 1u << i;
    }
    return used;
}

namespace {

// Returns the number in `others` of each class; nothing if the two tables are not one to one.
std::optional<std::vector<Slot>> othersNumbers(std::span<const Slot> others,
                                               const ClassTable& table) {
    constexpr Slot kNone = ClassTable::kMaxClasses;
    const std::span<const Slot> owns = table.classOfSlot();
    if (others.size() != owns.size()) return {};
    std::vector<Slot> numbers(table.size(), kNone);
    std::vector<Slot> back(table.size(), kNone);
    numbers[0] = back[0] = 0;
    for (std::size_t slot = 0; slot < others.size(); ++slot) {
        const Slot own = owns[slot];
        const Slot other = others[slot];
        if (std::size_t(other) >= back.size()) return {};
        Slot& number = numbers[std::size_t(own)];
        Slot& from = back[std::size_t(other)];
        if (number == kNone && from == kNone) {
            number = other;
            from = own;
        }
        if (number != other || from != own) return {};
    }
    if (std::find(numbers.begin(), numbers.end(), kNone) != numbers.end()) return {};
    return numbers;
}

template <typename T>
void permute(const std::vector<Slot>& numbers, std::vector<T>& entries) {
    std::vector<T> permuted(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) permuted[std::size_t(numbers[i])] = entries[i];
    entries = std::move(permuted);
}

}  // namespace

bool noteUse(ClassTable::Digit& digit) {
    const auto isUsed = [](const ClassTable::Color& color) { return color != ClassTable::Color{}; };
    const auto& all = digit.colors;
    const auto first = std::find_if(all.begin(), all.end(), isUsed);
    if (first == all.end()) return false;
    digit.first = int(first - all.begin());
    digit.last = int(std::find_if(all.rbegin(), all.rend(), isUsed).base() - all.begin());
    return true;
}

bool takeNumbers(const ClassTable& others, ClassTable& table) {
    if (std::ranges::equal(table.classOfSlot(), others.classOfSlot())) {
        table.slots = others.slots;
        return true;
    }
    const std::optional<std::vector<Slot>> numbers = othersNumbers(others.classOfSlot(), table);
    if (!numbers) return false;
    table.slots = others.slots;
    permute(*numbers, table.looks);
    for (ClassTable::Plane& plane : table.planes) {
        for (ClassTable::Digit* digit : {&plane.high, &plane.low}) {
            if (digit->colors.empty()) continue;
            permute(*numbers, digit->colors);
            noteUse(*digit);
        }
    }
    return true;
}

}  // namespace deltasplat
