// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace deltasplat {

/// Throws Error(kOutput) "<file>: cannot be written: <what the system says about `systemError`>".
[[noreturn]] void throwCannotWrite(const std::filesystem::path& file, int systemError);

/// Throws Error(kOutput) "<file>: cannot be written: there is no folder <folder>".
[[noreturn]] void throwNoFolder(const std::filesystem::path& file,
                                const std::filesystem::path& folder);

}  // namespace deltasplat
