// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace deltasplat {

/// What the header of a .png or .bmp says of its numbers.
struct StoredNumbers {
    int bits = 8;            ///< of a number: 1, 2, 4, 8 or 16; of a .bmp as it is read
    bool isPalette = false;  ///< whether they are those of a palette's colours
    /// Of a palette: what stands at which places of a file whose numbers are greys.
    std::vector<std::pair<std::uint64_t, std::string>> asGreys;
};

/// Returns nothing for what has another extension, or no such header.
std::optional<StoredNumbers> storedNumbers(const std::filesystem::path& file);

}  // namespace deltasplat
