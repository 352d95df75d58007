// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// A file name with a counter: `slice.####.png` or `slice.%04d.png`.
struct StackPattern {
    std::filesystem::path folder;
    std::string before;      ///< "slice."
    std::string after;       ///< ".png"
    std::size_t digits = 0;  ///< at least, padded with zeros

    /// Returns the number in a file name; nothing if the name does not match.
    std::optional<std::uint64_t> numberOf(const std::string& fileName) const;
    std::string nameOf(std::uint64_t number) const;
};

/// Finds the last run of `#` in a file's name, or else `%d` or `%0Nd`; not after a `\`.
std::optional<StackPattern> stackPattern(const std::filesystem::path& input);

/// Returns the files that match a pattern, in numeric order.
/// @throw Error(kInput) if no file matches, or numbers are unevenly spaced because one is missing
std::vector<std::filesystem::path> stackFiles(const std::filesystem::path& input,
                                              const StackPattern& pattern);

/// Replaces each number in a name by one "#".
std::string withoutNumbers(const std::string& name);

/// Requires even spacing of the numbers in names that differ in one number only.
/// @throw Error(kInput) if a number is missing or occurs twice
void requireNoHole(const std::filesystem::path& folder,
                   const std::vector<std::filesystem::path>& files);

/// Compares names in the order of sortByNumbers.
bool namedBefore(const std::filesystem::path& a, const std::filesystem::path& b);

/// Sorts names so that numbers in them count as numbers: slice9 comes before slice10.
void sortByNumbers(std::vector<std::filesystem::path>& files);

}  // namespace deltasplat
