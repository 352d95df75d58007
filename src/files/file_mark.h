// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace deltasplat {

/// Returns the hash FNV-1a (Fowler, Noll, Vo) of a text.
std::uint64_t hashOf(std::string_view text, std::uint64_t before = 0xcbf29ce484222325);

/// Returns a hash of a file's size, its first bytes and its last ones, which does not depend on its
/// name; 0 where there is no readable file.
std::uint64_t markOf(const std::filesystem::path& file);

}  // namespace deltasplat
