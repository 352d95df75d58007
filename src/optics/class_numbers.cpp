// SPDX-License-Identifier: Apache-2.0
#include "optics/class_numbers.h"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace deltasplat {

namespace {

// Returns what each class is called by the others, or nothing if they are not one to one.
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
    // A class without codes.
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
