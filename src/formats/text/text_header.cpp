// SPDX-License-Identifier: Apache-2.0
#include "formats/text/text_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>

#include "base/memory.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/file_name.h"
#include "volume/placement.h"

namespace deltasplat {

namespace {

constexpr std::size_t kMostLine = std::size_t{1} << 20;
constexpr std::size_t kMostHeader = std::size_t{1} << 24;

std::string trimmed(const std::string& text) {
    const char* const kBlanks = " \t";
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string fieldName(std::string_view text) {
    std::string name;
    for (const char c : lowerCase(std::string(text))) {
        if (c != ' ' && c != '\t') name += c;
    }
    return name;
}

bool controls(char c) {
    return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == '\x7f';
}

// The lines of a file, plain or gzipped.
class Lines {
  public:
    explicit Lines(const std::filesystem::path& file)
        : where_(file.string()), source_(file, packingOf(file)) {}
    std::optional<std::string> next() {
        std::string line;
        for (std::optional<char> c; (c = get());) {
            if (place_ > kMostHeader || line.size() > kMostLine) {
                refuseInput(where_, "a header without end", "a text header");
            }
            if (c == '\n') {
                if (line.ends_with('\r')) line.pop_back();
                return line;
            }
            line += *c;
        }
        return line.empty() ? std::nullopt : std::optional(line);
    }
    std::uint64_t place() const { return place_; }
    const std::string& where() const { return where_; }

  private:
    std::optional<char> get() {
        if (used_ == held_) {
            held_ = source_.read(buffer_.data(), buffer_.size());
            used_ = 0;
        }
        if (held_ == 0) return {};
        ++place_;
        return buffer_[used_++];
    }

    std::string where_;
    ByteSource source_;
    std::array<char, 4096> buffer_{};
    std::size_t held_ = 0, used_ = 0;
    std::uint64_t place_ = 0;
};

std::string quoted(const std::string& line) {
    constexpr std::size_t kMost = 60;
    const bool whole = line.size() <= kMost;
    return "the header line \"" + printable(line.substr(0, kMost)) + (whole ? "\"" : "...\"");
}

[[noreturn]] void refuseLine(const Lines& lines, const std::string& line,
                             const std::string& expected) {
    refuseInput(lines.where(), quoted(line), expected);
}

// Checks a field that is used here. Refuses control characters, because programs disagree about
// which of them end a line.
void requireText(const Lines& lines, const std::string& line) {
    if (std::ranges::none_of(line, controls)) return;
    refuseInput(lines.where(), "control characters in " + quoted(line), "lines of text");
}

// Readers disagree about which of two equal fields counts.
void addField(const Lines& lines, const TextHeader::Field& field, TextHeader& header) {
    if (header.find(field.name) != nullptr) {
        refuseInput(lines.where(), "the field " + printable(field.name) + " twice",
                    "each field once");
    }
    header.fields.push_back(field);
}

// The format's fields. Files spell them in any case, with or without the blank.
constexpr std::array<std::string_view, 31> kNrrdFields{"content",
                                                       "number",
                                                       "type",
                                                       "block size",
                                                       "dimension",
                                                       "space",
                                                       "space dimension",
                                                       "sizes",
                                                       "spacings",
                                                       "thicknesses",
                                                       "axis mins",
                                                       "axis maxs",
                                                       "space directions",
                                                       "centers",
                                                       "centerings",
                                                       "kinds",
                                                       "labels",
                                                       "units",
                                                       "min",
                                                       "max",
                                                       "old min",
                                                       "old max",
                                                       "endian",
                                                       "encoding",
                                                       "line skip",
                                                       "byte skip",
                                                       "sample units",
                                                       "space units",
                                                       "space origin",
                                                       "measurement frame",
                                                       "data file"};

// Fields that describe voxels and placement. Other fields are private and skipped.
constexpr std::array<std::string_view, 28> kMetaFields{"NDims",
                                                       "CompressedData",
                                                       "CompressedDataSize",
                                                       "BinaryData",
                                                       "ElementByteOrderMSB",
                                                       "BinaryDataByteOrderMSB",
                                                       "Position",
                                                       "Origin",
                                                       "Offset",
                                                       "TransformMatrix",
                                                       "Rotation",
                                                       "Orientation",
                                                       "DistanceUnits",
                                                       "AnatomicalOrientation",
                                                       "ElementSpacing",
                                                       "DimSize",
                                                       "HeaderSize",
                                                       "ElementNumberOfChannels",
                                                       "ElementSize",
                                                       "ElementNBits",
                                                       "ElementType",
                                                       "ElementToIntensityFunctionSlope",
                                                       "ElementToIntensityFunctionOffset",
                                                       "RescaleSlope",
                                                       "RescaleIntercept",
                                                       "RescaleOffset",
                                                       "intent_code",
                                                       "ElementDataFile"};

// A format's fields, by their names without case and blanks.
using Spellings = std::map<std::string, std::string_view, std::less<>>;
Spellings spellingsOf(std::span<const std::string_view> fields) {
    Spellings spellings;
    for (const std::string_view field : fields) spellings.emplace(fieldName(field), field);
    return spellings;
}

// Returns the format's spelling of a field; empty if it has no such field.
std::string_view spellingOf(const Spellings& spellings, const std::string& letters) {
    const auto found = spellings.find(letters);
    return found == spellings.end() ? std::string_view() : found->second;
}

// Takes a line "key:=value", in which backslashes escape line ends and backslashes.
void addKeyValue(const Lines& lines, const std::string& line, std::size_t sign,
                 TextHeader& header) {
    // Short keys need much more memory than their bytes in the file.
    constexpr std::size_t kKeysAtOnce = std::size_t{1} << 14;
    if (header.keyValues.size() % kKeysAtOnce == 0) {
        requireMemory(lines.where(), double(header.keyValues.size() + kKeysAtOnce) *
                                         sizeof(header.keyValues.front()));
    }
    const auto plain = [](const std::string& text) {
        std::string result;
        for (std::size_t i = 0; i < text.size(); ++i) {
            const bool escapes = text[i] == '\\' && i + 1 < text.size() &&
                                 (text[i + 1] == 'n' || text[i + 1] == '\\');
            result += !escapes ? text[i] : text[i + 1] == 'n' ? '\n' : '\\';
            i += escapes ? 1 : 0;
        }
        return result;
    };
    header.keyValues.emplace_back(plain(line.substr(0, sign)), plain(line.substr(sign + 2)));
}

// The characters after the first colon tell fields from keys, whatever the key's name.
void addNrrdLine(const Lines& lines, const std::string& line, TextHeader& header) {
    const std::size_t colon = std::min(line.find(':'), line.size());
    const std::string before = line.substr(0, colon);
    const std::string letters = fieldName(before);
    static const Spellings spellings = spellingsOf(kNrrdFields);
    const std::string_view spelling = spellingOf(spellings, letters);
    const bool spelled = lowerCase(before) == spelling || lowerCase(before) == letters;
    const bool isField = !spelling.empty() && line.compare(colon, 2, ": ") == 0;
    if (!isField || !spelled) {
        const std::size_t sign = line.find(":=");
        if (sign != std::string::npos) return addKeyValue(lines, line, sign, header);
        refuseLine(
            lines, line,
            spelling.empty() ? "\"field: value\"" : "\"" + std::string(spelling) + ": value\"");
    }
    requireText(lines, line);
    const std::size_t value = std::min(line.size(), line.find_first_not_of(" \t", colon + 1));
    // Blanks after a file name belong to the name.
    const bool isName = letters == "datafile";
    addField(lines, {letters, isName ? line.substr(value) : trimmed(line.substr(value))}, header);
}

void addMetaLine(const Lines& lines, const std::string& line, TextHeader& header) {
    const std::size_t sign = line.find('=');
    const std::string name = trimmed(line.substr(0, std::min(sign, line.size())));
    if (sign == std::string::npos || name.empty()) refuseLine(lines, line, "\"Name = value\"");
    static const Spellings spellings = spellingsOf(kMetaFields);
    const std::string_view spelling = spellingOf(spellings, fieldName(name));
    if (spelling.empty()) return;
    requireText(lines, line);
    const std::string value = trimmed(line.substr(sign + 1));
    const bool signs = value.starts_with('=') || value.starts_with(':');
    if (name != spelling || signs)
        refuseLine(lines, line, "\"" + std::string(spelling) + " = value\"");
    addField(lines, {fieldName(name), value}, header);
}

}  // namespace

const std::string* TextHeader::find(const std::string& name) const {
    for (const Field& field : fields) {
        if (field.name == name) return &field.value;
    }
    return nullptr;
}

const std::string* TextHeader::findKey(const std::string& key) const {
    for (const auto& [name, value] : keyValues) {
        if (name == key) return &value;
    }
    return nullptr;
}

TextHeader readNrrdHeader(const std::filesystem::path& file) {
    Lines lines(file);
    TextHeader header;
    std::optional<std::string> line = lines.next();
    if (!line || line->size() != 8 || !line->starts_with("NRRD000") || (*line)[7] < '1' ||
        (*line)[7] > '5') {
        refuseInput(lines.where(), "no NRRD header",
                    "a file that begins with NRRD0001 to NRRD0005");
    }
    while ((line = lines.next()) && !line->empty()) {
        if ((*line)[0] != '#') addNrrdLine(lines, *line, header);
    }
    header.dataStart = lines.place();
    return header;
}

TextHeader readMetaHeader(const std::filesystem::path& file) {
    Lines lines(file);
    TextHeader header;
    for (std::optional<std::string> line; (line = lines.next());) {
        if (trimmed(*line).empty()) continue;
        addMetaLine(lines, *line, header);
        if (!header.fields.empty() && header.fields.back().name == "elementdatafile") {
            header.dataStart = lines.place();
            return header;
        }
    }
    refuseInput(lines.where(), "no ElementDataFile", "a MetaImage header that ends with one");
}

std::vector<std::int64_t> parseSizes(const std::string& where, const std::string& text) {
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    std::vector<std::int64_t> sizes;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        std::int64_t size = 0;
        const char* const end = word.data() + word.size();
        const auto result = std::from_chars(word.data(), end, size);
        if (result.ec != std::errc{} || result.ptr != end || size < 1 || size > kMost) {
            refuseInput(where, "sizes " + printable(text),
                        "whole numbers from 1 to " + std::to_string(kMost));
        }
        sizes.push_back(size);
    }
    if (sizes.empty()) refuseInput(where, "no sizes", "the number of voxels along each axis");
    return sizes;
}

namespace {

constexpr std::int64_t kMostBytes = std::int64_t{1} << 62;

// Returns the unit that all share, or millimetres if units differ and all are known.
std::string commonUnit(const std::vector<std::string>& units) {
    const bool same = std::ranges::all_of(units, [&](const auto& u) { return u == units.front(); });
    if (same) return units.front();
    const bool known = std::ranges::none_of(units, [](const auto& u) { return u.empty(); });
    return known ? "mm" : "";
}

std::string listText(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "\"" : ", \"") + printable(word) + "\"";
    return text;
}

}  // namespace

std::string TextVolume::sizesText() const {
    std::string text;
    for (const std::int64_t size : sizes) text += (text.empty() ? "" : "x") + std::to_string(size);
    return text;
}

const std::string& requireField(const TextHeader& header, const std::string& field,
                                const std::filesystem::path& file) {
    const std::string* value = header.find(field);
    if (value == nullptr) refuseFile(file, "a header without " + field, "a whole one");
    return *value;
}

std::int64_t wholeField(const TextHeader& header, const std::string& field, std::int64_t missing,
                        const std::filesystem::path& file) {
    const std::string* value = header.find(field);
    if (value == nullptr) return missing;
    std::int64_t number = 0;
    const char* const end = value->data() + value->size();
    const auto result = std::from_chars(value->data(), end, number);
    if (result.ec != std::errc{} || result.ptr != end) {
        refuseFile(file, field + " " + printable(*value), "a whole number");
    }
    return number;
}

std::optional<std::vector<double>> numbersIn(const std::string& text) {
    std::vector<double> numbers;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        double number = 0;
        const char* const begin = word.data() + (word.front() == '+' ? 1 : 0);
        const char* const end = word.data() + word.size();
        const auto result = std::from_chars(begin, end, number);
        if (result.ec != std::errc{} || result.ptr != end) return {};
        numbers.push_back(number);
    }
    return numbers;
}

void setDataFile(const std::string& name, TextVolume& volume) {
    // Other programs do not resolve names with "c:" or "~" relative to the header.
    const bool elsewhere = name.starts_with('~') || (name.size() > 1 && name[1] == ':');
    if (name.empty() || name == "-" || lowerCase(name).rfind("list", 0) == 0 || elsewhere ||
        name.find('%') != std::string::npos) {
        refuseFile(volume.header, "data in \"" + printable(name) + "\"",
                   "the name of one data file");
    }
    volume.dataFile = volume.header.parent_path() / name;
    std::error_code error;
    if (!std::filesystem::is_regular_file(volume.dataFile, error)) {
        refuseFile(volume.header, "no data file \"" + printable(name) + "\"", "a readable file");
    }
}

void takeThree(std::vector<std::size_t>& axes, TextVolume& volume) {
    while (axes.size() > 3) {
        const auto single = std::find_if(axes.rbegin(), axes.rend(),
                                         [&](std::size_t axis) { return volume.sizes[axis] == 1; });
        if (single == axes.rend()) {
            refuseFile(volume.header, "sizes " + volume.sizesText(), "one volume of three axes");
        }
        axes.erase(std::next(single).base());
    }
    std::int64_t most = kMostBytes / rawTypeBytes(volume.layout.type) / volume.volumes;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        volume.layout.dims[int(i)] = volume.sizes[axes[i]];
        most /= volume.sizes[axes[i]];
    }
    if (most == 0) {
        refuseFile(volume.header, "sizes " + volume.sizesText(),
                   "at most " + std::to_string(kMostBytes) + " bytes");
    }
}

void setUnits(const std::vector<std::string>& units, const Listener& listener, TextVolume& volume) {
    std::vector<std::string> names;
    for (const std::string& unit : units) names.push_back(lengthUnitNamed(unit));
    const bool said = std::ranges::any_of(units, [](const auto& unit) { return !unit.empty(); });
    std::string unit = commonUnit(names);
    if (unit.empty() && said) {
        listener.warn(volume.header.string() + ": lengths are in " + listText(units) +
                      ", which is no one unit that is known; they stay as they are");
    }
    if (unit.empty()) return;
    if (!volume.space.empty()) unit = "mm";
    volume.lengthUnit = unit;
    for (int row = 0; row < 3; ++row) {
        const std::string& own = names[std::min(std::size_t(row), names.size() - 1)];
        if (own == unit) continue;
        const double factor = millimetresIn(own) / millimetresIn(unit);
        for (int column = 0; column < 4; ++column) volume.worldFromIndex[column][row] *= factor;
    }
}

}  // namespace deltasplat
