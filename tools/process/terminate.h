// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

namespace deltasplat {

/// Returns what an exception says, and if it is that a thread or process could not be started, what
/// that may come from.
std::string describe(const std::exception& problem);

/// What nobody catches, as in a thread of a library's or while libraries are loaded, ends the
/// program like any other failure: with one line on standard error, this exit code (1 unless set)
/// and no temporary file. That is so from the beginning, before main().
void setTerminateExitCode(int code);

/// Returns how many threads can be started at once besides those there are, at most `most`; by
/// starting them.
int startableThreads(int most);

}  // namespace deltasplat
