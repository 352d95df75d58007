// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace deltasplat {

/// Returns JSON indented and with a line end. File and grid names need not be UTF-8; what is not is
/// replaced, since JSON has no way to say it.
inline std::string dumpJson(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace deltasplat
