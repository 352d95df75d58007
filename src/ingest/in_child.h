// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace deltasplat {

/// Runs `work` in a child process, so that what ends the process ends only that: for libraries that
/// do so at foreign bytes. The child prints nothing, has one minute of processor time, and no
/// thread but its own.
/// @param work  writes `bytes` bytes to its argument; returns false, or throws, if it cannot
/// @param to    what it wrote
/// @return whether it was done
bool inChild(std::size_t bytes, const std::function<bool(std::byte*)>& work, std::byte* to);

}  // namespace deltasplat
