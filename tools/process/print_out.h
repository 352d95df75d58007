// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// Writes text to standard output.
/// @throw Error(kOutput) if that fails
void printOut(const std::string& text);

/// Whether nobody reads what is printed any longer.
bool isReaderGone();

}  // namespace deltasplat
