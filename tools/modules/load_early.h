// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <thread>

namespace deltasplat {

/// Loads what a picture of this name is written by, or a volume kept as it is stored, if there is
/// something to load, beside what comes before that is needed. Joins when it is destroyed; what
/// goes wrong is said when it is used.
std::jthread loadEarly(const std::filesystem::path& file);

}  // namespace deltasplat
