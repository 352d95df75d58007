// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// Returns foreign text fit for a message, which is one line of UTF-8: what controls a terminal,
/// and each byte that is none of a UTF-8 character, is "?".
std::string printable(const std::string& text);

}  // namespace deltasplat
