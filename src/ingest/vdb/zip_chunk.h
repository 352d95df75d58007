// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace deltasplat {

/// Unpacks what zlib has packed; returns whether it is whole, by its checksum, and `size` bytes.
/// OpenVDB 10 asks for the size alone.
/// @param values  takes as many at least
bool unpackZip(std::span<const char> chunk, std::span<char> values, std::size_t size);

}  // namespace deltasplat
