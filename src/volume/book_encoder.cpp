// SPDX-License-Identifier: Apache-2.0
#include "volume/book_encoder.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "volume/code_math.h"
#include "volume/distinct_values.h"

namespace deltasplat {

namespace {

constexpr int kStretchBits = 17;

// Numbers stretches of the floats in increasing order, 256 an octave. What is beyond the floats is
// in the outermost.
std::size_t stretchOf(double value) {
    return orderOfBits(std::bit_cast<std::uint32_t>(float(value))) >> (32 - kStretchBits);
}

}  // namespace

BookEncoder::BookEncoder(const CodeBook& book) : book_(book) {
    if (!book.table) return;
    book.isExact() ? makePlaces() : makeStretches();
}

void BookEncoder::makePlaces() {
    const std::vector<double>& table = *book_.table;
    places_.resize(4 * std::bit_ceil(table.size()), {0, -1});
    for (std::size_t code = 0; code < table.size(); ++code) {
        const auto bits = std::bit_cast<std::uint64_t>(table[code]);
        std::size_t at = hashPlace(bits, places_.size());
        while (places_[at].code >= 0) at = (at + 1) & (places_.size() - 1);
        places_[at] = {bits, std::int32_t(code)};
    }
}

void BookEncoder::makeStretches() {
    const std::vector<double>& table = *book_.table;
    stretches_.assign((std::size_t{1} << kStretchBits) + 1, {std::int32_t(table.size()), 0});
    std::size_t stretch = 0;
    for (std::size_t code = 0; code < table.size(); ++code) {
        for (const std::size_t own = stretchOf(table[code]); stretch <= own; ++stretch)
            stretches_[stretch].first = std::int32_t(code);
    }
    for (std::size_t i = 0; i + 1 < stretches_.size(); ++i) {
        const double* first = table.data() + stretches_[i].first;
        const std::int32_t steps = stretches_[i + 1].first - stretches_[i].first - 1;
        if (steps < 1) continue;
        const auto perUnit = float(steps / (first[steps] - *first));
        // Between denormals there may be no such number.
        if (std::isfinite(perUnit)) stretches_[i].codesPerUnit = perUnit;
    }
}

Code BookEncoder::operator()(double value) const {
    switch (book_.kind) {
        case CodeBook::Kind::kHalf:
            return codeOfHalfBits(openvdb::math::half(float(value)).bits());
        case CodeBook::Kind::kTable:
        case CodeBook::Kind::kPieces:
            return places_.empty() ? nearestCode(value) : tableCode(value);
        default:
            return linearCode(value, book_.offset, book_.step);
    }
}

Code BookEncoder::tableCode(double value) const {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    std::size_t at = hashPlace(bits, places_.size());
    while (places_[at].code >= 0 && places_[at].bits != bits) at = (at + 1) & (places_.size() - 1);
    return places_[at].code >= 0 ? Code(places_[at].code) : book_.codeOf(value);
}

// Returns the first code whose value is not below `value`, as std::lower_bound would. Steps within
// a stretch are mostly alike, which says where to look.
std::size_t BookEncoder::firstNotBelow(double value) const {
    const double* table = book_.table->data();
    const Stretch& stretch = stretches_[stretchOf(value)];
    const std::int32_t first = stretch.first;
    const std::int32_t last = (&stretch)[1].first;
    if (first == last) return std::size_t(first);
    const double steps = (value - table[first]) * double(stretch.codesPerUnit);
    std::int32_t code = first + std::int32_t(std::clamp(steps, 0.0, double(last - first)));
    for (int tries = 0; tries < 4; ++tries) {
        if (code > first && !(table[code - 1] < value)) {
            --code;
        } else if (code < last && table[code] < value) {
            ++code;
        } else {
            return std::size_t(code);
        }
    }
    return std::size_t(std::lower_bound(table + first, table + last, value) - table);
}

// As CodeBook::codeOf, which looks through the whole table.
Code BookEncoder::nearestCode(double value) const {
    const std::vector<double>& table = *book_.table;
    const std::size_t code = firstNotBelow(value);
    if (code == 0) return 0;
    if (code == table.size()) return Code(code - 1);
    return Code(value - table[code - 1] < table[code] - value ? code - 1 : code);
}

}  // namespace deltasplat
