// SPDX-License-Identifier: Apache-2.0
#include "volume/value_census.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
    constexpr double kMostInteger = 0x1p62;  // a larger offset has no exact integer
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
        // Finer steps than asked for leave room for a tolerance that holds values.
        for (const double error : {*reading.relativeError / 4, *reading.relativeError}) {
            const auto book = CodeBook::relative(range, error);
            if (book) return *book;
        }
    }
    if (linear)
        return CodeBook::linear(census.min, census.max, *reading.bits, kindOf(census, real));
    return fitBook(census.survey.cells(), census.frequent, kindOf(census, real));
}

void ValueSurvey::open(std::size_t key, double value) {
    cells_.push_back({value, value, 0});
    keys_.push_back(std::uint16_t(key));
    cellOfKey_[key] = std::uint16_t(cells_.size());
}

void ValueSurvey::append(const ValueSurvey& other) {
    if (cellOfKey_.empty()) cellOfKey_.assign(kKeys, 0);
    for (std::size_t i = 0; i < other.cells_.size(); ++i) {
        const ValueCell& more = other.cells_[i];
        const std::size_t key = other.keys_[i];
        if (cellOfKey_[key] == 0) open(key, more.low);
        ValueCell& cell = cells_[cellOfKey_[key] - std::size_t{1}];
        cell.low = std::min(cell.low, more.low);
        cell.high = std::max(cell.high, more.high);
        cell.count += more.count;
    }
}

std::vector<ValueCell> ValueSurvey::cells() const {
    std::vector<ValueCell> sorted = cells_;
    std::sort(sorted.begin(), sorted.end(),
              [](const ValueCell& a, const ValueCell& b) { return a.low < b.low; });
    return sorted;
}

namespace {

// Slightly below the promise, because values between two ladders may have the coarser step.
constexpr double kRoom = 0.99;
constexpr double kRelative = kRelativeNeed * kRoom;

// Allowed error: scale * max(least, min(kRelative * |value|, cap)); the cap only within the bulk.
struct Allowed {
    double least = 0;
    double cap = std::numeric_limits<double>::infinity();
    double scale = 1;
};

// A range of close values of one sign with the same allowed error.
struct Stretch {
    double low = 0;
    double high = 0;
    bool inBulk = false;
    bool frequent = false;  // a single value that gets a code of its own

    double leastMagnitude() const {
        return low <= 0 && high >= 0 ? 0 : std::min(std::fabs(low), std::fabs(high));
    }
    double error(const Allowed& allowed) const {
        const double relative = kRelative * leastMagnitude();
        const double wanted = inBulk ? std::min(relative, allowed.cap) : relative;
        return allowed.scale * std::max(wanted, allowed.least);
    }
};

// Cuts a cell at its frequent values, which become stretches of their own.
void addCell(const ValueCell& cell, const std::vector<double>& frequent, glm::dvec2 bulk,
             CodeBook::Values kind, std::vector<Stretch>& stretches) {
    const bool inBulk = cell.high >= bulk.x && cell.low <= bulk.y;
    double low = cell.low;
    for (const double value : frequent) {
        if (value < low || value > cell.high) continue;
        if (value > low) stretches.push_back({low, nextBelow(value, kind), inBulk, false});
        stretches.push_back({value, value, inBulk, true});
        low = nextAbove(value, kind);
    }
    if (low <= cell.high) stretches.push_back({low, cell.high, inBulk, false});
}

// Lays ladders along stretches in increasing order.
class LadderBuilder {
  public:
    explicit LadderBuilder(CodeBook::Values kind) : kind_(kind) {}

    /// @param below  upper limit of the rungs, exclusive
    void add(const Stretch& stretch, const Allowed& allowed, double below) {
        const double width = 2 * stretch.error(allowed);
        if (stretch.high - stretch.low <= width) {
            const double middle = nearestOf(0.5 * stretch.low + 0.5 * stretch.high, kind_);
            const double rung = std::clamp(middle, stretch.low, stretch.high);
            return addPiece({rung, 2 * std::max(rung - stretch.low, stretch.high - rung), 1});
        }
        const double large = std::max(std::fabs(stretch.low), std::fabs(stretch.high));
        const double step = stepBelow(width, large, kind_);
        const double first = std::floor(stretch.low / step);
        const double last = std::ceil(stretch.high / step);
        // A rung may lie a little outside of its stretch if there is room.
        const bool room = last * step < below && last * step <= largestOf(kind_) &&
                          first * step >= -largestOf(kind_);
        room ? addLadder(first, last, step) : addEnds(stretch, step);
    }

    int codes() const { return codes_; }
    std::vector<CodeBook::Piece> take() { return std::move(pieces_); }

  private:
    // Adds the stretch's ends and the rungs strictly between them.
    void addEnds(const Stretch& stretch, double step) {
        addPiece({stretch.low, step, 1});
        const double first = std::floor(stretch.low / step) + 1;
        const double last = std::ceil(stretch.high / step) - 1;
        if (first <= last) addLadder(first, last, step);
        addPiece({stretch.high, step, 1});
    }

    void addLadder(double first, double last, double step) {
        if (!pieces_.empty() && first * step <= highest_) first = std::floor(highest_ / step) + 1;
        if (!pieces_.empty() && first * step <= highest_) ++first;
        if (first > last) return;
        CodeBook::Piece* const before = pieces_.empty() ? nullptr : &pieces_.back();
        const auto rungs = int(std::min(last - first + 1, 1e9));
        if (before && before->step == step &&
            before->first + before->step * before->count == first * step) {
            before->count += rungs;
            codes_ = std::min(codes_ + rungs, kMany);
            highest_ = last * step;
            return;
        }
        addPiece({first * step, step, rungs});
    }

    void addPiece(const CodeBook::Piece& piece) {
        if (!pieces_.empty() && piece.first <= highest_) return;
        pieces_.push_back(piece);
        codes_ = std::min(codes_ + piece.count, kMany);
        highest_ = piece.first + piece.step * (piece.count - 1);
    }

    static constexpr int kMany = 1 << 30;
    CodeBook::Values kind_;
    std::vector<CodeBook::Piece> pieces_;
    double highest_ = 0;  // highest rung so far
    int codes_ = 0;
};

LadderBuilder build(const std::vector<Stretch>& stretches, CodeBook::Values kind,
                    const Allowed& allowed) {
    LadderBuilder builder(kind);
    for (std::size_t i = 0; i < stretches.size() && builder.codes() <= kCodeCount; ++i) {
        const bool bounded = i + 1 < stretches.size() && stretches[i + 1].frequent;
        builder.add(stretches[i], allowed,
                    bounded ? stretches[i + 1].low : std::numeric_limits<double>::infinity());
    }
    return builder;
}

// Magnitudes below which the named share of the values lies, without 0 and frequent values.
struct Magnitudes {
    double least = 0;
    double hundredth = 0;
    double tenth = 0;
    double largest = 0;
};

Magnitudes magnitudesOf(std::vector<ValueCell> cells) {
    std::erase_if(cells, [](const ValueCell& cell) { return cell.count == 0; });
    const auto magnitude = [](const ValueCell& cell) {
        return std::min(std::fabs(cell.low), std::fabs(cell.high));
    };
    std::sort(cells.begin(), cells.end(),
              [&](const ValueCell& a, const ValueCell& b) { return magnitude(a) < magnitude(b); });
    std::uint64_t total = 0;
    for (const ValueCell& cell : cells) total += cell.count;
    const auto upTo = [&](std::uint64_t rank) {
        std::uint64_t seen = 0;
        std::size_t i = 0;
        while (i + 1 < cells.size() && (seen += cells[i].count) <= rank) ++i;
        return magnitude(cells[i]);
    };
    const ValueCell& last = cells.back();
    return {magnitude(cells.front()), upTo(total / 100), upTo(total / 10),
            std::max(std::fabs(last.low), std::fabs(last.high))};
}

// Makes errors as small as 65536 codes allow. Raises one number after the other, as far as needed.
class ErrorFinder {
  public:
    ErrorFinder(const std::vector<Stretch>& stretches, CodeBook::Values kind)
        : stretches_(stretches), kind_(kind) {}

    Allowed find(const Magnitudes& magnitudes, double bulkWidth) {
        constexpr double kFinest = 0x1p-20;
        constexpr double kWorthSaying = 1e-3;
        // At this scale every cell has one code.
        constexpr double kCoarsest = 1e6;
        const double largest = kRelative * magnitudes.largest;
        const double bulk = bulkWidth > 0 ? kRoom * kBulkNeed * bulkWidth : largest;
        const auto atMostBulk = [&](double error) { return std::min(error, bulk); };
        allowed_.cap = bulk;
        allowed_.least =
            std::max(atMostBulk(kRelative * magnitudes.least), std::numeric_limits<double>::min());
        if (suffices()) {
            allowed_.scale = kFinest;
            raise(allowed_.scale, 1);
            return allowed_;
        }
        const bool found =
            // The hundredth of the values nearest to 0 may be off by a larger share, ...
            raise(allowed_.least, atMostBulk(kRelative * magnitudes.hundredth)) ||
            // ... the bulk may be no more accurate than other values, ...
            raise(allowed_.cap, largest) ||
            // ... the tenth nearest to 0 may be off by more than a thousandth of itself, ...
            raise(allowed_.least, atMostBulk(kWorthSaying * magnitudes.tenth)) ||
            // ... all values by a thousandth, ...
            raise(allowed_.scale, kWorthSaying / kRelative) ||
            // ... and small values by kBulkNeed of the bulk's width.
            raise(allowed_.least, bulk) || raise(allowed_.scale, kCoarsest);
        return found ? allowed_ : Allowed{largest, largest, kCoarsest};
    }

  private:
    bool suffices() const { return build(stretches_, kind_, allowed_).codes() <= kCodeCount; }

    // Raises a number up to `most` until the codes suffice. Returns whether they do.
    bool raise(double& number, double most) {
        if (!(most > number)) return suffices();
        double low = number;
        number = most;
        if (!suffices()) return false;
        double high = most;
        constexpr int kHalvings = 40;  // of the interval's ratio
        for (int i = 0; i < kHalvings; ++i) {
            number = std::sqrt(low) * std::sqrt(high);
            (suffices() ? high : low) = number;
        }
        number = high;
        return true;
    }

    const std::vector<Stretch>& stretches_;
    CodeBook::Values kind_;
    Allowed allowed_;
};

// Removes 0 and the counted part of the frequent values from the cells.
std::vector<ValueCell> withoutFrequent(std::vector<ValueCell> cells,
                                       const std::vector<FrequentValue>& frequent) {
    for (ValueCell& cell : cells) {
        if (cell.low == 0 && cell.high == 0) cell.count = 0;
        for (const FrequentValue& one : frequent) {
            if (one.value >= cell.low && one.value <= cell.high)
                cell.count -= std::min(cell.count, one.count);
        }
    }
    const bool any = std::any_of(cells.begin(), cells.end(),
                                 [](const ValueCell& cell) { return cell.count > 0; });
    if (!any) cells.back().count = 1;
    return cells;
}

}  // namespace

glm::dvec2 bulkOf(const std::vector<ValueCell>& cells, const std::vector<FrequentValue>& frequent) {
    const std::vector<ValueCell> others = withoutFrequent(cells, frequent);
    std::uint64_t total = 0;
    for (const ValueCell& cell : others) total += cell.count;
    const std::uint64_t rank = (total - 1) / 100;  // counted from either end
    const auto find = [&](auto begin, auto end) {
        std::uint64_t seen = 0;
        auto cell = begin;
        while (cell + 1 != end && (seen += cell->count) <= rank) ++cell;
        return *cell;
    };
    return {find(others.begin(), others.end()).low, find(others.rbegin(), others.rend()).high};
}

CodeBook fitBook(const std::vector<ValueCell>& cells, const std::vector<FrequentValue>& frequent,
                 CodeBook::Values kind) {
    std::vector<double> values;
    for (const FrequentValue& one : frequent) values.push_back(one.value);
    std::sort(values.begin(), values.end());
    const glm::dvec2 bulk = bulkOf(cells, frequent);
    std::vector<Stretch> stretches;
    for (const ValueCell& cell : cells) addCell(cell, values, bulk, kind, stretches);

    const Magnitudes magnitudes = magnitudesOf(withoutFrequent(cells, frequent));
    const Allowed allowed = ErrorFinder(stretches, kind).find(magnitudes, bulk.y - bulk.x);
    std::vector<CodeBook::Piece> pieces = build(stretches, kind, allowed).take();
    if (pieces.size() == 1 && pieces[0].count > 1) {
        CodeBook book;
        book.kind = CodeBook::Kind::kLinear;
        book.offset = pieces[0].first;
        book.step = pieces[0].step;
        return book;
    }
    return CodeBook::ofPieces(std::move(pieces));
}

void DistinctValues::insert(std::uint64_t bits) {
    last_ = bits;
    if (tooMany_) return;
    if (bits == kNone) {
        hasNone_ = true;
        return;
    }
    if (2 * (count_ + 1) > places_.size()) grow();
    place(bits);
    if (count_ > std::size_t(kCodeCount)) giveUp();
}

void DistinctValues::place(std::uint64_t bits) {
    std::size_t at = hashPlace(bits, places_.size());
    while (places_[at] != kNone && places_[at] != bits) at = (at + 1) & (places_.size() - 1);
    count_ += places_[at] == kNone ? 1 : 0;
    places_[at] = bits;
}

void DistinctValues::grow() {
    std::vector<std::uint64_t> old(std::max<std::size_t>(256, 4 * places_.size()), kNone);
    std::swap(old, places_);
    count_ = 0;
    for (const std::uint64_t bits : old) {
        if (bits != kNone) place(bits);
    }
}

void DistinctValues::giveUp() {
    tooMany_ = true;
    hasNone_ = false;
    count_ = 0;
    places_ = {};
}

void DistinctValues::append(const DistinctValues& other) {
    if (other.tooMany_) giveUp();
    if (other.hasNone_ && !tooMany_) hasNone_ = true;
    for (const std::uint64_t bits : other.places_) {
        if (bits != kNone && !tooMany_) insert(bits);
    }
}

std::vector<double> DistinctValues::sorted() const {
    std::vector<double> values;
    for (const std::uint64_t bits : places_) {
        if (bits != kNone) values.push_back(std::bit_cast<double>(bits));
    }
    if (hasNone_) values.push_back(std::bit_cast<double>(kNone));
    std::sort(values.begin(), values.end(), [](double a, double b) {
        if (std::isnan(a) || std::isnan(b)) {
            const bool both = std::isnan(a) && std::isnan(b);
            return both ? std::bit_cast<std::uint64_t>(a) < std::bit_cast<std::uint64_t>(b)
                        : std::isnan(b);
        }
        return a != b ? a < b : std::signbit(a) && !std::signbit(b);
    });
    return values;
}

}  // namespace deltasplat
