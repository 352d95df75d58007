// SPDX-License-Identifier: Apache-2.0
#include "ingest/itk/text_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

#include "deltasplat/error.h"
#include "ingest/files/file_name.h"
#include "lower_case.h"
#include "printable.h"

namespace deltasplat {
namespace {

// ITK's readers copy names and values to buffers of a few hundred bytes.
constexpr std::size_t kMostLine = 200;
// Nine numbers of 17 digits do not fit there; these fields are read number by number.
constexpr std::array<std::string_view, 5> kMatrixFields{
    "spacedirections", "measurementframe", "transformmatrix", "rotation", "orientation"};
constexpr std::size_t kMostMatrixLine = 450;
constexpr std::size_t kMostFreeLine = 16384;
constexpr std::size_t kMostHeader = std::size_t{1} << 20;

[[noreturn]] void refuse(const std::string& where, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
}

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

// The lines of a file, one after the other, none of them longer than is sane. What some take for
// the end of a line or of a text, and others do not, is in none.
class Lines {
  public:
    explicit Lines(const std::filesystem::path& file) : where_(file.string()) {
        requireRegularFile(file);
        in_.open(file, std::ios::binary);
        if (!in_) refuse(where_, "a file that cannot be opened", "a readable file");
    }
    std::optional<std::string> next() {
        std::string line;
        for (char c = 0; in_.get(c);) {
            ++place_;
            if (place_ > kMostHeader || line.size() > kMostFreeLine) {
                refuse(where_, "a header without end", "a text header");
            }
            if (c == '\n') return whole(line);
            line += c;
        }
        return line.empty() ? std::nullopt : std::optional(whole(line));
    }
    bool ended() const { return !in_.eof(); }  ///< the last line, by an end of line
    std::uint64_t place() const { return place_; }
    const std::string& where() const { return where_; }

  private:
    std::string whole(std::string line) const {
        if (ended() && line.ends_with('\r')) line.pop_back();
        if (std::ranges::none_of(line, controls)) return line;
        refuse(where_,
               "control characters in the header line \"" + printable(line.substr(0, 40)) + "\"",
               "lines of text");
    }

    std::string where_;
    std::ifstream in_;
    std::uint64_t place_ = 0;
};

void requireSaneLine(const Lines& lines, const std::string& line) {
    constexpr std::size_t kMostName = 24;
    const std::string name =
        fieldName(line.substr(0, line.substr(0, kMostName).find_first_of(":=")));
    const bool matrix =
        std::ranges::find(kMatrixFields, std::string_view(name)) != kMatrixFields.end();
    const std::size_t most = matrix ? kMostMatrixLine : kMostLine;
    if (line.size() <= most) return;
    refuse(lines.where(), "the header line \"" + printable(line.substr(0, 20)) + "...\"",
           "at most " + std::to_string(most) + " characters of text");
}

[[noreturn]] void refuseLine(const Lines& lines, const std::string& line,
                             const std::string& expected) {
    refuse(lines.where(), "the header line \"" + printable(line) + "\"", expected);
}

// Of a field given twice readers take one or the other.
void addField(const Lines& lines, const TextHeader::Field& field, TextHeader& header) {
    if (header.find(field.name) != nullptr && field.name != "comment") {
        refuse(lines.where(), "the field " + printable(field.name) + " twice", "each field once");
    }
    header.fields.push_back(field);
}

// NrrdIO takes these in upper and lower case, and with the blank or without.
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

// MetaIO takes these as they stand here and not otherwise.
constexpr std::array<std::string_view, 36> kMetaFields{"Comment",
                                                       "AcquisitionDate",
                                                       "ObjectType",
                                                       "ObjectSubType",
                                                       "NDims",
                                                       "Name",
                                                       "ID",
                                                       "ParentID",
                                                       "CompressedData",
                                                       "CompressedDataSize",
                                                       "BinaryData",
                                                       "ElementByteOrderMSB",
                                                       "BinaryDataByteOrderMSB",
                                                       "Color",
                                                       "Position",
                                                       "Origin",
                                                       "Offset",
                                                       "TransformMatrix",
                                                       "Rotation",
                                                       "Orientation",
                                                       "CenterOfRotation",
                                                       "DistanceUnits",
                                                       "AnatomicalOrientation",
                                                       "ElementSpacing",
                                                       "DimSize",
                                                       "HeaderSize",
                                                       "Modality",
                                                       "ImagePosition",
                                                       "SequenceID",
                                                       "ElementMin",
                                                       "ElementMax",
                                                       "ElementNumberOfChannels",
                                                       "ElementSize",
                                                       "ElementNBits",
                                                       "ElementType",
                                                       "ElementDataFile"};

// How a format spells the field whose letters these are; empty if it has none.
std::string_view spellingOf(std::span<const std::string_view> fields, const std::string& letters) {
    const auto found = std::ranges::find_if(
        fields, [&](std::string_view field) { return fieldName(field) == letters; });
    return found == fields.end() ? std::string_view() : *found;
}

void addNrrdLine(const Lines& lines, const std::string& line, TextHeader& header) {
    const std::string before = line.substr(0, line.find(':'));
    const std::string letters = fieldName(before);
    const std::string_view spelling = spellingOf(kNrrdFields, letters);
    if (spelling.empty()) {
        // NrrdIO looks for ":=" where it knows no field; it is no field of any other spelling.
        if (before.size() < line.size() && line.find(":=") != std::string::npos) return;
        requireSaneLine(lines, line);
        refuseLine(lines, line, "\"field: value\"");
    }
    requireSaneLine(lines, line);
    const bool spelled = lowerCase(before) == spelling || lowerCase(before) == letters;
    if (!spelled || line.compare(before.size(), 2, ": ") != 0) {
        refuseLine(lines, line, "\"" + std::string(spelling) + ": value\"");
    }
    // Blanks behind a name of a file are part of it.
    const std::size_t value =
        std::min(line.size(), line.find_first_not_of(" \t", before.size() + 1));
    addField(lines, {letters, line.substr(value)}, header);
}

void addMetaLine(const Lines& lines, const std::string& line, TextHeader& header) {
    requireSaneLine(lines, line);
    const std::size_t sign = line.find_first_of("=:");
    if (sign == std::string::npos || line[sign] == ':' || trimmed(line.substr(0, sign)).empty()) {
        refuseLine(lines, line, "\"Name = value\"");
    }
    const std::string name = trimmed(line.substr(0, sign));
    const std::string value = trimmed(line.substr(sign + 1));
    const std::string_view spelling = spellingOf(kMetaFields, fieldName(name));
    // MetaIO passes over any number of signs.
    const bool signs = value.starts_with('=') || value.starts_with(':');
    if (!spelling.empty() && (name != spelling || signs)) {
        refuseLine(lines, line, "\"" + std::string(spelling) + " = value\"");
    }
    addField(lines, {fieldName(name), value}, header);
}

}  // namespace

const std::string* TextHeader::find(const std::string& name) const {
    for (const Field& field : fields) {
        if (field.name == name) return &field.value;
    }
    return nullptr;
}

TextHeader readNrrdHeader(const std::filesystem::path& file) {
    Lines lines(file);
    TextHeader header;
    std::optional<std::string> line = lines.next();
    if (!line || line->size() != 8 || !line->starts_with("NRRD000") || (*line)[7] < '1' ||
        (*line)[7] > '5') {
        refuse(lines.where(), "no NRRD header", "a file that begins with NRRD0001 to NRRD0005");
    }
    while ((line = lines.next()) && !line->empty()) {
        // NrrdIO passes over what no end of line follows.
        if (!lines.ended()) refuseLine(lines, *line, "an end of line behind it");
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
        if (header.fields.back().name == "elementdatafile") {
            header.dataStart = lines.place();
            return header;
        }
    }
    refuse(lines.where(), "no ElementDataFile", "a MetaImage header that ends with one");
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
            refuse(where, "sizes " + printable(text),
                   "whole numbers from 1 to " + std::to_string(kMost));
        }
        sizes.push_back(size);
    }
    if (sizes.empty()) refuse(where, "no sizes", "the number of voxels along each axis");
    return sizes;
}

}  // namespace deltasplat
