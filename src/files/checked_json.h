// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>

#include "deltasplat/error.h"

namespace deltasplat {

/// Returns a whole number of JSON. (The parser itself converts any number, whatever comes of it.)
/// @throw Error(kInput) if it is no whole number, or one that a T cannot hold
template <typename T, typename Json>
T wholeNumberOf(const Json& json) {
    if (json.is_number_unsigned()) {
        const auto value = json.template get<std::uint64_t>();
        if (std::in_range<T>(value)) return T(value);
    } else if (json.is_number_integer()) {
        const auto value = json.template get<std::int64_t>();
        if (std::in_range<T>(value)) return T(value);
    }
    throw Error(ErrorCode::kInput, "no whole number, or one that is too large");
}

/// Reads JSON that this program has written and that anybody may have changed.
/// @param where     names the text in messages
/// @param expected  says in messages what the text should be
/// @throw Error(kInput) if it is no JSON, or nested deeper than 32 levels, because copying and
/// writing
///        recurse; Error(kFailed) if memory does not hold it, before any is taken
nlohmann::ordered_json parseCheckedJson(const std::string& text, const std::string& where,
                                        const std::string& expected);

/// The same for a file.
/// @throw Error(kInput) if the file cannot be read
nlohmann::ordered_json readCheckedJson(const std::filesystem::path& file,
                                       const std::string& expected);

}  // namespace deltasplat
