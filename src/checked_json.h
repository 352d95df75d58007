// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace deltasplat {

/// Reads JSON that a program of this kind has written, which anybody may have changed.
/// @param where     names the text in messages
/// @param expected  what it should be, likewise
/// @throw Error(kInput) if it is no JSON, or nested deeper than 32 levels, which copying and
/// writing would follow one inside the other; Error(kFailed) if there is not enough memory for it,
/// before any is taken
nlohmann::ordered_json parseCheckedJson(const std::string& text, const std::string& where,
                                        const std::string& expected);

/// The same of a file.
/// @throw Error(kInput) if it is none that can be read
nlohmann::ordered_json readCheckedJson(const std::filesystem::path& file,
                                       const std::string& expected);

}  // namespace deltasplat
