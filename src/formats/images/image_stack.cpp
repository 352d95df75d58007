// SPDX-License-Identifier: Apache-2.0
#include "formats/images/image_stack.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <system_error>

#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_name.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/readers.h"

namespace deltasplat {
namespace {

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::size_t endOfDigits(const std::string& text, std::size_t begin) {
    while (begin < text.size() && isDigit(text[begin])) ++begin;
    return begin;
}

bool comesBefore(const std::string& a, const std::string& b) {
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() && j < b.size()) {
        if (!isDigit(a[i]) || !isDigit(b[j])) {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i, ++j;
            continue;
        }
        while (i < a.size() && a[i] == '0') ++i;
        while (j < b.size() && b[j] == '0') ++j;
        const std::size_t digitsA = endOfDigits(a, i) - i;
        const std::size_t digitsB = endOfDigits(b, j) - j;
        if (digitsA != digitsB) return digitsA < digitsB;
        const int order = a.compare(i, digitsA, b, j, digitsB);
        if (order != 0) return order < 0;
        i += digitsA, j += digitsB;
    }
    return a.size() - i < b.size() - j || (a.size() - i == b.size() - j && a < b);
}

}  // namespace

std::optional<std::uint64_t> StackPattern::numberOf(const std::string& fileName) const {
    if (fileName.size() <= before.size() + after.size() || fileName.rfind(before, 0) != 0 ||
        fileName.compare(fileName.size() - after.size(), std::string::npos, after) != 0) {
        return std::nullopt;
    }
    const std::string middle =
        fileName.substr(before.size(), fileName.size() - before.size() - after.size());
    const bool filled = middle.size() == std::max<std::size_t>(digits, 1);
    if (middle.size() < digits || (!filled && middle[0] == '0')) return std::nullopt;
    std::uint64_t number = 0;
    const char* const end = middle.data() + middle.size();
    const auto result = std::from_chars(middle.data(), end, number);
    if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
    return number;
}

std::string StackPattern::nameOf(std::uint64_t number) const {
    std::string middle = std::to_string(number);
    if (middle.size() < digits) middle.insert(0, digits - middle.size(), '0');
    return before + middle + after;
}

namespace {

// Finds the counter in a name such as slice.%04d.png: %d, or %01d to %09d; the last one counts.
std::optional<StackPattern> percentPattern(const std::filesystem::path& folder,
                                           const std::string& name) {
    const std::string signs = maskedEscapes(name);
    std::size_t sign = signs.rfind('%');
    for (; sign != std::string::npos;
         sign = sign == 0 ? std::string::npos : signs.rfind('%', sign - 1)) {
        const bool padded = signs.size() > sign + 3 && signs[sign + 1] == '0' &&
                            signs[sign + 2] >= '1' && signs[sign + 2] <= '9';
        const std::size_t end = sign + (padded ? 3 : 1);
        if (end >= signs.size() || signs[end] != 'd') continue;
        const std::size_t digits = padded ? std::size_t(signs[sign + 2] - '0') : 0;
        return StackPattern{folder, withoutEscapes(name.substr(0, sign)),
                            withoutEscapes(name.substr(end + 1)), digits};
    }
    return std::nullopt;
}

}  // namespace

std::optional<StackPattern> stackPattern(const std::filesystem::path& input) {
    const std::string name = input.filename().string();
    const std::string signs = maskedEscapes(name);
    const std::size_t last = signs.rfind('#');
    if (last != std::string::npos) {
        const std::size_t before = signs.find_last_not_of('#', last);
        const std::size_t first = before == std::string::npos ? 0 : before + 1;
        return StackPattern{input.parent_path(), withoutEscapes(name.substr(0, first)),
                            withoutEscapes(name.substr(last + 1)), last + 1 - first};
    }
    return percentPattern(input.parent_path(), name);
}

namespace {

void requireEvenNumbers(const std::filesystem::path& input, const StackPattern& pattern,
                        const std::map<std::uint64_t, std::filesystem::path>& files) {
    if (files.size() < 2) return;
    std::uint64_t step = UINT64_MAX;
    for (auto file = files.begin(); std::next(file) != files.end(); ++file) {
        step = std::min(step, std::next(file)->first - file->first);
    }
    std::uint64_t wanted = files.begin()->first;
    for (const auto& [number, file] : files) {
        if (number != wanted) {
            throw Error(ErrorCode::kInput, input.string(),
                        "no file " + printable(pattern.nameOf(wanted)),
                        std::to_string(files.size()) + " or more numbers in a row");
        }
        wanted += step;
    }
}

}  // namespace

std::vector<std::filesystem::path> stackFiles(const std::filesystem::path& input,
                                              const StackPattern& pattern) {
    std::map<std::uint64_t, std::filesystem::path> found;
    std::error_code error;
    const std::filesystem::path folder = pattern.folder.empty() ? "." : pattern.folder;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (const auto number = pattern.numberOf(name)) found[*number] = pattern.folder / name;
    }
    if (found.empty()) {
        throw Error(ErrorCode::kInput, input.string(), "no file of that name",
                    "files such as " + pattern.nameOf(1));
    }
    requireEvenNumbers(input, pattern, found);
    std::vector<std::filesystem::path> files;
    for (const auto& [number, file] : found) files.push_back(file);
    return files;
}

namespace {

std::vector<std::pair<std::size_t, std::size_t>> numbersIn(const std::string& name) {
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (!isDigit(name[i])) continue;
        const std::size_t end = endOfDigits(name, i);
        runs.emplace_back(i, end);
        i = end;
    }
    return runs;
}

std::string runOf(const std::string& name, std::size_t run) {
    const auto [begin, end] = numbersIn(name)[run];
    return name.substr(begin, end - begin);
}

// For names that differ in numbers only: if a single number differs, they are a stack.
void requireEvenNames(const std::filesystem::path& folder, const std::vector<std::string>& names) {
    std::vector<std::size_t> counters;
    const auto runs = numbersIn(names.front());
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const std::string first = runOf(names.front(), run);
        const bool same = std::all_of(names.begin(), names.end(), [&](const std::string& name) {
            return runOf(name, run) == first;
        });
        if (!same) counters.push_back(run);
    }
    if (counters.size() != 1) return;
    const auto [begin, end] = runs[counters[0]];
    StackPattern pattern{folder, names.front().substr(0, begin), names.front().substr(end),
                         end - begin};
    std::map<std::uint64_t, std::filesystem::path> found;
    for (const std::string& name : names) {
        const std::string digits = runOf(name, counters[0]);
        std::uint64_t number = 0;
        const char* const last = digits.data() + digits.size();
        if (std::from_chars(digits.data(), last, number).ec != std::errc{}) return;
        pattern.digits = std::min(pattern.digits, digits.size());
        if (found.emplace(number, name).second) continue;
        throw Error(ErrorCode::kInput, folder.string(),
                    printable(found[number].string()) + " and " + printable(name) +
                        ", the same number twice",
                    "each number once");
    }
    requireEvenNumbers(folder, pattern, found);
}

}  // namespace

std::string withoutNumbers(const std::string& name) {
    std::string text;
    std::size_t copied = 0;
    for (const auto& [begin, end] : numbersIn(name)) {
        text += name.substr(copied, begin - copied) + '#';
        copied = end;
    }
    return text + name.substr(copied);
}

void requireNoHole(const std::filesystem::path& folder,
                   const std::vector<std::filesystem::path>& files) {
    std::map<std::string, std::vector<std::string>> alike;
    for (const std::filesystem::path& file : files) {
        const std::string name = file.filename().string();
        alike[withoutNumbers(file.stem().string())].push_back(name);
    }
    for (const auto& [text, names] : alike) requireEvenNames(folder, names);
}

bool namedBefore(const std::filesystem::path& a, const std::filesystem::path& b) {
    return comesBefore(a.filename().string(), b.filename().string());
}

void sortByNumbers(std::vector<std::filesystem::path>& files) {
    std::sort(files.begin(), files.end(), namedBefore);
}

namespace {

DenseSource openStack(const std::filesystem::path& input, const InputKind& kind,
                      const ReadOptions& options, const Listener& listener) {
    return openImages(input, kind.name, kind.files, options, listener);
}

}  // namespace

const Format& imageFormat() {
    static const Format format{
        .extensions = {".tif", ".tiff", ".png", ".jpg", ".jpeg", ".bmp", ".pgm", ".exr"},
        .mayBePacked = false,
        .saysPlace = false,
        .open = openStack};
    return format;
}

}  // namespace deltasplat
