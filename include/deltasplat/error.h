// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace deltasplat {

/// The kind of failure. The numbers mean nothing, except that none is 0, the exit status of a
/// success. Programs choose their own exit status.
enum class ErrorCode {
    kFailed = 1,
    kUsage,       ///< an option or an argument is wrong
    kInput,       ///< an input cannot be read or is invalid
    kOutput,      ///< an output cannot be written
    kInterrupted  ///< stopped by the caller
};

/// Returns the line `where: got X; expected Y` used for every refused value.
inline std::string gotExpected(std::string_view where, std::string_view got,
                               std::string_view expected) {
    std::string line(where);
    line.append(": got ").append(got).append("; expected ").append(expected);
    return line;
}

/// The one exception the library throws on purpose. `what()` is one line without a final full stop:
/// `<file or option>: got X; expected Y`. Here and in warnings and notes an option is named by its
/// field or parameter, in backquotes, so that a program can put its own name there:
/// "`tolerance.value`: got -1; expected a number >= 0".
class Error : public std::runtime_error {
  public:
    Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    /// Composes the message with gotExpected.
    Error(ErrorCode code, std::string_view where, std::string_view got, std::string_view expected)
        : Error(code, gotExpected(where, got, expected)) {}
    ErrorCode code() const noexcept { return code_; }

  private:
    ErrorCode code_;
};

}  // namespace deltasplat
