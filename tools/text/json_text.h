// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace deltasplat {

/// Takes the sign off zeros.
inline void takeSignsOffZeros(nlohmann::ordered_json& json) {
    if (json.is_structured())
        for (nlohmann::ordered_json& part : json) takeSignsOffZeros(part);
    else if (json.is_number_float() && json.get<double>() == 0)
        json = 0.0;
}

/// Returns JSON indented and with a line end. File and grid names need not be UTF-8; what is not is
/// replaced, since JSON has no way to say it. Zeros have no sign.
inline std::string dumpJson(nlohmann::ordered_json json) {
    takeSignsOffZeros(json);
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace deltasplat
