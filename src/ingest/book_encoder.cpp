// SPDX-License-Identifier: Apache-2.0
#include "ingest/book_encoder.h"

#include <openvdb/Types.h>

#include <bit>

#include "ingest/code_math.h"
#include "ingest/hash_place.h"

namespace deltasplat {

BookEncoder::BookEncoder(const CodeBook& book) : book_(book) {
    if (book.kind != CodeBook::Kind::kTable) return;
    const std::vector<double>& table = *book.table;
    places_.resize(4 * std::bit_ceil(table.size()), {0, -1});
    for (std::size_t code = 0; code < table.size(); ++code) {
        const auto bits = std::bit_cast<std::uint64_t>(table[code]);
        std::size_t at = hashPlace(bits, places_.size());
        while (places_[at].code >= 0) at = (at + 1) & (places_.size() - 1);
        places_[at] = {bits, std::int32_t(code)};
    }
}

Code BookEncoder::operator()(double value) const {
    switch (book_.kind) {
        case CodeBook::Kind::kHalf:
            return codeOfHalfBits(openvdb::math::half(float(value)).bits());
        case CodeBook::Kind::kTable:
            return tableCode(value);
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

}  // namespace deltasplat
