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

/// Returns a whole number of JSON, which would convert any number to one, whatever came of it.
/// @throw Error(kInput) for anything else, or one that a T cannot hold
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
