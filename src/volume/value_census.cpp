// SPDX-License-Identifier: Apache-2.0
#include "volume/value_census.h"

#include <algorithm>
#include <cmath>

#include "volume/volume_checks.h"

namespace deltasplat {

void ValueCensus::append(const ValueCensus& next) {
    if (next.count == 0) return;
    min = count == 0 ? next.min : std::min(min, next.min);
    max = count == 0 ? next.max : std::max(max, next.max);
    if (least == 0 || (next.least > 0 && next.least < least)) least = next.least;
    count += next.count;
    half = half && next.half;
    whole = whole && next.whole;
    exact = exact && next.exact;
    floats = floats && next.floats;
    ints = ints && next.ints;
    rounding = std::max(rounding, next.rounding);
    distinct.append(next.distinct);
    survey.append(next.survey);
}

double bulkMagnitude(const ValueCensus& census) {
    const std::vector<ValueCell> cells = census.survey.cells();
    if (cells.empty()) return 0;
    const glm::dvec2 bulk = bulkOf(cells, census.frequent);
    return kBulkNeed / kRelativeNeed * (bulk.y - bulk.x);
}

namespace {

CodeBook::Values kindOf(const ValueCensus& census, bool real) {
    if (!real) return CodeBook::Values::kWhole;
    return census.floats ? CodeBook::Values::kFloat : CodeBook::Values::kDouble;
}

}  // namespace

std::optional<CodeBook> plainBook(const ValueCensus& census, bool real) {
    if (real && census.half) return CodeBook::half();
    constexpr double kMostInteger = 0x1p62;  // more than that, no offset holds
    const bool near = census.exact && census.max - census.min < kCodeCount &&
                      std::max(std::abs(census.min), std::abs(census.max)) <= kMostInteger;
    if (census.whole && near) return CodeBook::integer(std::int64_t(census.min));
    return {};
}

CodeBook chooseBook(const ValueCensus& census, bool real, const ReadOptions& reading,
                    const std::string& where) {
    const bool linear = real && reading.bits;
    if (!linear) {
        if (const std::optional<CodeBook> plain = plainBook(census, real)) return *plain;
        if (census.exact && !census.distinct.tooMany())
            return CodeBook::ofTable(census.distinct.sorted());
    }
    requireFiniteSpan(where, census.min, census.max);
    if (!linear && reading.relativeError) {
        const CodeBook::Range range{census.min, census.max, census.least, kindOf(census, real)};
        // Finer steps than asked for leave a tolerance room for holding values.
        for (const double error : {*reading.relativeError / 4, *reading.relativeError}) {
            const auto book = CodeBook::relative(range, error);
            if (book) return *book;
        }
    }
    if (linear)
        return CodeBook::linear(census.min, census.max, *reading.bits, kindOf(census, real));
    return fitBook(census.survey.cells(), census.frequent, kindOf(census, real));
}

}  // namespace deltasplat
