// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace deltasplat {

/// Returns "0.1.0".
std::string programVersion();

/// Returns name and version of each library in use.
std::vector<std::pair<std::string, std::string>> libraryVersions();

/// Returns what `--version` prints: our version, those of the libraries in use and the SIMD level.
std::string versionText();

}  // namespace deltasplat
