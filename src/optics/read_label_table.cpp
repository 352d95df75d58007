// SPDX-License-Identifier: Apache-2.0
// Based on: the documentation of 3D Slicer's colour tables (.ctbl) and of ITK-SNAP's label
// description files.
#include "optics/read_label_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "optics/located_json.h"

namespace deltasplat {
namespace {

// The words of a line; one in double quotes may have spaces, and keeps its first quote. Without
// any, the line is malformed.
std::vector<std::string> wordsOf(const std::string& line) {
    constexpr const char* kSpaces = " \t\r\v\f";
    std::vector<std::string> words;
    for (std::size_t at = line.find_first_not_of(kSpaces); at != std::string::npos;
         at = line.find_first_not_of(kSpaces, at)) {
        const bool quoted = line[at] == '"';
        const std::size_t end =
            quoted ? line.find('"', at + 1) : line.find_first_of(kSpaces, at + 1);
        if (quoted && end == std::string::npos) return {};
        words.push_back(line.substr(at, end - at));
        at = quoted ? end + 1 : std::min(end, line.size());
    }
    return words;
}

std::optional<double> numberOf(const std::string& word) {
    double number = 0;
    const char* end = word.data() + word.size();
    const auto result = std::from_chars(word.data(), end, number);
    if (result.ec != std::errc() || result.ptr != end || !std::isfinite(number)) return {};
    return number;
}

// The numbers of a line: label, red, green, blue, 0..255, and opacity, 0..1.
using Numbers = std::vector<std::optional<double>>;

bool isOfSnap(const std::vector<std::string>& words) {
    return words.size() == 8 && words[7].front() == '"';
}

// 3D Slicer: label, name, red, green, blue, alpha 0..255, which may be missing. ITK-SNAP: label,
// red, green, blue, alpha 0..1, visible, mesh visible, "name".
std::optional<LabelLook> lookOf(const std::vector<std::string>& words) {
    const bool snap = isOfSnap(words);
    if (!snap && words.size() != 5 && words.size() != 6) return {};
    Numbers numbers;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (i != (snap ? 7 : 1)) numbers.push_back(numberOf(words[i]));
    if (words.size() == 5) numbers.emplace_back(255);
    const auto isMissing = [](const auto& number) { return !number; };
    if (std::any_of(numbers.begin(), numbers.end(), isMissing)) return {};

    constexpr double kMostLabel = 1e9;
    const double label = *numbers[0];
    LabelLook look;
    for (int c = 0; c < 3; ++c) look.rgb[c] = *numbers[std::size_t(c) + 1] / 255;
    look.opacity = snap ? *numbers[4] * (*numbers[5] != 0 ? 1 : 0) : *numbers[4] / 255;
    const auto isShare = [](double v) { return v >= 0 && v <= 1; };
    if (label != std::floor(label) || std::abs(label) > kMostLabel || !isShare(look.opacity) ||
        !isShare(look.rgb.r) || !isShare(look.rgb.g) || !isShare(look.rgb.b))
        return {};
    look.label = int(label);
    return look;
}

// As much of a line as a message can hold.
std::string quoted(const std::string& line) {
    constexpr std::size_t kMost = 60;
    if (line.size() <= kMost) return '"' + line + '"';
    std::size_t end = kMost;
    // Not within a character of UTF-8.
    while (end > 0 && (std::uint8_t(line[end]) & 0xC0) == 0x80) --end;
    return '"' + line.substr(0, end) + "...\"";
}

[[noreturn]] void refuse(const std::filesystem::path& file, int number, const std::string& line) {
    throw Error(ErrorCode::kInput, file.string() + ":" + std::to_string(number), quoted(line),
                "label, name, red, green, blue and perhaps alpha (0..255), or label, "
                "red, green, blue (0..255), alpha (0..1), visible, mesh, \"name\"");
}

// @param ofSlicer  whether alpha is 0..255, as in FreeSurfer's tables, which look the same
void warnOfClear(const std::filesystem::path& file, bool ofSlicer, const Listener& listener) {
    listener.warn(file.string() + ": all labels are clear" +
                  (ofSlicer ? ", for each has an alpha of 0; where that means opaque, as in tables "
                              "of FreeSurfer, replace it by 255"
                            : ", for each is hidden or has an alpha of 0"));
}

// A label as a table has it.
struct LabelLine {
    LabelLook look;
    std::string name;
};

std::string nameOf(const std::vector<std::string>& words) {
    const std::string& word = words[isOfSnap(words) ? 7 : 1];
    return word.substr(word.front() == '"' ? 1 : 0);
}

struct LabelLines {
    std::map<int, LabelLine> lines;  // by label
    bool ofSlicer = false;
};

LabelLines readLines(const std::filesystem::path& file) {
    std::istringstream in(readSmallText(file, "a table of labels"));
    LabelLines result;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        while (!line.empty() && std::isspace(std::uint8_t(line.back()))) line.pop_back();
        const std::size_t first = line.find_first_not_of(" \t\v\f");
        if (first == std::string::npos || line[first] == '#') continue;
        const std::vector<std::string> words = wordsOf(line);
        const std::optional<LabelLook> look = lookOf(words);
        if (!look) refuse(file, number, line);
        result.lines[look->label] = {*look, nameOf(words)};
        result.ofSlicer = !isOfSnap(words);
    }
    if (result.lines.empty())
        throw Error(ErrorCode::kInput, file.string(), "no labels", "at least one");
    return result;
}

}  // namespace

std::map<int, std::string> readLabelNames(const std::filesystem::path& file) {
    std::map<int, std::string> names;
    for (const auto& [label, line] : readLines(file).lines) names[label] = line.name;
    return names;
}

LabelList readLabelList(const std::filesystem::path& file) {
    LabelList list;
    for (const auto& [label, line] : readLines(file).lines) {
        if (label != 0) list.entries.push_back({label, line.name, line.look.rgb});
    }
    return list;
}

TransferFunction readLabelTable(const std::filesystem::path& file, const Listener& listener) {
    const LabelLines table = readLines(file);
    std::vector<LabelLook> rising;
    for (const auto& [label, line] : table.lines) rising.push_back(line.look);
    const auto isClear = [](const LabelLook& look) { return look.opacity == 0; };
    if (std::all_of(rising.begin(), rising.end(), isClear))
        warnOfClear(file, table.ofSlicer, listener);
    TransferFunction function = labelFunction(rising);
    function.name = file.stem().string();
    return function;
}

}  // namespace deltasplat
