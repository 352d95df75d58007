// SPDX-License-Identifier: Apache-2.0
// Based on: DICOM PS3.3 2023, C.7.5.1.1.2 (pixel padding), C.7.6.16.2.9 and .11 (rescale and real
// world values), C.8.8.3 (dose), C.11.1 (modality tables).
#include "ingest/dicom/dicom_meaning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "deltasplat/error.h"
#include "number_text.h"
#include "printable.h"

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

[[noreturn]] void refuse(const std::string& where, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
}

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
    refuse(where, std::string(name) + " " + printable(item.text(tag)), "a number");
}

// The limit may lie above the value or below.
std::optional<Span> paddingOf(const DicomItem& file, bool isSigned) {
    const auto value = storedNumber(file, kPadding, isSigned);
    if (!value) return {};
    const std::int64_t limit = storedNumber(file, kPaddingLimit, isSigned).value_or(*value);
    return Span{std::min(*value, limit), std::max(*value, limit)};
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

std::shared_ptr<const Table> modalityTable(const std::string& where, const DicomItem& item,
                                           bool isSigned) {
    const std::vector<std::uint16_t> shape = item.words(kTableShape);
    if (shape.size() != 3) {
        refuse(where,
               "a table of values whose LUTDescriptor has " + std::to_string(shape.size()) +
                   " numbers",
               "three");
    }
    Table table;
    const std::size_t entries = shape[0] == 0 ? 65536 : shape[0];
    table.first = numberOfBits(shape[1], 16, isSigned);
    table.values = tableData(item, entries, shape[2]);
    if (table.values.size() < entries) {
        refuse(where, "a table of " + std::to_string(table.values.size()) + " values",
               std::to_string(entries) + ", as its LUTDescriptor says");
    }
    table.values.resize(entries);
    return std::make_shared<const Table>(std::move(table));
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

void setRealWorld(const std::string& where, const DicomItem& item, bool isSigned,
                  DicomMeaning& meaning, std::vector<std::string>& notes) {
    meaning.measured = realSpan(item, isSigned);
    const std::vector<double> slope = item.doubles(kRealSlope);
    const std::vector<double> intercept = item.doubles(kRealIntercept);
    std::vector<double> values = item.doubles(kRealTable);
    const bool isEmpty = meaning.measured && meaning.measured->last < meaning.measured->first;
    if (!values.empty() && meaning.measured && !isEmpty) {
        const auto entries = std::uint64_t(meaning.measured->last - meaning.measured->first) + 1;
        if (values.size() < entries) {
            refuse(where, "a table of " + std::to_string(values.size()) + " real world values",
                   std::to_string(entries));
        }
        values.resize(std::size_t(entries));
        meaning.table = std::make_shared<const Table>(Table{meaning.measured->first, values});
        notes.push_back("values are those of a table of real world values, for there is no other");
        return;
    }
    if (slope.size() != 1 || intercept.size() != 1 || slope[0] == 0 || isEmpty) {
        meaning.measured.reset();
        notes.push_back("its real world value mapping is none; values are those stored");
        return;
    }
    meaning.rescale = {slope[0], intercept[0]};
    notes.push_back("values are those of its real world value mapping, for there is no other (" +
                    numberText(slope[0]) + " * stored + " + numberText(intercept[0]) + ")");
}

// A slope of 0 would make all values one.
double usableSlope(double slope, const char* name, std::vector<std::string>& notes) {
    if (slope != 0) return slope;
    notes.push_back(std::string(name) + " is 0, which makes all values one; 1 is taken");
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

DicomMeaning meaningOf(const std::string& where, const DicomFrame& frame, const DicomBits& bits,
                       std::vector<std::string>& notes) {
    DicomMeaning meaning;
    meaning.padding = paddingOf(*frame.file, bits.isSigned);
    const DicomItem& linear = frame.group(kTransformation);
    const auto slope = decimal(where, linear, kSlope, "RescaleSlope");
    const auto intercept = decimal(where, linear, kIntercept, "RescaleIntercept");
    if (const DicomItem* const table = frame.file->first(kModalityTable)) {
        meaning.table = modalityTable(where, *table, bits.isSigned);
        if (slope || intercept)
            notes.push_back("values are those of its modality table; its rescale is not used");
    } else if (const auto dose = decimal(where, *frame.file, kDoseScaling, "DoseGridScaling")) {
        meaning.rescale = {usableSlope(*dose, "DoseGridScaling", notes), 0};
    } else if (slope || intercept) {
        meaning.rescale = {usableSlope(slope.value_or(1), "RescaleSlope", notes),
                           intercept.value_or(0)};
    } else {
        const DicomItem& holder = frame.group(kRealWorld);
        const DicomItem* const real =
            &holder == frame.file ? frame.file->first(kRealWorld) : &holder;
        if (real != nullptr) setRealWorld(where, *real, bits.isSigned, meaning, notes);
    }
    const DicomRange range = rangeOf(bits, meaning);
    if (!meaning.table && range.low == range.high && bits.stored > 1) {
        notes.push_back("its slope " + numberText(meaning.rescale.slope) + " makes all values " +
                        numberText(range.low));
    }
    return meaning;
}

DicomRange rangeOf(const DicomBits& bits, const DicomMeaning& meaning) {
    const auto isWhole = [](double number) { return number == std::floor(number); };
    if (!meaning.table) {
        const double a = meaning.valueOf(bits.least());
        const double b = meaning.valueOf(bits.most());
        return {std::min(a, b), std::max(a, b),
                isWhole(meaning.rescale.slope) && isWhole(meaning.rescale.intercept)};
    }
    const std::vector<double>& values = meaning.table->values;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {*low, *high, std::all_of(values.begin(), values.end(), isWhole)};
}

}  // namespace deltasplat
