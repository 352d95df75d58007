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
    std::size_t digits = 0;  ///< at least so many, filled up with zeros

    /// Returns the number in a file's name, or nothing if the name is not of this pattern.
    std::optional<std::uint64_t> numberOf(const std::string& fileName) const;
    /// Returns the file name with this number.
    std::string nameOf(std::uint64_t number) const;
};

/// Returns the pattern in a file's name: the last run of `#`, or else `%d` or `%0Nd`. Behind a `\`
/// a sign is no part of one.
std::optional<StackPattern> stackPattern(const std::filesystem::path& input);

/// Returns the files of a pattern in the order of their numbers.
/// @throw Error(kInput) if there is none, or the numbers are not evenly spaced: one is missing
std::vector<std::filesystem::path> stackFiles(const std::filesystem::path& input,
                                              const StackPattern& pattern);

/// Returns a name with each number in it as one "#".
std::string withoutNumbers(const std::string& name);

/// Of names that differ in one number only, the numbers have to be evenly spaced.
/// @throw Error(kInput) if one is missing, or twice there
void requireNoHole(const std::filesystem::path& folder,
                   const std::vector<std::filesystem::path>& files);

/// The order of sortByNumbers.
bool namedBefore(const std::filesystem::path& a, const std::filesystem::path& b);

/// Sorts names so that numbers in them count as numbers: slice9 comes before slice10.
void sortByNumbers(std::vector<std::filesystem::path>& files);

}  // namespace deltasplat
