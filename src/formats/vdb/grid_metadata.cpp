// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/grid_metadata.h"

#include <openvdb/Grid.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>
#include <utility>

#include "base/text.h"

namespace deltasplat {

namespace {

// A line of its own: what would end it is a blank.
std::string inLine(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    }
    return text;
}

// Takes the next word of a line and the blank behind it.
std::string takeWord(std::string& line) {
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string word = line.substr(0, end);
    line.erase(0, std::min(end + 1, line.size()));
    return word;
}

template <typename T>
bool read(const std::string& word, T& number) {
    const char* const end = word.data() + word.size();
    const auto result = std::from_chars(word.data(), end, number);
    return result.ec == std::errc{} && result.ptr == end;
}

std::optional<LabelEntry> labelOf(std::string line) {
    LabelEntry label;
    if (!read(takeWord(line), label.value)) return {};
    std::string word = takeWord(line);
    if (word != "-") {
        glm::dvec3 rgb(0);
        for (int channel = 0; channel < 3; ++channel) {
            if (channel > 0) word = takeWord(line);
            if (!read(word, rgb[channel]) || !(rgb[channel] >= 0 && rgb[channel] <= 1)) return {};
        }
        label.rgb = rgb;
    }
    label.name = line;
    return label;
}

}  // namespace

std::string labelText(const LabelList& labels) {
    std::string text;
    for (const LabelEntry& label : labels.entries) {
        text += std::to_string(label.value) + " ";
        text += label.rgb ? numberText(label.rgb->r) + " " + numberText(label.rgb->g) + " " +
                                numberText(label.rgb->b)
                          : "-";
        text += " " + inLine(label.name) + "\n";
    }
    return text;
}

std::shared_ptr<const LabelList> labelsIn(const VdbMetadata& metadata) {
    const auto text = metadata.get<std::string>(kLabelsKey);
    return text ? labelsOfText(*text) : nullptr;
}

std::shared_ptr<const LabelList> labelsOfText(const std::string& text) {
    auto labels = std::make_shared<LabelList>();
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (std::optional<LabelEntry> label = labelOf(line))
            labels->entries.push_back(std::move(*label));
    }
    return labels;
}

std::string gridClassOf(const VdbMetadata& metadata) {
    constexpr const char* kSpaces = " \t\n\v\f\r";
    const std::string stored = metadata.text(openvdb::GridBase::META_GRID_CLASS);
    const std::size_t begin = stored.find_first_not_of(kSpaces);
    if (begin == std::string::npos) return kUnknownClass;
    const std::string name =
        lowerCase(stored.substr(begin, stored.find_last_not_of(kSpaces) + 1 - begin));
    const bool isKnown = name == kLevelSetClass || name == kFogClass || name == kStaggeredClass;
    return isKnown ? name : kUnknownClass;
}

}  // namespace deltasplat
