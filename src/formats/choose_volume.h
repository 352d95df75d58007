// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace deltasplat {

/// Returns which of the `count` >= 1 volumes of a file is to be read, from 0 on.
/// @param axes    "dims 64x64x36x120", for messages
/// @param chosen  what was asked for; empty: the only one
/// @throw Error(kInput) if there is no such volume, or several and none is chosen
std::int64_t chooseVolume(const std::string& where, const std::string& axes, std::int64_t count,
                          const std::optional<std::int64_t>& chosen);

}  // namespace deltasplat
