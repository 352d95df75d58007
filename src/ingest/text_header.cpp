// SPDX-License-Identifier: Apache-2.0
#include "ingest/text_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "deltasplat/error.h"
#include "ingest/file_name.h"
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
    const char* const kBlanks = " \t\r";
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string fieldName(const std::string& text) {
    std::string name;
    for (const char c : lowerCase(text)) {
        if (c != ' ' && c != '\t') name += c;
    }
    return name;
}

// The lines of a file, one after the other, none of them longer than is sane.
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
            if (c == '\n') return line;
            line += c;
        }
        return line.empty() ? std::nullopt : std::optional(line);
    }
    std::uint64_t place() const { return place_; }
    const std::string& where() const { return where_; }

  private:
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
    if (line.size() <= most && line.find('\0') == std::string::npos) return;
    refuse(lines.where(), "the header line \"" + printable(line.substr(0, 20)) + "...\"",
           "at most " + std::to_string(most) + " characters of text");
}

// Of a field given twice readers take one or the other.
void addField(const Lines& lines, const std::string& line, std::size_t sign, TextHeader& header) {
    const TextHeader::Field field{fieldName(line.substr(0, sign)), trimmed(line.substr(sign + 1))};
    if (header.find(field.name) != nullptr && field.name != "comment") {
        refuse(lines.where(), "the field " + printable(field.name) + " twice", "each field once");
    }
    header.fields.push_back(field);
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
    if (!line || line->rfind("NRRD", 0) != 0 || trimmed(*line).size() != 8) {
        refuse(lines.where(), "no NRRD header", "a file that begins with NRRD0001 to NRRD0005");
    }
    while ((line = lines.next())) {
        if (trimmed(*line).empty()) break;
        const std::size_t colon = line->find(':');
        const bool comment = (*line)[0] == '#';
        const bool keyValue = colon != std::string::npos && line->compare(colon, 2, ":=") == 0;
        if (comment || keyValue) continue;
        requireSaneLine(lines, *line);
        if (colon == std::string::npos) {
            refuse(lines.where(), "the header line \"" + printable(*line) + "\"",
                   "\"field: value\"");
        }
        addField(lines, *line, colon, header);
    }
    header.dataStart = lines.place();
    return header;
}

TextHeader readMetaHeader(const std::filesystem::path& file) {
    Lines lines(file);
    TextHeader header;
    for (std::optional<std::string> line; (line = lines.next());) {
        if (trimmed(*line).empty()) continue;
        requireSaneLine(lines, *line);
        const std::size_t sign = line->find('=');
        if (sign == std::string::npos) {
            refuse(lines.where(), "the header line \"" + printable(*line) + "\"",
                   "\"Name = value\"");
        }
        addField(lines, *line, sign, header);
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
