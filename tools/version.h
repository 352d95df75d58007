// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace deltasplat {

/// Returns "0.1.0".
std::string programVersion();

/// Returns what `--version` prints: our version, those of the libraries in use and the SIMD level.
std::string versionText();

}  // namespace deltasplat
