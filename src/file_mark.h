// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace deltasplat {

/// Returns a number by which one file is told from another, nearly always: of its size, its first
/// bytes and its last, whatever its name. Of what is no file, or cannot be read, it is 0. Based on:
/// the hash FNV-1a (Fowler, Noll, Vo).
std::uint64_t markOf(const std::filesystem::path& file);

}  // namespace deltasplat
