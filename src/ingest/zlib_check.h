// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace deltasplat {

/// Unpacks a zlib or gzip stream that begins at byte `start` of a file, keeps nothing and returns
/// how many bytes it makes. Stops, with a number above `most`, once there are more.
/// @throw Error(kInput) if it is corrupt or cut short
std::uint64_t unpackedBytes(const std::filesystem::path& file, std::uint64_t start,
                            std::uint64_t most);

}  // namespace deltasplat
