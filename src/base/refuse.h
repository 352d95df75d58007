// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "deltasplat/error.h"

namespace deltasplat {

/// @throw Error(kInput) "<where>: got ...; expected ..."
[[noreturn]] inline void refuseInput(std::string_view where, std::string_view got,
                                     std::string_view expected) {
    throw Error(ErrorCode::kInput, where, got, expected);
}

/// @throw Error(kUsage) "<where>: got ...; expected ..."
[[noreturn]] inline void refuseUsage(std::string_view where, std::string_view got,
                                     std::string_view expected) {
    throw Error(ErrorCode::kUsage, where, got, expected);
}

}  // namespace deltasplat
