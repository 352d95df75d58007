// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/error.h"

namespace deltasplat {

/// Says that a sound grid holds values that are NaN or infinite.
struct NotFinite : Error {
    using Error::Error;
};

/// Says that a sound grid is of a kind that is not read: which says what is in the way.
struct UnreadableGrid : Error {
    /// @param where  file and grid
    /// @param which  "a NonlinearFrustumMap transform"
    UnreadableGrid(const std::string& where, const std::string& which, const std::string& expected)
        : Error(ErrorCode::kInput, where, which, expected), obstacle(which) {}

    std::string obstacle;
};

/// Says that leaves of a grid cannot be unpacked where they were looked for.
struct DamagedLeaves : Error {
    /// @param where  file and grid
    explicit DamagedLeaves(const std::string& where)
        : Error(ErrorCode::kInput, where, "leaves that are damaged", "a sound OpenVDB grid") {}
};

}  // namespace deltasplat
