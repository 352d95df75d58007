// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "deltasplat/error.h"

namespace deltasplat {

/// @throw Error(kInput) "<file>: got ...; expected ..."
[[noreturn]] inline void refuseFile(const std::filesystem::path& file, const std::string& got,
                                    const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(file.string(), got, expected));
}

}  // namespace deltasplat
