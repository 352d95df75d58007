// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace deltasplat {

/// Throws Error(kOutput) "<file>: cannot be written: <what the system says about `systemError`>".
[[noreturn]] void throwCannotWrite(const std::filesystem::path& file, int systemError);

}  // namespace deltasplat
