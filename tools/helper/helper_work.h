// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace deltasplat {

/// Tells the library what the helper is doing, in case that this ends it.
using HelperNote = void (*)(std::string_view text);

/// What a module of the helper does (helper_NAME.so): its function "deltasplat_helper_work".
/// @return whether the answer is to be sent; false, and any exception, end the helper
using HelperWork = bool(std::string_view request, std::string& answer, HelperNote note);

}  // namespace deltasplat

extern "C" deltasplat::HelperWork deltasplat_helper_work;
