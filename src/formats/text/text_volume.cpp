// SPDX-License-Identifier: Apache-2.0
#include "formats/text/text_volume.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <system_error>

#include "base/text.h"
#include "files/file_name.h"
#include "formats/text/text_header.h"
#include "volume/length_unit.h"

namespace deltasplat {
namespace {

constexpr std::int64_t kMostBytes = std::int64_t{1} << 62;

// The unit that stands for all: that of each if they are one, else millimetres if all are known.
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
    // Names that begin with "c:" or "~" are not looked up beside the header by other programs.
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
