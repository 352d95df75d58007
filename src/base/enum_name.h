// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>

namespace deltasplat {

/// Returns the name of an enumerator; of what is none, the first one's.
/// @param names  in the order of the enumerators, which count from 0 on
template <typename Enum>
std::string enumName(Enum value, std::initializer_list<const char*> names) {
    const auto place = static_cast<std::size_t>(value);
    return names.begin()[place < names.size() ? place : 0];
}

}  // namespace deltasplat
