// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/code_book.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ingest/code_math.h"

namespace deltasplat {
namespace {

using Half = openvdb::math::half;

double halfValue(Code code) {
    Half half;
    half.setBits(halfBitsOfCode(code));
    return double(float(half));
}

Code nearestHalfCode(double value) {
    if (std::isnan(value)) return codeOfHalfBits(0x7e00);
    // Only an infinity becomes one: everything else has a nearest finite half.
    const double largest = 65504;
    if (std::isinf(value)) return codeOfHalfBits(value > 0 ? 0x7c00 : 0xfc00);
    if (std::fabs(value) >= largest) return codeOfHalfBits(value > 0 ? 0x7bff : 0xfbff);

    // A double rounded to float and then to half can miss the nearest half by one step.
    const Code code = codeOfHalfBits(Half(float(value)).bits());
    Code best = code;
    for (const Code other : {Code(code - 1), Code(code + 1)}) {
        const double otherValue = halfValue(other);
        if (std::fabs(otherValue - value) < std::fabs(halfValue(best) - value)) best = other;
    }
    return best;
}

Code nearestTableCode(const std::vector<double>& table, double value) {
    const auto above = std::lower_bound(table.begin(), table.end(), value);
    if (above == table.begin()) return 0;
    const auto index = std::size_t(above - table.begin());
    if (above == table.end()) return Code(index - 1);
    return Code(value - table[index - 1] < *above - value ? index - 1 : index);
}

}  // namespace

double CodeBook::valueOf(Code code) const {
    if (kind == Kind::kHalf) return halfValue(code);
    if (kind == Kind::kTable) return (*table)[std::min<std::size_t>(code, table->size() - 1)];
    return offset + step * double(code);
}

Code CodeBook::codeOf(double value) const {
    if (kind == Kind::kHalf) return nearestHalfCode(value);
    if (kind == Kind::kTable) return nearestTableCode(*table, value);
    return linearCode(value, offset, step);
}

bool CodeBook::standsFor(Code code, double value) const {
    const double within = kind == Kind::kLinear ? step / 2 : 0;
    return std::fabs(valueOf(code) - value) <= within;
}

std::string CodeBook::name() const {
    switch (kind) {
        case Kind::kInteger:
            return "integer";
        case Kind::kHalf:
            return "half";
        case Kind::kTable:
            return "table";
        case Kind::kLinear:
            break;
    }
    return "linear";
}

CodeBook CodeBook::integer(std::int64_t offset) {
    return {Kind::kInteger, double(offset), 1, nullptr};
}

CodeBook CodeBook::half() {
    return {Kind::kHalf, 0, 1, nullptr};
}

CodeBook CodeBook::linear(double low, double high, int bits) {
    if (!(high > low)) return {Kind::kLinear, low, 0, nullptr};
    // A step below the spacing of doubles would give neighbouring codes the same value.
    const double large = std::max(std::fabs(low), std::fabs(high));
    const double spacing = large - std::nextafter(large, 0.0);
    const double steps = double((1 << bits) - 1);
    if (low >= 0 || high <= 0)
        return {Kind::kLinear, low, std::max((high - low) / steps, spacing), nullptr};

    // What is empty is 0 more often than not: one step more leaves room to move 0 onto a code.
    const double step = std::max((high - low) / (steps - 1), spacing);
    return {Kind::kLinear, -step * std::ceil(-low / step), step, nullptr};
}

CodeBook CodeBook::ofTable(std::vector<double> values) {
    return {Kind::kTable, 0, 1, std::make_shared<const std::vector<double>>(std::move(values))};
}

}  // namespace deltasplat
