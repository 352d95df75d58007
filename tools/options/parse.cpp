// SPDX-License-Identifier: Apache-2.0
#include "options/parse.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/text.h"
#include "deltasplat/error.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

constexpr double kLeastPositive = 1e-30;
constexpr double kMostPositive = 1e30;

[[noreturn]] void refuse(const std::string& option, const std::string& text,
                         const std::string& expected) {
    throw Error(ErrorCode::kUsage, option, text.empty() ? "nothing" : text, expected);
}

// Takes a number only if it is the whole text, so that "12x" is never 12.
template <class T>
std::optional<T> toNumber(std::string_view text) {
    T value{};
    const char* const end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, value);
    if (problem != std::errc() || stop != end) return {};
    if constexpr (std::is_floating_point_v<T>) {
        if (!std::isfinite(value)) return {};
    }
    return value;
}

// Splits at the separator; empty as a whole if any part is no number.
template <class T>
std::vector<T> toNumbers(const std::string& text, char separator) {
    std::vector<T> values;
    for (const std::string& part : splitAt(text, separator)) {
        const std::optional<T> value = toNumber<T>(part);
        if (!value) return {};
        values.push_back(*value);
    }
    return values;
}

std::string rangeText(const std::string& kind, double min, double max) {
    const bool bounded[] = {std::isfinite(min), std::isfinite(max)};
    if (bounded[0] && bounded[1]) {
        return kind + " from " + numberText(min) + " to " + numberText(max);
    }
    if (bounded[0]) return kind + " of at least " + numberText(min);
    return kind;
}

Parser<glm::dvec3> threeNumbers(double min, double max, const std::string& expected) {
    return [=](const std::string& option, const std::string& text) {
        const std::vector<double> v = toNumbers<double>(text, ',');
        const auto inRange = [=](double x) { return x >= min && x <= max; };
        if (v.size() != 3 || !std::all_of(v.begin(), v.end(), inRange))
            refuse(option, text, expected);
        return glm::dvec3(v[0], v[1], v[2]);
    };
}

}  // namespace

std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
        parts.push_back(text.substr(begin, end - begin));
    parts.push_back(text.substr(begin));
    return parts;
}

std::string joinNumbers(const std::vector<double>& values, const std::string& separator) {
    std::string text;
    // A zero with a sign is a zero.
    for (const double value : values)
        text += (text.empty() ? "" : separator) + numberText(value + 0.0);
    return text;
}

std::string joinWords(const std::vector<std::string>& words, const std::string& last) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 == words.size() ? " " + last + " " : ", ";
        text += words[i];
    }
    return text;
}

std::string joinNames(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

Parser<std::string> anyText() {
    return [](const std::string&, const std::string& text) { return text; };
}

Parser<std::string> choice(std::vector<std::string> words) {
    return [words = std::move(words)](const std::string& option, const std::string& text) {
        if (std::find(words.begin(), words.end(), text) == words.end())
            refuse(option, text, joinWords(words, "or") + afterStop(suggestion(text, words)));
        return text;
    };
}

Parser<double> number(double min, double max) {
    return [=](const std::string& option, const std::string& text) {
        const std::optional<double> value = toNumber<double>(text);
        if (!value || *value < min || *value > max)
            refuse(option, text, rangeText("a finite number", min, max));
        return *value;
    };
}

Parser<std::int64_t> wholeNumber(std::int64_t min, std::int64_t max) {
    return [=](const std::string& option, const std::string& text) {
        const std::optional<std::int64_t> value = toNumber<std::int64_t>(text);
        const bool unbounded = max == std::numeric_limits<std::int64_t>::max();
        if (!value || *value < min || *value > max) {
            refuse(option, text,
                   "a whole number " +
                       (unbounded ? "of at least " + std::to_string(min)
                                  : "from " + std::to_string(min) + " to " + std::to_string(max)));
        }
        return *value;
    };
}

Parser<std::uint64_t> byteCount() {
    return [](const std::string& option, const std::string& text) {
        const std::string units = "KMGT";
        const std::size_t unit = text.empty() ? std::string::npos : units.find(text.back());
        const bool scaled = unit != std::string::npos;
        const auto value = toNumber<double>(scaled ? text.substr(0, text.size() - 1) : text);
        const double bytes = value.value_or(0) * (scaled ? std::exp2(10.0 * double(unit + 1)) : 1);
        if (!(bytes >= 1 && bytes < 0x1p62))
            refuse(option, text, "a number of bytes, such as 500000000, 400M or 1.5G");
        return std::uint64_t(bytes);
    };
}

Parser<glm::dvec3> vector3(double most) {
    return threeNumbers(
        -most, most, "X,Y,Z, three numbers from " + numberText(-most) + " to " + numberText(most));
}

Parser<glm::dvec2> vector2(double most) {
    return [=](const std::string& option, const std::string& text) {
        const std::vector<double> v = toNumbers<double>(text, ',');
        const auto inRange = [=](double x) { return std::abs(x) <= most; };
        if (v.size() != 2 || !std::all_of(v.begin(), v.end(), inRange))
            refuse(option, text, rangeText("X,Y, two numbers", -most, most));
        return glm::dvec2(v[0], v[1]);
    };
}

Parser<glm::dmat4> matrix4() {
    return [](const std::string& option, const std::string& text) {
        std::string list = text;
        std::replace(list.begin(), list.end(), ' ', ',');
        const std::vector<double> v = toNumbers<double>(list, ',');
        if (v.size() != 16)
            refuse(option, text, "16 finite numbers, row by row, with commas between");
        glm::dmat4 matrix;
        // Rows of the one are columns of the other.
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = v[std::size_t(i)];
        return matrix;
    };
}

Parser<double> positiveLength() {
    return number(kLeastPositive, kMostPositive);
}

Parser<glm::dvec2> lengthPair() {
    return [](const std::string& option, const std::string& text) {
        const std::vector<double> v = toNumbers<double>(text, 'x');
        const auto inRange = [](double x) { return x >= kLeastPositive && x <= kMostPositive; };
        if (v.size() != 2 || !std::all_of(v.begin(), v.end(), inRange))
            refuse(option, text, rangeText("WxH, two numbers", kLeastPositive, kMostPositive));
        return glm::dvec2(v[0], v[1]);
    };
}

Parser<double> angleOfView() {
    return [](const std::string& option, const std::string& text) {
        const std::optional<double> value = toNumber<double>(text);
        if (!value || !(*value > 0 && *value < 180))
            refuse(option, text, "a number of degrees greater than 0 and less than 180");
        return *value;
    };
}

Parser<double> angle() {
    return number(-1e6, 1e6);
}

Parser<glm::dvec3> voxelSpacing() {
    return threeNumbers(1 / kMostLength, kMostLength, "X,Y,Z, three numbers from 1e-15 to 1e+15");
}

Parser<glm::dvec2> interval() {
    return [](const std::string& option, const std::string& text) {
        const std::vector<double> v = toNumbers<double>(text, ',');
        if (v.size() != 2 || !(v[0] < v[1]))
            refuse(option, text, "LO,HI, two finite numbers with LO < HI");
        return glm::dvec2(v[0], v[1]);
    };
}

Parser<glm::vec4> color() {
    return [](const std::string& option, const std::string& text) {
        std::vector<double> v = toNumbers<double>(text, ',');
        if (v.size() == 3) v.push_back(1);
        // A name, or what stands in a style sheet.
        const bool isWord = !text.empty() && (text[0] == '#' || std::isalpha(text[0] & 0x7f) != 0);
        if (v.size() != 4 || *std::min_element(v.begin(), v.end()) < 0 || v[3] > 1)
            refuse(
                option, text,
                std::string("R,G,B or R,G,B,A, numbers of at least 0 and A at most 1") +
                    (isWord ? ", scene-linear: 1,1,1 is white, 0.216,0.216,0.216 is #808080" : ""));
        return glm::vec4(v[0], v[1], v[2], v[3]);
    };
}

Parser<glm::ivec2> pixelSize(const std::string& form) {
    return [form](const std::string& option, const std::string& text) {
        const std::vector<int> v = toNumbers<int>(text, 'x');
        if (v.size() != 2 || v[0] < 1 || v[1] < 1)
            refuse(option, text, form + ", two whole numbers from 1 to 2147483647");
        return glm::ivec2(v[0], v[1]);
    };
}

Parser<glm::i64vec3> dimensions() {
    return [](const std::string& option, const std::string& text) {
        const std::vector<std::int64_t> v = toNumbers<std::int64_t>(text, 'x');
        if (v.size() != 3) refuse(option, text, "AxBxC, three whole numbers");
        return glm::i64vec3(v[0], v[1], v[2]);
    };
}

}  // namespace deltasplat
