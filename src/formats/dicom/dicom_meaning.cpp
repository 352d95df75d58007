// SPDX-License-Identifier: Apache-2.0
// Based on: DICOM PS3.3 2023, C.7.5.1.1.2 (pixel padding), C.7.6.16.2.9 and .11 (rescale and real
// world values), C.8.8.3 (dose), C.11.1 (modality tables).
#include "formats/dicom/dicom_meaning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/memory.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kPadding = 0x00280120;
constexpr std::uint32_t kPaddingLimit = 0x00280121;
constexpr std::uint32_t kIntercept = 0x00281052;
constexpr std::uint32_t kSlope = 0x00281053;
constexpr std::uint32_t kModalityTable = 0x00283000;
constexpr std::uint32_t kTableShape = 0x00283002;
constexpr std::uint32_t kTableData = 0x00283006;
constexpr std::uint32_t kTransformation = 0x00289145;
constexpr std::uint32_t kRealWorld = 0x00409096;
constexpr std::uint32_t kRealLast = 0x00409211;
constexpr std::uint32_t kRealTable = 0x00409212;
constexpr std::uint32_t kRealLastDouble = 0x00409213;
constexpr std::uint32_t kRealFirstDouble = 0x00409214;
constexpr std::uint32_t kRealFirst = 0x00409216;
constexpr std::uint32_t kRealIntercept = 0x00409224;
constexpr std::uint32_t kRealSlope = 0x00409225;
constexpr std::uint32_t kDoseScaling = 0x3004000e;

using Span = DicomMeaning::Span;
using Table = DicomMeaning::Table;

// Numbers of two bytes that stand for stored ones have their sign.
std::optional<std::int64_t> storedNumber(const DicomItem& item, std::uint32_t tag, bool isSigned) {
    const std::vector<std::uint16_t> words = item.words(tag);
    if (words.empty()) return {};
    return numberOfBits(words[0], 16, isSigned);
}

std::optional<double> decimal(const std::string& where, const DicomItem& item, std::uint32_t tag,
                              const char* name) {
    if (item.text(tag).empty()) return {};
    const std::vector<double> numbers = item.decimals(tag, std::numeric_limits<double>::max());
    if (numbers.size() == 1) return numbers[0];
    refuseInput(where, std::string(name) + " " + printable(item.text(tag)), "a number");
}

// The limit may lie above the value or below. Both are words that stand for the bits of a cell: one
// of 8 bits has the lower byte, if the upper is 0 or repeats its sign.
std::optional<Span> paddingOf(const DicomItem& file, const DicomBits& bits) {
    const auto value = storedNumber(file, kPadding, bits.isSigned);
    if (!value) return {};
    const std::int64_t limit = storedNumber(file, kPaddingLimit, bits.isSigned).value_or(*value);
    const Span words{std::min(*value, limit), std::max(*value, limit)};
    const auto isByte = [](std::int64_t word) {
        const std::int64_t number = numberOfBits(std::uint64_t(word), 16, true);
        return number >= -128 && number <= 255;
    };
    if (bits.allocated != 8 || !isByte(words.first) || !isByte(words.last)) return words;
    const Span bytes{numberOfBits(std::uint64_t(words.first), 8, bits.isSigned),
                     numberOfBits(std::uint64_t(words.last), 8, bits.isSigned)};
    return bytes.first <= bytes.last ? bytes : words;
}

bool isWhole(double number) {
    return number == std::floor(number);
}

// Returns the table that was made last if that is of the same item, or equal.
template <typename Make>
std::shared_ptr<const Table> tableOf(const DicomItem& item, DicomLastTable& last,
                                     const Make& make) {
    if (last.item == &item) return last.table;
    Table table = make();
    const std::vector<double>& values = table.values;
    if (!values.empty()) {
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        table.range = {*low, *high, std::all_of(values.begin(), values.end(), isWhole)};
    }
    if (!last.table || *last.table != table)
        last.table = std::make_shared<const Table>(std::move(table));
    last.item = &item;
    return last.table;
}

// Numbers of 8 bits come one in a byte, or one in a word of two.
std::vector<double> tableData(const DicomItem& item, std::size_t entries, int bits) {
    const auto found = item.values.find(kTableData);
    if (found == item.values.end()) return {};
    const std::string& bytes = found->second;
    std::vector<double> values;
    if (bits <= 8 && bytes.size() < 2 * entries) {
        std::string text = bytes;
        // Two in a word, of which the lower byte is the first.
        if (item.bigEndian)
            for (std::size_t i = 0; i + 1 < text.size(); i += 2) std::swap(text[i], text[i + 1]);
        for (const char byte : text) values.push_back(static_cast<unsigned char>(byte));
    } else {
        for (const std::uint16_t word : item.words(kTableData)) values.push_back(word);
    }
    return values;
}

Table modalityTable(const std::string& where, const DicomItem& item, bool isSigned) {
    const std::vector<std::uint16_t> shape = item.words(kTableShape);
    if (shape.size() != 3) {
        refuseInput(where,
                    "a table of values whose LUTDescriptor has " + std::to_string(shape.size()) +
                        " numbers",
                    "three");
    }
    Table table;
    const std::size_t entries = shape[0] == 0 ? 65536 : shape[0];
    requireMemory(where, 2.0 * sizeof(double) * double(entries));
    table.first = numberOfBits(shape[1], 16, isSigned);
    table.values = tableData(item, entries, shape[2]);
    if (table.values.size() < entries) {
        refuseInput(where, "a table of " + std::to_string(table.values.size()) + " values",
                    std::to_string(entries) + ", as its LUTDescriptor says");
    }
    table.values.resize(entries);
    return table;
}

// The first and the last number that a real world value is given for.
std::optional<Span> realSpan(const DicomItem& item, bool isSigned) {
    const auto first = storedNumber(item, kRealFirst, isSigned);
    const auto last = storedNumber(item, kRealLast, isSigned);
    if (first && last) return Span{*first, *last};
    const std::vector<double> low = item.doubles(kRealFirstDouble);
    const std::vector<double> high = item.doubles(kRealLastDouble);
    constexpr double kMost = 0x1p53;
    if (low.size() != 1 || high.size() != 1 || !(std::abs(low[0]) <= kMost) ||
        !(std::abs(high[0]) <= kMost))
        return {};
    return Span{std::int64_t(std::ceil(low[0])), std::int64_t(std::floor(high[0]))};
}

// Returns a table without values if there is none.
Table realTable(const std::string& where, const DicomItem& item, const Span& span) {
    const auto found = item.values.find(kRealTable);
    if (found == item.values.end()) return {};
    requireMemory(where, 2.0 * double(found->second.size()));
    Table table{span.first, item.doubles(kRealTable), {}};
    const auto entries = std::uint64_t(span.last - span.first) + 1;
    if (!table.values.empty() && table.values.size() < entries) {
        refuseInput(where,
                    "a table of " + std::to_string(table.values.size()) + " real world values",
                    std::to_string(entries));
    }
    if (!table.values.empty()) table.values.resize(std::size_t(entries));
    return table;
}

void setRealWorld(const std::string& where, const DicomItem& item, bool isSigned,
                  DicomMeaning& meaning, DicomLastTable& last, DicomNotes& notes) {
    const std::optional<Span> span = realSpan(item, isSigned);
    const bool isEmpty = span && span->last < span->first;
    if (span && !isEmpty) {
        const auto table = tableOf(item, last, [&] { return realTable(where, item, *span); });
        if (!table->values.empty()) {
            meaning.measured = span;
            meaning.table = table;
            notes.add("values are those of a table of real world values, for there is no other");
            return;
        }
    }
    const std::vector<double> slope = item.doubles(kRealSlope);
    const std::vector<double> intercept = item.doubles(kRealIntercept);
    if (slope.size() != 1 || intercept.size() != 1 || slope[0] == 0 || isEmpty) {
        notes.add("its real world value mapping is none; values are those stored");
        return;
    }
    meaning.measured = span;
    meaning.rescale = {slope[0], intercept[0]};
    const std::string what = "values are those of its real world value mapping, for there is no ";
    notes.add(
        what + "other (" + numberText(slope[0]) + " * stored + " + numberText(intercept[0]) + ")",
        what + "other (each slice has its own)");
}

// A slope of 0 would make all values one.
double usableSlope(double slope, const char* name, DicomNotes& notes) {
    if (slope != 0) return slope;
    notes.add(std::string(name) + " is 0, which makes all values one; 1 is taken");
    return 1;
}

}  // namespace

const DicomItem& DicomFrame::group(std::uint32_t sequence) const {
    for (const DicomItem* const item : {own, shared}) {
        const DicomItem* const found = item == nullptr ? nullptr : item->first(sequence);
        if (found != nullptr) return *found;
    }
    return *file;
}

void DicomNotes::add(const std::string& line, const std::string& ofSeveral) {
    const std::string& key = ofSeveral.empty() ? line : ofSeveral;
    const auto found = std::find_if(lines_.begin(), lines_.end(),
                                    [&](const auto& said) { return said.first == key; });
    if (found == lines_.end()) {
        lines_.emplace_back(key, line);
    } else if (found->second != line) {
        found->second.clear();
    }
}

std::vector<std::string> DicomNotes::lines() const {
    std::vector<std::string> lines;
    for (const auto& [ofSeveral, line] : lines_) lines.push_back(line.empty() ? ofSeveral : line);
    return lines;
}

DicomMeaning meaningOf(const std::string& where, const DicomFrame& frame, const DicomBits& bits,
                       DicomLastTable& last, DicomNotes& notes) {
    DicomMeaning meaning;
    meaning.padding = paddingOf(*frame.file, bits);
    const DicomItem& linear = frame.group(kTransformation);
    const auto slope = decimal(where, linear, kSlope, "RescaleSlope");
    const auto intercept = decimal(where, linear, kIntercept, "RescaleIntercept");
    if (const DicomItem* const table = frame.file->first(kModalityTable)) {
        meaning.table =
            tableOf(*table, last, [&] { return modalityTable(where, *table, bits.isSigned); });
        if (slope || intercept)
            notes.add("values are those of its modality table; its rescale is not used");
    } else if (const auto dose = decimal(where, *frame.file, kDoseScaling, "DoseGridScaling")) {
        meaning.rescale = {usableSlope(*dose, "DoseGridScaling", notes), 0};
    } else if (slope || intercept) {
        if (!slope) notes.add("RescaleIntercept without RescaleSlope; 1 is taken");
        if (!intercept) notes.add("RescaleSlope without RescaleIntercept; 0 is taken");
        meaning.rescale = {usableSlope(slope.value_or(1), "RescaleSlope", notes),
                           intercept.value_or(0)};
    } else {
        const DicomItem& holder = frame.group(kRealWorld);
        const DicomItem* const real =
            &holder == frame.file ? frame.file->first(kRealWorld) : &holder;
        if (real != nullptr) setRealWorld(where, *real, bits.isSigned, meaning, last, notes);
    }
    const DicomRange range = rangeOf(bits, meaning);
    if (!meaning.table && range.low == range.high && bits.stored > 1) {
        notes.add("its slope " + numberText(meaning.rescale.slope) + " makes all values " +
                      numberText(range.low),
                  "slopes that make all values of a slice one");
    }
    return meaning;
}

DicomRange rangeOf(const DicomBits& bits, const DicomMeaning& meaning) {
    if (meaning.table) return meaning.table->range;
    const double a = meaning.valueOf(bits.least());
    const double b = meaning.valueOf(bits.most());
    return {std::min(a, b), std::max(a, b),
            isWhole(meaning.rescale.slope) && isWhole(meaning.rescale.intercept)};
}

}  // namespace deltasplat
