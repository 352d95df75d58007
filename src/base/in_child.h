// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace deltasplat {

/// Runs `work` in a child process, so that a library that aborts at foreign bytes ends the child
/// alone. The child prints nothing. It has one minute of processor time, the memory that is left to
/// this process but at most 64 times `bytes` and a GiB, one thread and no signal handlers. It ends
/// with the thread that called this.
/// @param work  writes `bytes` bytes to its argument; returns false, or throws, if it cannot
/// @param to    receives these bytes
/// @param why   if not null: receives the text of the exception that ended the work, at most some
///              kilobytes; empty if there was none
/// @return whether the work was done
/// @throw Error(kFailed) if there can be no child, or if somebody ended it
bool inChild(std::size_t bytes, const std::function<bool(std::byte*)>& work, std::byte* to,
             std::string* why = nullptr);

}  // namespace deltasplat
