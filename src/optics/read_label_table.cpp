// SPDX-License-Identifier: Apache-2.0
// Based on: the documentation of 3D Slicer's colour tables (.ctbl) and of ITK-SNAP's label
// description files.
#include "optics/read_label_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

// The words of a line; one in double quotes may have spaces, and keeps its first quote.
std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> std::ws && !in.eof();) {
        const bool quoted = in.peek() == '"';
        in >> std::quoted(word);
        words.push_back(quoted ? '"' + word : word);
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

// 3D Slicer: label, name, red, green, blue, alpha 0..255. ITK-SNAP: label, red, green, blue, alpha
// 0..1, visible, mesh visible, "name".
std::optional<LabelLook> lookOf(const std::vector<std::string>& words) {
    const bool snap = words.size() >= 8 && words[7].front() == '"';
    if (!snap && words.size() < 5) return {};
    const std::size_t red = snap ? 1 : 2;
    Numbers numbers = {numberOf(words[0])};
    for (std::size_t i = red; i < red + 3; ++i) numbers.push_back(numberOf(words[i]));
    numbers.push_back(words.size() > red + 3 ? numberOf(words[red + 3]) : 255);
    if (snap) numbers.push_back(numberOf(words[5]));
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

}  // namespace

TransferFunction readLabelTable(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in)
        throw Error(ErrorCode::kInput,
                    gotExpected(file.string(), "no file that can be read", "a table of labels"));
    std::map<int, LabelLook> looks;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        const std::vector<std::string> words = wordsOf(line);
        if (words.empty() || words.front().front() == '#') continue;
        const std::optional<LabelLook> look = lookOf(words);
        if (!look) {
            throw Error(ErrorCode::kInput,
                        gotExpected(file.string() + ":" + std::to_string(number),
                                    "\"" + line.substr(0, 60) + "\"",
                                    "label, name, red, green, blue, alpha (0..255), or label, red, "
                                    "green, blue (0..255), alpha (0..1), visible, mesh, \"name\""));
        }
        looks[look->label] = *look;
    }
    if (looks.empty())
        throw Error(ErrorCode::kInput, gotExpected(file.string(), "no labels", "at least one"));
    std::vector<LabelLook> rising;
    for (const auto& [label, look] : looks) rising.push_back(look);
    TransferFunction function = labelFunction(rising);
    function.name = file.stem().string();
    return function;
}

}  // namespace deltasplat
