// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace deltasplat {

/// Runs `work` in a child process, so that what ends the process ends only that: for libraries that
/// do so at foreign bytes. The child prints nothing, has one minute of processor time, no more
/// memory than is left to this process (nor than 64 times what it writes, and a GiB), no thread but
/// its own and no signal handlers, and ends with the thread that called this.
/// @param work  writes `bytes` bytes to its argument; returns false, or throws, if it cannot
/// @param to    what it wrote
/// @param why   if not null: what the exception says that ended the work, or the child by
///              std::terminate (at most some kilobytes of it); empty if none did
/// @return whether it was done
/// @throw Error(kFailed) if there can be no child, or if somebody ended it
bool inChild(std::size_t bytes, const std::function<bool(std::byte*)>& work, std::byte* to,
             std::string* why = nullptr);

}  // namespace deltasplat
