// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

namespace deltasplat {

/// Calls `work`, which calls ITK or GDCM. What they would print is dropped.
/// @throw Error(kInput) `<file>: got what ITK refuses (<its reason>); expected a sound file` for
///        whatever they throw, std::bad_alloc and Error aside
void callItk(const std::filesystem::path& file, const std::function<void()>& work);

}  // namespace deltasplat
