// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace deltasplat {

/// Returns a number by which one text is told from another, nearly always: the hash FNV-1a (Fowler,
/// Noll, Vo).
std::uint64_t hashOf(std::string_view text, std::uint64_t before = 0xcbf29ce484222325);

/// Returns such a number of a file, whatever its name: of its size, its first bytes and its last.
/// Of what is no file, or cannot be read, it is 0.
std::uint64_t markOf(const std::filesystem::path& file);

}  // namespace deltasplat
