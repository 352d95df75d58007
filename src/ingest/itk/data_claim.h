// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace deltasplat {

/// What a NRRD or MetaImage header says about its data, before ITK has seen it.
struct DataClaim {
    enum class Encoding { kRaw, kGzip, kText };
    std::vector<std::int64_t> sizes;
    std::filesystem::path dataFile;
    std::uint64_t dataStart = 0;  ///< place in that file
    std::uint64_t dataBytes = 0;  ///< as they lie there
    Encoding encoding = Encoding::kRaw;
    std::uint64_t skippedBytes = 0;  ///< of unpacked data, before the first value
    std::string space;               ///< "RAS", "LAS", "LPS" or empty
};

/// Reads the claim of a .nrrd or .nhdr file.
/// @throw Error(kInput) if it cannot be read or meant, or names no data file that is there
DataClaim claimOfNrrd(const std::filesystem::path& file);

/// Reads the claim of a .mhd or .mha file; throws likewise.
DataClaim claimOfMeta(const std::filesystem::path& file);

}  // namespace deltasplat
