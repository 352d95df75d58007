// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// Returns what the library says in the program's words: it names an option by the field that holds
/// it, in backquotes ("`extinctionScale`: got -1"), the program by its flag ("--extinction: got
/// -1"). What else stands in backquotes stays.
std::string withFlagNames(const std::string& text);

}  // namespace deltasplat
