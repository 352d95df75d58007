// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace deltasplat {

/// Returns "a, b, c" for a line that stays one that can be read: of many names the first few, and
/// how many others there are.
std::string nameList(const std::vector<std::string>& names);

}  // namespace deltasplat
