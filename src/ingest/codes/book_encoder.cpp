// SPDX-License-Identifier: Apache-2.0
#include "ingest/codes/book_encoder.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <bit>

#include "ingest/codes/code_math.h"
#include "ingest/values/hash_place.h"

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
    book.isExact() ? makePlaces() : makeFirsts();
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

void BookEncoder::makeFirsts() {
    const std::vector<double>& table = *book_.table;
    firsts_.assign((std::size_t{1} << kStretchBits) + 1, std::int32_t(table.size()));
    std::size_t stretch = 0;
    for (std::size_t code = 0; code < table.size(); ++code) {
        for (const std::size_t own = stretchOf(table[code]); stretch <= own; ++stretch)
            firsts_[stretch] = std::int32_t(code);
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

// As CodeBook::codeOf, which looks through the whole table.
Code BookEncoder::nearestCode(double value) const {
    const std::vector<double>& table = *book_.table;
    const std::size_t stretch = stretchOf(value);
    const auto above = std::lower_bound(table.begin() + firsts_[stretch],
                                        table.begin() + firsts_[stretch + 1], value);
    if (above == table.begin()) return 0;
    const auto code = std::size_t(above - table.begin());
    if (above == table.end()) return Code(code - 1);
    return Code(value - table[code - 1] < *above - value ? code - 1 : code);
}

}  // namespace deltasplat
