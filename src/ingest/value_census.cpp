// SPDX-License-Identifier: Apache-2.0
#include "ingest/value_census.h"

#include "ingest/readers.h"

namespace deltasplat {

void ValueCensus::append(const ValueCensus& next) {
    if (next.count == 0) return;
    min = count == 0 ? next.min : std::min(min, next.min);
    max = count == 0 ? next.max : std::max(max, next.max);
    count += next.count;
    half = half && next.half;
    whole = whole && next.whole;
    exact = exact && next.exact;
    distinct.append(next.distinct);
}

CodeBook chooseBook(const ValueCensus& census, bool real, std::optional<int> bits,
                    const std::string& where) {
    if (!real || !bits) {
        if (real && census.half) return CodeBook::half();
        const bool near = census.exact && census.max - census.min < kCodeCount;
        if (census.whole && near) return CodeBook::integer(std::int64_t(census.min));
        if (census.exact && !census.distinct.tooMany())
            return CodeBook::ofTable(census.distinct.sorted());
    }
    requireFiniteSpan(where, census.min, census.max);
    return CodeBook::linear(census.min, census.max, real ? bits.value_or(16) : 16);
}

}  // namespace deltasplat
