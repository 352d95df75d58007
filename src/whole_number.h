// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
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

}  // namespace deltasplat
