// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// Returns foreign text fit for a message, which is one line of UTF-8: what controls a terminal or
/// the order of text, is not seen, or is no UTF-8, is "?" (of bytes that are none, each).
std::string printable(const std::string& text);

}  // namespace deltasplat
