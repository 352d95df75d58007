// SPDX-License-Identifier: Apache-2.0
#include "formats/dicom/dicom_slices.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <tuple>

#include "base/memory.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_name.h"

namespace deltasplat {

namespace {

std::string sizeText(const DicomSlice& slice) {
    return std::to_string(slice.columns) + "x" + std::to_string(slice.rows);
}

void requireAlike(const std::filesystem::path& input, const DicomSlice& first,
                  const DicomSlice& other) {
    if (first.columns != other.columns || first.rows != other.rows) {
        refuseInput(other.file.string(), "a slice of " + sizeText(other),
                    sizeText(first) + ", as in " + first.name(input));
    }
    // An error of 1/1000 voxel adds up to one voxel over 1000 voxels.
    const double most =
        1e-3 * std::min(glm::length(first.alongRow), glm::length(first.alongColumn));
    if (glm::distance(first.alongRow, other.alongRow) > most ||
        glm::distance(first.alongColumn, other.alongColumn) > most) {
        refuseInput(other.file.string(), "a slice of another direction or pixel spacing",
                    "one parallel to " + first.name(input));
    }
}

// An unusual gap means a missing slice or a duplicate.
void requireEven(const std::filesystem::path& input, const std::vector<DicomSlice>& slices) {
    const glm::dvec3 normal = slices.front().normal();
    std::vector<double> gaps;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        gaps.push_back(glm::dot(slices[i].position - slices[i - 1].position, normal));
        if (gaps.back() < 1e-4 * slices.front().thickness) {
            refuseInput(
                input.string(),
                slices[i - 1].name(input) + " and " + slices[i].name(input) + " at the same place",
                "one slice at each place");
        }
    }
    std::vector<double> sorted = gaps;
    std::sort(sorted.begin(), sorted.end());
    const double usual = sorted[(sorted.size() - 1) / 2];
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (std::abs(gaps[i] - usual) <= 0.25 * usual) continue;
        refuseInput(input.string(),
                    slices[i].name(input) + " and " + slices[i + 1].name(input) + " " +
                        numberText(gaps[i]) + " mm apart",
                    numberText(usual) + " mm as between the others (a slice may be missing)");
    }
}

void requireStraight(const std::filesystem::path& input, const std::vector<DicomSlice>& slices,
                     const glm::dvec3& step) {
    const DicomSlice& first = slices.front();
    const double most = std::max(glm::length(first.alongRow), glm::length(first.alongColumn));
    const glm::dvec3 normal = first.normal();
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const glm::dvec3 off = slices[i].position - (first.position + double(i) * step);
        const double aside = glm::length(off - normal * glm::dot(off, normal));
        if (aside <= most) continue;
        refuseInput(input.string(),
                    slices[i].name(input) + " " + numberText(aside) + " mm aside of the others",
                    "slices in one row");
    }
}

}  // namespace

glm::dvec3 DicomSlice::normal() const {
    return glm::normalize(glm::cross(alongRow, alongColumn));
}

std::string DicomSlice::name(const std::filesystem::path& input) const {
    const std::string number = frame > 0 ? " frame " + std::to_string(frame) : "";
    for (const std::filesystem::path& folder : {input, input.parent_path()}) {
        const std::filesystem::path below = file.lexically_relative(folder);
        if (!below.empty() && below != "." && *below.begin() != "..")
            return below.string() + number;
    }
    return file.filename().string() + number;
}

DicomVolume arrangeSlices(const std::filesystem::path& input, std::vector<DicomSlice> slices) {
    const glm::dvec3 normal = slices.front().normal();
    // Equal places are refused below; file names make the order unique.
    std::sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
        const double placeA = glm::dot(a.position, normal);
        const double placeB = glm::dot(b.position, normal);
        if (placeA != placeB) return placeA < placeB;
        return std::tie(a.file, a.frame) < std::tie(b.file, b.frame);
    });
    for (const DicomSlice& slice : slices) requireAlike(input, slices.front(), slice);

    const DicomSlice& first = slices.front();
    glm::dvec3 step = normal * first.thickness;
    if (slices.size() > 1) {
        requireEven(input, slices);
        // A tilted gantry shifts each slice against the one before: the volume is sheared.
        step = (slices.back().position - first.position) / double(slices.size() - 1);
        requireStraight(input, slices, step);
    }
    DicomVolume volume;
    volume.worldFromIndex =
        glm::dmat4(glm::dvec4(first.alongRow, 0), glm::dvec4(first.alongColumn, 0),
                   glm::dvec4(step, 0), glm::dvec4(first.position, 1));
    volume.slices = std::move(slices);
    return volume;
}

// Based on: DICOM PS3.3 2023, C.7.5.1.1.2 (pixel padding), C.7.6.16.2.9 and .11 (rescale and real
// world values), C.8.8.3 (dose), C.11.1 (modality tables).
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

// A 2-byte number that stands for stored numbers has their sign.
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

// The limit may lie above or below the value. Both are words for a cell's bits: an 8-bit cell takes
// the low byte if the high byte is 0 or the sign.
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

// Returns the last table if made from the same item or equal.
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

// Reads a table. 8-bit values are stored one per byte, or one per 2-byte word.
std::vector<double> tableData(const DicomItem& item, std::size_t entries, int bits) {
    const auto found = item.values.find(kTableData);
    if (found == item.values.end()) return {};
    const std::string& bytes = found->second;
    std::vector<double> values;
    if (bits <= 8 && bytes.size() < 2 * entries) {
        std::string text = bytes;
        // Two values share a word, the first in the low byte.
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

// The range of stored numbers that a real world mapping covers.
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

// The table has no values if the item has none.
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

// A slope of 0 would make all values equal.
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

// Siemens' mosaics. Private elements give the number of slices (0019,xx0A) and texts (0029,xx10).
namespace {

constexpr std::uint32_t kImageType = 0x00080008;

// Finds the block of private elements that a creator reserved.
std::uint32_t blockOf(const DicomElements& elements, std::uint32_t group,
                      const std::string& creator) {
    for (std::uint32_t block = 0x10; block <= 0xff; ++block) {
        if (elements.text(group << 16 | block) == creator) return group << 16 | block << 8;
    }
    return 0;
}

std::uint32_t littleEndian(const std::string& bytes, std::size_t place) {
    std::uint32_t number = 0;
    for (std::size_t i = 4; i-- > 0;)
        number = number << 8 | static_cast<unsigned char>(bytes[place + i]);
    return number;
}

// Reads Siemens' table. An entry is a 64-byte name, five numbers (the fourth counts items) and
// items: four numbers (the second is a length) and a text padded to 4 bytes. Version 1 has no mark,
// and its length is the first number, increased by the first entry's number of items.
std::map<std::string, std::vector<std::string>> entriesOf(const std::string& bytes) {
    std::map<std::string, std::vector<std::string>> entries;
    constexpr std::uint32_t kMark = 77, kMostOfFirst = 128;
    const bool isFirst = !bytes.starts_with("SV10");
    std::size_t place = isFirst ? 0 : 8;
    if (bytes.size() < 16) return entries;
    const std::uint32_t count = littleEndian(bytes, place);
    if (isFirst && (count > kMostOfFirst || littleEndian(bytes, 4) != kMark)) return entries;
    place += 8;
    std::uint32_t added = 0;
    for (std::uint32_t i = 0; i < count && bytes.size() - place >= 84; ++i) {
        const std::string name = bytes.substr(place, 64).c_str();
        const std::uint32_t items = littleEndian(bytes, place + 76);
        if (isFirst && i == 0) added = items;
        place += 84;
        for (std::uint32_t item = 0; item < items && bytes.size() - place >= 16; ++item) {
            const std::size_t length = littleEndian(bytes, place + (isFirst ? 0 : 4)) - added;
            place += 16;
            if (length > bytes.size() - place) return entries;
            if (length > 0) entries[name].emplace_back(bytes.substr(place, length).c_str());
            place = std::min(bytes.size(), place + (length + 3) / 4 * 4);
        }
    }
    return entries;
}

std::vector<double> numbersOf(const std::vector<std::string>& texts) {
    std::vector<double> numbers;
    for (const std::string& text : texts) {
        const std::size_t begin = text.find_first_not_of(' ');
        double number = 0;
        if (begin == std::string::npos) return {};
        const auto result = std::from_chars(text.data() + begin, text.data() + text.size(), number);
        if (result.ec != std::errc{} || !std::isfinite(number)) return {};
        numbers.push_back(number);
    }
    return numbers;
}

struct Layout {
    int slices = 0;
    std::vector<double> normal;  // direction from slice to slice; empty if unknown
};

Layout layoutOf(const DicomElements& elements) {
    Layout layout;
    if (const std::uint32_t block = blockOf(elements, 0x0029, "SIEMENS CSA HEADER")) {
        const auto table = elements.values.find(block | 0x10);
        if (table != elements.values.end()) {
            auto entries = entriesOf(table->second);
            const std::vector<double> count = numbersOf(entries["NumberOfImagesInMosaic"]);
            if (count.size() == 1 && count[0] >= 1 && count[0] <= 65535)
                layout.slices = int(count[0]);
            layout.normal = numbersOf(entries["SliceNormalVector"]);
        }
    }
    if (const std::uint32_t block = blockOf(elements, 0x0019, "SIEMENS MR HEADER"))
        layout.slices = elements.number(block | 0x0a, layout.slices);
    return layout;
}

}  // namespace

bool isMosaic(const DicomElements& elements) {
    std::istringstream kinds(elements.text(kImageType));
    for (std::string kind; std::getline(kinds, kind, '\\');) {
        if (kind == "MOSAIC" || kind == "MOSAIC ") return true;
    }
    return false;
}

std::vector<DicomSlice> slicesOfMosaic(const DicomElements& elements, const DicomSlice& picture,
                                       DicomNotes& notes) {
    const Layout layout = layoutOf(elements);
    if (layout.slices < 1) {
        refuseFile(picture.file, "a mosaic (ImageType MOSAIC) that does not say of how many slices",
                   "NumberOfImagesInMosaic of a \"SIEMENS MR HEADER\" or \"SIEMENS CSA HEADER\"");
    }
    const int side = int(std::ceil(std::sqrt(layout.slices)));
    if (picture.columns % side != 0 || picture.rows % side != 0) {
        refuseFile(picture.file,
                   "a mosaic of " + std::to_string(layout.slices) + " slices in " +
                       std::to_string(picture.columns) + "x" + std::to_string(picture.rows),
                   "tiles of one size, " + std::to_string(side) + " in a row");
    }
    glm::dvec3 step = picture.normal() * picture.thickness;
    if (layout.normal.size() == 3) {
        const glm::dvec3 way(layout.normal[0], layout.normal[1], layout.normal[2]);
        if (glm::dot(way, step) < 0) step = -step;
    } else {
        notes.add(
            "a mosaic that does not say which way its slices follow; the normal of rows and "
            "columns is taken");
    }
    DicomSlice tile = picture;
    tile.columns = picture.columns / side;
    tile.rows = picture.rows / side;
    // The header places a slice as large as the mosaic; the real slice is at its centre.
    tile.position += picture.alongRow * ((picture.columns - tile.columns) / 2.0) +
                     picture.alongColumn * ((picture.rows - tile.rows) / 2.0);
    std::vector<DicomSlice> slices;
    for (int i = 0; i < layout.slices; ++i) {
        slices.push_back(tile);
        slices.back().left = i % side * tile.columns;
        slices.back().top = i / side * tile.rows;
        slices.back().frame = i + 1;
        slices.back().position += double(i) * step;
    }
    return slices;
}

}  // namespace deltasplat
