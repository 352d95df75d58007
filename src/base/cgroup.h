// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace deltasplat {

/// Returns the bytes of memory that the cgroups of this process leave it: the least of all limits,
/// less the memory in use there. Page cache does not count, because it makes room by itself. Reads
/// both versions of cgroups, wherever they are mounted. Without a limit: the largest number.
/// @param root  "/", or a test's folder with the same files
std::uint64_t cgroupAvailable(const std::filesystem::path& root);

/// Returns the number of processors whose time these cgroups leave the process, rounded up. Without
/// a limit: the largest number.
int cgroupProcessors(const std::filesystem::path& root);

}  // namespace deltasplat
