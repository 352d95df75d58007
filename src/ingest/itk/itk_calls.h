// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

namespace deltasplat {

/// What it means when ITK prints something: MetaIO does so where it fails, and then goes on.
enum class Printed { kIsNothing, kIsError };

/// Calls `work`, which calls ITK or GDCM, one caller at a time. What they would print is caught, by
/// what std::cerr and std::cout write to; what other threads write there meanwhile is lost.
/// @throw Error(kInput) `<file>: got what ITK refuses (<its reason>); expected a sound file` for
///        whatever they throw, std::bad_alloc and Error aside, and for what is printed, if that is
///        an error
void callItk(const std::filesystem::path& file, Printed printed, const std::function<void()>& work);

}  // namespace deltasplat
