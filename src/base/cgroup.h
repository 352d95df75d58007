// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace deltasplat {

/// Returns the bytes of memory that the cgroups which this process is in, each within the next,
/// leave it: the least of all limits, less what is in use there and is no page cache, which makes
/// room by itself. Both versions of cgroups, wherever they are mounted. The largest number if there
/// is no limit.
/// @param root  "/", or where a test keeps what stands there
std::uint64_t cgroupAvailable(const std::filesystem::path& root);

/// Returns how many processors' time those cgroups leave the process, rounded up: the least of all
/// limits. The largest number if there is no limit.
int cgroupProcessors(const std::filesystem::path& root);

}  // namespace deltasplat
