// SPDX-License-Identifier: Apache-2.0
#include "optics/label_function.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "optics/located_json.h"

namespace deltasplat {

std::optional<double> anyBroken(const Volume& volume) {
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] == 0) continue;
        const double value = volume.codeBook().valueOf(Code(code));
        if (value != std::floor(value)) return value;
    }
    return {};
}

bool holdsLabels(const Volume& volume) {
    return volume.labels() && !anyBroken(volume);
}

TransferFunction labelFunction(const std::vector<LabelLook>& looks) {
    TransferFunction function;
    function.categorical = true;
    // Of several points at the same place the last one counts.
    function.opacities = {{looks.front().label - 0.5, 0, 0.5, 0}};
    for (const LabelLook& look : looks) {
        const double begin = look.label - 0.5;
        const double end = look.label + 0.5;
        for (const double x : {begin, end}) function.colors.push_back({x, look.rgb});
        auto& opacities = function.opacities;
        const std::size_t last = opacities.size() - 1;
        if (last > 0 && opacities[last].x == begin && opacities[last - 1].opacity == look.opacity) {
            // Equal opacity needs no step between the labels.
            opacities.resize(last - 1);
        } else {
            if (opacities.back().x < begin) opacities.push_back({begin, 0, 0.5, 0});
            opacities.push_back({begin, look.opacity, 0.5, 0});
        }
        opacities.push_back({end, look.opacity, 0.5, 0});
        opacities.push_back({end, 0, 0.5, 0});
    }
    return function;
}

TransferFunction withColors(const TransferFunction& function, const LabelList& labels) {
    TransferFunction colored = function;
    for (const LabelEntry& label : labels.entries) {
        if (!label.rgb) continue;
        // Each label has a colour at either end.
        const auto begin = std::ranges::lower_bound(colored.colors, double(label.value) - 0.5, {},
                                                    &TransferFunction::ColorPoint::x);
        if (std::distance(begin, colored.colors.end()) < 2 || begin->x != double(label.value) - 0.5)
            continue;
        // The previous label ends at the same place.
        const auto own = begin[1].x == begin->x ? begin + 1 : begin;
        if (std::distance(colored.colors.begin(), own) % 2 != 0) continue;
        own[0].rgb = own[1].rgb = *label.rgb;
    }
    return colored;
}

std::vector<LabelLook> looksOf(const TransferFunction& function) {
    std::vector<LabelLook> looks;
    for (std::size_t i = 0; i + 1 < function.colors.size(); i += 2) {
        const double label = 0.5 * (function.colors[i].x + function.colors[i + 1].x);
        looks.push_back({int(label), function.colors[i].rgb, function.opacityAt(label)});
    }
    return looks;
}

namespace {

// The labels of one kind of change, and the option's name.
struct NamedLabels {
    const char* name;
    std::set<int> labels;
};

std::vector<NamedLabels> namedLabels(const LabelChanges& changes) {
    std::vector<NamedLabels> all = {{"`labels.hidden`", changes.hidden},
                                    {"`labels.shown`", changes.shown},
                                    {"`labels.opacities`", {}}};
    for (const auto& [label, opacity] : changes.opacities) all[2].labels.insert(label);
    std::erase_if(all, [](const NamedLabels& one) { return one.labels.empty(); });
    return all;
}

std::string listOf(const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "" : ", ") + numberText(number);
    return text;
}

std::set<int> labelsOf(const TransferFunction& table) {
    std::set<int> labels;
    for (const LabelLook& look : looksOf(table)) labels.insert(look.label);
    return labels;
}

bool isThere(double label, const Volume& volume) {
    const Code code = volume.codeBook().codeOf(label);
    return volume.codeBook().valueOf(code) == label && volume.histogram()[code] > 0;
}

bool isClear(int label, const LabelChanges& changes) {
    const bool isShown = changes.shown.empty() || changes.shown.contains(label);
    return !isShown || changes.hidden.contains(label);
}

}  // namespace

TransferFunction changeLabels(const TransferFunction& function, const LabelChanges& changes) {
    if (changes.empty()) return function;
    if (!function.categorical) {
        throw Error(ErrorCode::kUsage, namedLabels(changes).front().name,
                    "a transfer function of values", "a table of labels");
    }
    std::vector<LabelLook> looks = looksOf(function);
    for (LabelLook& look : looks) {
        const auto opacity = changes.opacities.find(look.label);
        if (opacity != changes.opacities.end()) look.opacity = opacity->second;
        if (isClear(look.label, changes)) look.opacity = 0;
    }
    TransferFunction changed = labelFunction(looks);
    changed.name = function.name;
    return changed;
}

void warnOfAbsentLabels(const LabelChanges& changes, const TransferFunction& table,
                        const Volume& volume, const Listener& listener) {
    if (changes.empty()) return;
    const std::set<int> known = labelsOf(table);
    for (const NamedLabels& named : namedLabels(changes)) {
        std::vector<double> absent[3];
        for (const int label : named.labels) {
            const bool isKnown = known.contains(label);
            const bool isUsed = isThere(label, volume);
            if (!isKnown || !isUsed) absent[isUsed ? 0 : isKnown ? 1 : 2].push_back(label);
        }
        const char* places[] = {"the table", "the volume", "the table or the volume"};
        for (int i = 0; i < 3; ++i) {
            if (absent[i].empty()) continue;
            listener.warn(std::string(named.name) + ": no label " + listOf(absent[i]) + " in " +
                          places[i]);
        }
    }
}

void warnOfUnlistedLabels(const LabelChanges& changes, const TransferFunction& table,
                          const Volume& volume, const Listener& listener) {
    const std::set<int> known = labelsOf(table);
    std::set<double> unlisted;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] == 0) continue;
        const double value = volume.codeBook().valueOf(Code(code));
        // Labels reach half way to their neighbours.
        const bool isFar = std::abs(value) > 1e9;
        const int label = isFar ? 0 : int(std::floor(value + 0.5));
        if (value == 0 || known.contains(label)) continue;
        if (isFar || !isClear(label, changes)) unlisted.insert(value);
    }
    if (unlisted.empty()) return;
    constexpr std::size_t kMost = 5;
    const bool areMany = unlisted.size() > kMost + 1;
    auto end = unlisted.begin();
    std::advance(end, areMany ? kMost : unlisted.size());
    const bool isOne = unlisted.size() == 1;
    std::string text = listOf({unlisted.begin(), end});
    if (areMany) text += " and " + std::to_string(unlisted.size() - kMost) + " more";
    listener.warn(std::string("`transferFunction`: ") + (isOne ? "label " : "labels ") + text +
                  " of the volume " + (isOne ? "is" : "are") + " not in the table, and not shown");
}

// Based on: the documentation of 3D Slicer's colour tables (.ctbl) and of ITK-SNAP's label
// description files.
namespace {

// Splits a line into words. Words in quotes keep the first quote; if a quote does not end: none.
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

// Label, red, green, blue (0..255) and opacity (0..1).
using Numbers = std::vector<std::optional<double>>;

bool isOfSnap(const std::vector<std::string>& words) {
    return words.size() == 8 && words[7].front() == '"';
}

// 3D Slicer: label, name, red, green, blue and perhaps alpha, 0..255. ITK-SNAP: label, red, green,
// blue, alpha 0..1, visible, mesh visible, "name".
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

std::string quoted(const std::string& line) {
    constexpr std::size_t kMost = 60;
    if (line.size() <= kMost) return '"' + line + '"';
    std::size_t end = kMost;
    // Do not cut a UTF-8 character.
    while (end > 0 && (std::uint8_t(line[end]) & 0xC0) == 0x80) --end;
    return '"' + line.substr(0, end) + "...\"";
}

[[noreturn]] void refuse(const std::filesystem::path& file, int number, const std::string& line) {
    throw Error(ErrorCode::kInput, file.string() + ":" + std::to_string(number), quoted(line),
                "label, name, red, green, blue and perhaps alpha (0..255), or label, "
                "red, green, blue (0..255), alpha (0..1), visible, mesh, \"name\"");
}

// @param ofSlicer  whether alpha is 0..255. FreeSurfer's tables have the same form.
void warnOfClear(const std::filesystem::path& file, bool ofSlicer, const Listener& listener) {
    listener.warn(file.string() + ": all labels are clear" +
                  (ofSlicer ? ", for each has an alpha of 0; where that means opaque, as in tables "
                              "of FreeSurfer, replace it by 255"
                            : ", for each is hidden or has an alpha of 0"));
}

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
