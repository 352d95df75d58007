// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/error.h"

namespace deltasplat::test {

/// Returns what the code is called: "output" for ErrorCode::kOutput.
inline std::string codeName(ErrorCode code) {
    switch (code) {
        case ErrorCode::kFailed:
            return "failed";
        case ErrorCode::kUsage:
            return "usage";
        case ErrorCode::kInput:
            return "input";
        case ErrorCode::kOutput:
            return "output";
        case ErrorCode::kInterrupted:
            return "interrupted";
    }
    return "unknown";
}

/// Returns "<code's name>: <message>" of the Error that `action` throws, or "no error".
template <typename Action>
std::string errorOf(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return codeName(error.code()) + ": " + error.what();
    }
    return "no error";
}

}  // namespace deltasplat::test
