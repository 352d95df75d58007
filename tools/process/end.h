// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Ends the program. All files are closed by then and all text is written: what is left to do is
/// done by the system at once, and by the destructors of libraries in milliseconds. Under a
/// sanitizer, which looks for leaks then, they run.
[[noreturn]] void endProgram(int exitCode);

}  // namespace deltasplat
