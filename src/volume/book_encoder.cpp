// SPDX-License-Identifier: Apache-2.0
#include "volume/book_encoder.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "deltasplat/ingest/code_book.h"
#include "volume/code_math.h"
#include "volume/value_census.h"

namespace deltasplat {

namespace {

constexpr int kStretchBits = 17;

// Numbers stretches of the floats in increasing order, 256 per octave; the outermost go on.
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
        // Between denormals the quotient may be infinite.
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

// Returns the first code whose value is not below `value`, like std::lower_bound. Steps within a
// stretch are mostly equal, so an estimate finds the code.
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

// Like CodeBook::codeOf, without a search of the whole table.
Code BookEncoder::nearestCode(double value) const {
    const std::vector<double>& table = *book_.table;
    const std::size_t code = firstNotBelow(value);
    if (code == 0) return 0;
    if (code == table.size()) return Code(code - 1);
    return Code(value - table[code - 1] < table[code] - value ? code - 1 : code);
}

namespace {

using Half = openvdb::math::half;

double halfValue(Code code) {
    Half half;
    half.setBits(halfBitsOfCode(code));
    return double(float(half));
}

Code nearestHalfCode(double value) {
    if (std::isnan(value)) return codeOfHalfBits(0x7e00);
    // Only an infinity becomes an infinite half. Other values have a nearest finite half.
    const double largest = 65504;
    if (std::isinf(value)) return codeOfHalfBits(value > 0 ? 0x7c00 : 0xfc00);
    if (std::fabs(value) >= largest) return codeOfHalfBits(value > 0 ? 0x7bff : 0xfbff);

    // Rounding a double to float and then to half can miss the nearest half by one step.
    const Code code = codeOfHalfBits(Half(float(value)).bits());
    Code best = code;
    for (const Code other : {Code(code - 1), Code(code + 1)}) {
        const double otherValue = halfValue(other);
        if (std::fabs(otherValue - value) < std::fabs(halfValue(best) - value)) best = other;
    }
    return best;
}

double roundedUp(double step, int significantBits) {
    int exponent = 0;
    const double mantissa = std::frexp(step, &exponent);
    return std::ldexp(std::ceil(std::ldexp(mantissa, significantBits)), exponent - significantBits);
}

// The most significant bits of a step, 8 at most, so that multiples to `large` are numbers.
int significantBitsOf(double step, double large, CodeBook::Values values) {
    const int digits = values == CodeBook::Values::kFloat ? std::numeric_limits<float>::digits
                                                          : std::numeric_limits<double>::digits;
    const int multiple = std::ilogb(large / step + 2) + 1;
    return std::clamp(digits - multiple, 1, 8);
}

double roundedDown(double value, CodeBook::Values kind) {
    using Values = CodeBook::Values;
    if (kind == Values::kWhole) return std::floor(value);
    if (kind == Values::kDouble || value > double(std::numeric_limits<float>::max())) return value;
    const auto rounded = float(value);
    return double(rounded) <= value ? double(rounded) : double(std::nextafter(rounded, 0.0f));
}

Code nearestTableCode(const std::vector<double>& table, double value) {
    const auto above = std::lower_bound(table.begin(), table.end(), value);
    if (above == table.begin()) return 0;
    const auto index = std::size_t(above - table.begin());
    if (above == table.end()) return Code(index - 1);
    return Code(value - table[index - 1] < *above - value ? index - 1 : index);
}

// Returns half of the largest step next to the code. Values between two pieces go to the nearer
// piece, so the code may have the step of either.
double pieceError(const std::vector<CodeBook::Piece>& pieces, Code code) {
    std::size_t i = 0;
    int first = 0;
    while (i + 1 < pieces.size() && first + pieces[i].count <= int(code))
        first += pieces[i++].count;
    double step = pieces[i].step;
    if (int(code) == first && i > 0) step = std::max(step, pieces[i - 1].step);
    if (int(code) == first + pieces[i].count - 1 && i + 1 < pieces.size())
        step = std::max(step, pieces[i + 1].step);
    return step / 2;
}

}  // namespace

double CodeBook::valueOf(Code code) const {
    if (kind == Kind::kHalf) return halfValue(code);
    if (table) return (*table)[std::min<std::size_t>(code, table->size() - 1)];
    return offset + step * double(code);
}

Code CodeBook::codeOf(double value) const {
    if (kind == Kind::kHalf) return nearestHalfCode(value);
    if (table) return nearestTableCode(*table, value);
    return linearCode(value, offset, step);
}

double CodeBook::largestErrorOf(Code code) const {
    if (kind == Kind::kLinear) return step / 2;
    if (kind == Kind::kPieces) return pieceError(*pieces, code);
    // The error is a share of the source's value, which may be smaller than the code's value.
    if (relativeError > 0) return relativeError / (1 - relativeError) * std::fabs(valueOf(code));
    return 0;
}

bool CodeBook::standsFor(Code code, double value) const {
    return std::fabs(valueOf(code) - value) <= largestErrorOf(code);
}

std::string CodeBook::name() const {
    switch (kind) {
        case Kind::kInteger:
            return "integer";
        case Kind::kHalf:
            return "half";
        case Kind::kTable:
            return "table";
        case Kind::kPieces:
            return "pieces";
        case Kind::kLinear:
            break;
    }
    return "linear";
}

CodeBook CodeBook::integer(std::int64_t offset) {
    return {Kind::kInteger, double(offset), 1, nullptr, 0};
}

CodeBook CodeBook::half() {
    return {Kind::kHalf, 0, 1, nullptr, 0};
}

CodeBook CodeBook::linear(double low, double high, int bits, Values values) {
    if (!(high > low)) return {Kind::kLinear, low, 0, nullptr, 0};
    // A step below the spacing of values would give neighbouring codes the same value.
    const double large = std::max(std::fabs(low), std::fabs(high));
    const double spacing = spacingBelow(large, values);
    const double steps = double((1 << bits) - 1);
    if (values == Values::kWhole) {
        const double step = std::max(std::ceil((high - low) / steps), spacing);
        return {Kind::kLinear, low, step, nullptr, 0};
    }
    for (const double parts : {steps, steps - 1}) {
        const double least = std::max((high - low) / parts, spacing);
        const double step = roundedUp(least, significantBitsOf(least, large, values));
        const double offset = step * std::floor(low / step);
        if (offset + step * steps >= high) return {Kind::kLinear, offset, step, nullptr, 0};
    }
    return {Kind::kLinear, low, std::max((high - low) / steps, spacing), nullptr, 0};
}

CodeBook CodeBook::ofTable(std::vector<double> values) {
    return {Kind::kTable, 0, 1, std::make_shared<const std::vector<double>>(std::move(values)), 0};
}

CodeBook CodeBook::ofPieces(std::vector<Piece> pieces) {
    std::vector<double> values;
    for (const Piece& piece : pieces) {
        for (int rung = 0; rung < piece.count; ++rung)
            values.push_back(piece.first + piece.step * rung);
    }
    CodeBook book = ofTable(std::move(values));
    book.kind = Kind::kPieces;
    book.pieces = std::make_shared<const std::vector<Piece>>(std::move(pieces));
    return book;
}

std::optional<CodeBook> CodeBook::relative(const Range& range, double error) {
    // The middle of two neighbours is farthest from both, so the ratio of neighbours must be at
    // most (1 + error) / (1 - error). A little less leaves room for rounding.
    const double ratio = 1 + (2 * error / (1 - error)) * (1 - 1e-6);
    const auto magnitudes = [&](double largest) {
        std::vector<double> values;
        double value = range.least;
        while (values.size() < std::size_t(kCodeCount)) {
            values.push_back(std::min(value, largest));
            if (!(value < largest)) break;
            value =
                std::max(roundedDown(value * ratio, range.values), nextAbove(value, range.values));
        }
        return values;
    };
    std::vector<double> table;
    if (range.low < 0) table = magnitudes(-range.low);
    std::reverse(table.begin(), table.end());
    for (double& value : table) value = -value;
    table.push_back(0);
    if (range.high > 0) {
        const std::vector<double> above = magnitudes(range.high);
        table.insert(table.end(), above.begin(), above.end());
    }
    if (table.size() > std::size_t(kCodeCount)) return std::nullopt;
    CodeBook book = ofTable(std::move(table));
    book.relativeError = error;
    return book;
}

}  // namespace deltasplat
