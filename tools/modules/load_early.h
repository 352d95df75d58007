// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <thread>

namespace deltasplat {

/// Loads the module that writes a picture of this name, if there is one to load, beside what comes
/// before the picture is written. Joins when it is destroyed; what goes wrong is said when the
/// module is used.
std::jthread loadEarly(const std::filesystem::path& picture);

}  // namespace deltasplat
